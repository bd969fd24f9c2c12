#!/usr/bin/env python3
"""Writes messages as a ROS 1 bag by rosbag itself: write_ros1_bag.py MESSAGES.jsonl OUT.bag none|bz2|lz4"""
import base64
import json
import sys

import genpy
import genpy.dynamic
import rosbag
import roslib.message

HEADER = "=" * 80 + "\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n"
GEOMETRY = ("=" * 80 + "\nMSG: geometry_msgs/Transform\nVector3 translation\nQuaternion rotation\n" +
            "=" * 80 + "\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n" +
            "=" * 80 + "\nMSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n")
DYNAMIC = {
    "fiducial_msgs/FiducialTransformArray":
        "Header header\nint32 image_seq\nFiducialTransform[] transforms\n" + HEADER + "=" * 80 +
        "\nMSG: fiducial_msgs/FiducialTransform\nint32 fiducial_id\ngeometry_msgs/Transform transform\n"
        "float64 image_error\nfloat64 object_error\nfloat64 fiducial_area\n" + GEOMETRY,
    "tf2_msgs/TFMessage":
        "geometry_msgs/TransformStamped[] transforms\n" + "=" * 80 +
        "\nMSG: geometry_msgs/TransformStamped\nHeader header\nstring child_frame_id\nTransform transform\n" + HEADER +
        GEOMETRY,
}
classes = {}


def class_of(kind):
    if kind not in classes:
        classes[kind] = (genpy.dynamic.generate_dynamic(kind, DYNAMIC[kind])[kind] if kind in DYNAMIC
                         else roslib.message.get_message_class(kind))
    return classes[kind]


def fill(message, values):
    """Copies a dict into a message; ROS 1 writes K for what ROS 2 writes k, and has stamps of its own."""
    for name, value in values.items():
        slot = name if name in message.__slots__ else name.upper()
        kind = message._slot_types[message.__slots__.index(slot)]
        if kind == "time":
            value = genpy.Time(value["sec"], value["nanosec"])
        elif kind == "uint8[]":
            value = base64.b64decode(value)
        elif isinstance(value, dict):
            value = fill(getattr(message, slot), value)
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            element = class_of_element(message, kind[:-2])
            value = [fill(element(), part) for part in value]
        setattr(message, slot, value)
    return message


def class_of_element(message, kind):
    """Classes that were made together are not to be found by their names."""
    for family in DYNAMIC:
        if family == message._type:
            return genpy.dynamic.generate_dynamic(family, DYNAMIC[family])[kind]
    return roslib.message.get_message_class(kind)


def main(messages, out, compression):
    with rosbag.Bag(out, "w", compression=compression, chunk_threshold=4096) as bag:
        for line in open(messages):
            entry = json.loads(line)
            stamp = genpy.Time(entry["stamp"] // 10**9, entry["stamp"] % 10**9)
            bag.write(entry["topic"], fill(class_of(entry["type"])(), entry["message"]), stamp)


if __name__ == "__main__":
    main(*sys.argv[1:])
