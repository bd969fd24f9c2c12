#!/usr/bin/env bash
# A simulated drive as log folder, ROS 1 bag, .db3 and .mcap: each gives the same path. The bags are written by public
# writers. Usage: containers_test.sh WAYMARK SOURCE_DIR; status 77: this machine has no writers.
set -euo pipefail
waymark=$1
writers=$2/tests/bags/writers
web=$2/web
/usr/bin/python3 -c 'import rosbag' 2>/dev/null && [ -d "$web/node_modules/@mcap" ] || exit 77
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# first COUNT FILE: keeps the first rows of a table.
first() {
  head -n "$(($1 + 1))" "$2" >kept.csv
  mv kept.csv "$2"
}

# bags LOG: LOG.bag, LOG.mcap and LOG.db3 with the same messages.
bags() {
  /usr/bin/python3 "$writers/log_to_messages.py" "$1" messages.jsonl
  /usr/bin/python3 "$writers/write_ros1_bag.py" messages.jsonl "$1.bag" lz4
  node "$writers/write_mcap.mjs" messages.jsonl "$1.mcap" zstd "$web"
  node "$writers/write_mcap.mjs" messages.jsonl cdr.jsonl none "$web"
  /usr/bin/python3 "$writers/write_db3.py" cdr.jsonl "$1.db3" bare
}

# same A B: two paths with the same stamps, no further from each other than the mount's rotation is rounded.
same() {
  paste -d' ' "$1" "$2" | awk '/^#/ { next }
    $1 != $9 { exit 1 }
    { for (k = 2; k <= 8; ++k) if (($k - $(k + 8)) ^ 2 > 1e-12) exit 1; ++rows }
    END { if (rows < 100) exit 1 }'
}

# What a bag does not say: its wheels and how they err.
cat >robot.yaml <<'YAML'
wheels.left_radius_m: 0.0975
wheels.right_radius_m: 0.0975
wheels.track_m: 0.331
YAML

# drives LOG SETTINGS...: the log and its bags.
drives() {
  local log=$1
  shift
  "$waymark" run "$log" "$@" -o "$log-out" --quiet
  awk '/^[a-z]/ { config = /^config:/; next } config { print $1, $2 }' "$log/log.yaml" | cat robot.yaml - >"$log.yaml"
  for bag in "$log.bag" "$log.mcap" "$log.db3"; do
    "$waymark" run "$bag" --config "$log.yaml" "$@" -o "$bag-out" --quiet
    same "$log-out/trajectory.tum" "$bag-out/trajectory.tum" || {
      echo "FAILED: the path from $bag is not that from the log folder"
      exit 1
    }
    cmp <(cut -d, -f1 "$log-out/map.csv") <(cut -d, -f1 "$bag-out/map.csv")
  done
}

small=(--set sim.image_width_px=320 --set sim.image_height_px=240)
"$waymark" sim marker-room "${small[@]}" -o markers --quiet
first 150 markers/images.csv
first 301 markers/wheels.csv
bags markers
drives markers
drives markers --filter fastslam

"$waymark" sim room -o room --quiet
first 120 room/images.csv
first 121 room/wheels.csv
bags room
drives room --observe pixel
