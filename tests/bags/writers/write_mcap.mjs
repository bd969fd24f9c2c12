// Writes messages in CDR by public npm packages: node write_mcap.mjs MESSAGES.jsonl OUT none|lz4|zstd|flat WEB
// OUT.mcap becomes an MCAP file ("flat": without chunks), OUT.jsonl the serialized messages for write_db3.py.
// WEB is the folder whose node_modules are used.
import { execFileSync } from "node:child_process";
import { openSync, readFileSync, writeFileSync, writeSync, closeSync } from "node:fs";
import { createRequire } from "node:module";
import { resolve } from "node:path";

const [messages, out, compression, web] = process.argv.slice(2);
const require = createRequire(resolve(web, "package.json"));
const { McapWriter } = require("@mcap/core");
const { parse } = require("@foxglove/rosmsg");
const { MessageWriter } = require("@foxglove/rosmsg2-serialization");

const time = "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n";
const header = "MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n" ;
const vector = "MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n";
const point = "MSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n";
const quaternion = "MSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n";
const pose = "MSG: geometry_msgs/Pose\nPoint position\nQuaternion orientation\n";
const twist = "MSG: geometry_msgs/Twist\nVector3 linear\nVector3 angular\n";
const transform = "MSG: geometry_msgs/Transform\nVector3 translation\nQuaternion rotation\n";
const rule = "=".repeat(80) + "\n";
const definitions = {
  "std_msgs/String": ["string data\n"],
  "sensor_msgs/JointState": ["std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\n" +
    "float64[] effort\n", header, time],
  "nav_msgs/Odometry": ["std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n" +
    "geometry_msgs/TwistWithCovariance twist\n", header, time, pose, point, quaternion, twist, vector,
    "MSG: geometry_msgs/PoseWithCovariance\nPose pose\nfloat64[36] covariance\n",
    "MSG: geometry_msgs/TwistWithCovariance\nTwist twist\nfloat64[36] covariance\n"],
  "geometry_msgs/TwistStamped": ["std_msgs/Header header\nTwist twist\n", header, time, twist, vector],
  "sensor_msgs/Imu": ["std_msgs/Header header\ngeometry_msgs/Quaternion orientation\n" +
    "float64[9] orientation_covariance\ngeometry_msgs/Vector3 angular_velocity\n" +
    "float64[9] angular_velocity_covariance\ngeometry_msgs/Vector3 linear_acceleration\n" +
    "float64[9] linear_acceleration_covariance\n", header, time, quaternion, vector],
  "fiducial_msgs/FiducialTransformArray": ["# who was seen\nuint8 FEW=3\nstd_msgs/Header header\nint32 image_seq 0\n" +
    "FiducialTransform[<=100] transforms\n", header, time, transform, vector, quaternion,
    "MSG: fiducial_msgs/FiducialTransform\nint32 fiducial_id\ngeometry_msgs/Transform transform\n" +
    "float64 image_error\nfloat64 object_error\nfloat64 fiducial_area\n"],
  "sensor_msgs/CompressedImage": ["std_msgs/Header header\nstring format\nuint8[] data\n", header, time],
  "sensor_msgs/CameraInfo": ["std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\n" +
    "float64[] d\nfloat64[9] k\nfloat64[9] r\nfloat64[12] p\nuint32 binning_x\nuint32 binning_y\n" +
    "RegionOfInterest roi\n", header, time,
    "MSG: sensor_msgs/RegionOfInterest\nuint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\n" +
    "bool do_rectify\n"],
  "tf2_msgs/TFMessage": ["geometry_msgs/TransformStamped[] transforms\n", header, time, transform, vector, quaternion,
    "MSG: geometry_msgs/TransformStamped\nstd_msgs/Header header\nstring child_frame_id\nTransform transform\n"],
};

const writers = new Map();
function serialize({ type, message }) {
  if (!writers.has(type)) writers.set(type, new MessageWriter(parse(definitions[type].join(rule), { ros2: true })));
  const binary = type === "sensor_msgs/CompressedImage";
  return writers.get(type).writeMessage(binary ? { ...message, data: Buffer.from(message.data, "base64") } : message);
}

const ros2Name = (type) => type.replace("/", "/msg/");
const lines = readFileSync(messages, "utf8").trim().split("\n").map((line) => JSON.parse(line));
const bigStamp = (line) => BigInt(/"stamp": (\d+), "message"/.exec(line)[1]);
const stamps = readFileSync(messages, "utf8").trim().split("\n").map(bigStamp);

async function writeMcap() {
  const file = openSync(out, "w");
  let position = 0n;
  const writable = {
    write: async (bytes) => { writeSync(file, bytes); position += BigInt(bytes.byteLength); },
    position: () => position,
  };
  const packer = { lz4: ["lz4", ["-q", "-c"]], zstd: ["zstd", ["-q", "-c"]] }[compression];
  const compressChunk = packer && ((data) => ({
    compression, compressedData: execFileSync(packer[0], packer[1], { input: data }),
  }));
  const writer = new McapWriter({ writable, compressChunk, useChunks: compression !== "flat", chunkSize: 4096 });
  await writer.start({ profile: "ros2", library: "" });
  const channels = new Map();
  for (const [i, line] of lines.entries()) {
    if (!channels.has(line.topic)) {
      const schemaId = await writer.registerSchema({
        name: ros2Name(line.type), encoding: "ros2msg", data: Buffer.from(definitions[line.type].join(rule)),
      });
      channels.set(line.topic, await writer.registerChannel({
        schemaId, topic: line.topic, messageEncoding: "cdr", metadata: new Map(),
      }));
    }
    await writer.addMessage({
      channelId: channels.get(line.topic), sequence: i, logTime: stamps[i], publishTime: stamps[i],
      data: serialize(line),
    });
  }
  await writer.end();
  closeSync(file);
}

if (out.endsWith(".mcap")) {
  await writeMcap();
} else {
  writeFileSync(out, lines.map((line, i) => JSON.stringify({
    topic: line.topic, type: ros2Name(line.type), stamp: String(stamps[i]),
    definition: definitions[line.type].join(rule), cdr: Buffer.from(serialize(line)).toString("base64"),
  })).join("\n") + "\n");
}
