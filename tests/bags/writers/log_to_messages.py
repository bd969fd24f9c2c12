#!/usr/bin/env python3
"""Says in ROS messages what a Waymark log folder holds: log_to_messages.py LOG OUT.jsonl

One line per message, in the order of the stamps: topic, type, stamp in ns, and the message with the field names of
ROS 2; bytes are in base64. Those who write bags (beside this file) take it from there.
"""
import base64
import csv
import json
import math
import pathlib
import re
import sys


def rows(log, name):
    path = log / name
    if not path.exists():
        return
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            whole, _, fraction = row.pop("stamp_s").partition(".")
            yield int(whole) * 10**9 + int(fraction.ljust(9, "0")[:9]), row


def header(stamp, frame):
    return {"stamp": {"sec": stamp // 10**9, "nanosec": stamp % 10**9}, "frame_id": frame}


def vector(x=0.0, y=0.0, z=0.0):
    return {"x": x, "y": y, "z": z}


def times(a, b):
    """Product of two quaternions (w, x, y, z)."""
    aw, ax, ay, az = a
    bw, bx, by, bz = b
    return (aw * bw - ax * bx - ay * by - az * bz, aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx, aw * bz + ax * by - ay * bx + az * bw)


def about(axis, angle_rad):
    q = [math.cos(angle_rad / 2), 0.0, 0.0, 0.0]
    q[1 + axis] = math.sin(angle_rad / 2)
    return tuple(q)


def quaternion(q):
    return dict(zip("wxyz", q))


def joint_states(log):
    for stamp, row in rows(log, "wheels.csv"):
        yield stamp, "/joint_states", "sensor_msgs/JointState", {
            "header": header(stamp, ""), "name": ["arm", "left_wheel_joint", "right_wheel_joint"],
            "position": [0.5, float(row["left_rad"]), float(row["right_rad"])], "velocity": [], "effort": []}


def odometry(log):
    for stamp, row in rows(log, "odometry.csv"):
        pose = {"position": vector(float(row["x_m"]), float(row["y_m"])),
                "orientation": quaternion(about(2, float(row["theta_rad"])))}
        yield stamp, "/odom", "nav_msgs/Odometry", {
            "header": header(stamp, "odom"), "child_frame_id": "base_link",
            "pose": {"pose": pose, "covariance": [0.0] * 36},
            "twist": {"twist": {"linear": vector(), "angular": vector()}, "covariance": [0.0] * 36}}


def velocities(log):
    for stamp, row in rows(log, "velocity.csv"):
        yield stamp, "/speed", "geometry_msgs/TwistStamped", {
            "header": header(stamp, "base_link"),
            "twist": {"linear": vector(float(row["v_mps"])), "angular": vector(0.0, 0.0, float(row["w_radps"]))}}


def imus(log):
    for stamp, row in rows(log, "imu.csv"):
        yield stamp, "/imu", "sensor_msgs/Imu", {
            "header": header(stamp, "base_link"), "orientation": quaternion((1.0, 0.0, 0.0, 0.0)),
            "orientation_covariance": [0.0] * 9, "angular_velocity": vector(0.0, 0.0, float(row["w_radps"])),
            "angular_velocity_covariance": [0.0] * 9, "linear_acceleration": vector(0.0, 0.0, 9.81),
            "linear_acceleration_covariance": [0.0] * 9}


def observations(log):
    """Range and bearing as places before a camera that looks ahead."""
    scans = {}
    for stamp, row in rows(log, "observations.csv"):
        scan = scans.setdefault(stamp, [])
        if row["id"]:
            r, b = float(row["range_m"]), float(row["bearing_rad"])
            scan.append({"fiducial_id": int(row["id"]),
                         "transform": {"translation": vector(-r * math.sin(b), 0.25, r * math.cos(b)),
                                       "rotation": quaternion((1.0, 0.0, 0.0, 0.0))},
                         "image_error": 0.1, "object_error": 0.02, "fiducial_area": 900.0})
    for stamp, scan in scans.items():
        yield stamp, "/fiducial_transforms", "fiducial_msgs/FiducialTransformArray", {
            "header": header(stamp, "camera"), "image_seq": 1, "transforms": scan}


def images(log):
    for stamp, row in rows(log, "images.csv"):
        data = (log / "images" / row["file"]).read_bytes()
        yield stamp, "/camera/image/compressed", "sensor_msgs/CompressedImage", {
            "header": header(stamp, "camera"), "format": "png", "data": base64.b64encode(data).decode()}


def camera(log, stamp):
    path = log / "camera.yaml"
    if not path.exists():
        return
    text = path.read_text()

    def matrix(name):
        return [float(x) for x in re.search(name + r":.*?data: \[(.*?)\]", text, re.S)[1].split(",")]

    yield stamp, "/camera/camera_info", "sensor_msgs/CameraInfo", {
        "header": header(stamp, "camera"), "height": int(re.search(r"image_height: (\d+)", text)[1]),
        "width": int(re.search(r"image_width: (\d+)", text)[1]), "distortion_model": "plumb_bob",
        "d": matrix("distortion_coefficients"), "k": matrix("camera_matrix"), "r": matrix("rectification_matrix"),
        "p": matrix("projection_matrix"), "binning_x": 0, "binning_y": 0,
        "roi": {"x_offset": 0, "y_offset": 0, "height": 0, "width": 0, "do_rectify": False}}


def mount(log, stamp):
    path = log / "log.yaml"
    text = path.read_text() if path.exists() else ""
    section = re.search(r"^camera_mount:(.*?)(?=^\S|\Z)", text, re.S | re.M)
    if not section:
        return
    value = {key: float(x) for key, x in re.findall(r"(\w+): ([-+.\deE]+)", section[1])}
    q = (0.5, -0.5, 0.5, -0.5)  # from the axes of a camera that looks ahead
    for axis, name in enumerate(["roll_deg", "pitch_deg", "yaw_deg"]):
        q = times(about(axis, math.radians(value.get(name, 0.0))), q)
    place = vector(value.get("x_m", 0.0), value.get("y_m", 0.0), value.get("z_m", 0.0))
    yield stamp, "/tf_static", "tf2_msgs/TFMessage", {"transforms": [{
        "header": header(stamp, "base_link"), "child_frame_id": "camera",
        "transform": {"translation": place, "rotation": quaternion(q)}}]}


def main(log, out):
    messages = [m for kind in (joint_states, odometry, velocities, imus, observations, images) for m in kind(log)]
    first = min(stamp for stamp, *_ in messages)
    messages = [*mount(log, first), *camera(log, first), (first, "/chatter", "std_msgs/String", {"data": "hello"}),
                *messages]
    messages.sort(key=lambda m: m[0])
    with open(out, "w") as file:
        for stamp, topic, kind, message in messages:
            json.dump({"topic": topic, "type": kind, "stamp": stamp, "message": message}, file)
            file.write("\n")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]), sys.argv[2])
