#!/usr/bin/env python3
"""Writes serialized messages as the .db3 file of a ROS 2 bag: write_db3.py CDR.jsonl OUT.db3 new|old|bare

new: with the definitions of all types, as since ROS 2 Iron; old: the tables of ROS 2 Foxy, which have none; bare: like
new, for the file alone. new and old write a metadata.yaml beside it.
"""
import base64
import json
import pathlib
import sqlite3
import sys


def main(messages, out, age):
    out = pathlib.Path(out)
    database = sqlite3.connect(out)
    database.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
                     "serialization_format TEXT NOT NULL)")
    database.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, "
                     "timestamp INTEGER NOT NULL, data BLOB NOT NULL)")
    if age != "old":
        database.execute("CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT NOT NULL, "
                         "encoding TEXT NOT NULL, encoded_message_definition TEXT NOT NULL, "
                         "type_description_hash TEXT NOT NULL)")
    topics = {}
    for line in open(messages):
        entry = json.loads(line)
        if entry["topic"] not in topics:
            topics[entry["topic"]] = len(topics) + 1
            database.execute("INSERT INTO topics VALUES(?, ?, ?, 'cdr')",
                             (topics[entry["topic"]], entry["topic"], entry["type"]))
            if age != "old":
                database.execute("INSERT INTO message_definitions(topic_type, encoding, encoded_message_definition, "
                                 "type_description_hash) VALUES(?, 'ros2msg', ?, '')",
                                 (entry["type"], entry["definition"]))
        database.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)",
                         (topics[entry["topic"]], int(entry["stamp"]), base64.b64decode(entry["cdr"])))
    database.commit()
    database.close()
    if age != "bare":
        (out.parent / "metadata.yaml").write_text(
            "rosbag2_bagfile_information:\n  version: 4\n  storage_identifier: sqlite3\n"
            f"  relative_file_paths:\n    - {out.name}\n  compression_format: \"\"\n  compression_mode: \"\"\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
