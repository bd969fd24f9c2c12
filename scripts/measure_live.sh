#!/usr/bin/env bash
# Prints the figures of docs/results.md, "Live": latencies over a rendered room at its pace, the error of drives among markers against
# the same drives offline, and the memory of a long session. Needs a machine that does nothing else, and about 20 minutes.
# Usage: measure_live.sh [HOURS], the length of the session whose memory is measured, played 60 times as fast (2 unless given).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
waymark=$PWD/build/release/waymark
hours=${1:-2}
work=$(mktemp -d)
trap 'kill $(jobs -p) 2>/dev/null || true; rm -rf "$work"' EXIT
cd "$work"

# figure FILE KEYS...: a number of a JSON file.
figure() { python3 -c 'import json, sys
value = json.load(open(sys.argv[1]))
for key in sys.argv[2:]: value = value[key]
print(f"{value:.4g}")' "$@"; }

# latencies FILE: the row of the table.
latencies() {
  for what in pose_of_now correction wait_for_odometry; do
    printf '  %-18s 50 %%: %s ms, 99 %%: %s ms, 99.9 %%: %s ms, largest %s ms\n' $what "$(figure "$1" $what p50_ms)" \
      "$(figure "$1" $what p99_ms)" "$(figure "$1" $what p999_ms)" "$(figure "$1" $what max_ms)"
  done
  printf '  frames of 33 ms missed: %s of %s; late events: %s\n' "$(figure "$1" missed_frames)" "$(figure "$1" correction count)" \
    "$(figure "$1" late_events)"
}

echo "sim:room at its pace:"
"$waymark" sim room -o room --set sim.laps=3 --quiet
"$waymark" live --replay room --observe pixel -o live --quiet
latencies live/live.json

echo "sim:marker-room at its pace, seeds 1 to 5: RMSE live, offline"
for seed in 1 2 3 4 5; do
  "$waymark" sim marker-room -o markers --seed $seed --quiet
  "$waymark" live --replay markers --seed $seed --record markers.mcap -o live --quiet
  "$waymark" run markers --seed $seed -o offline --quiet
  "$waymark" run markers.mcap -o again --quiet
  cmp live/trajectory.tum again/trajectory.tum && same=yes || same=no
  echo "  $(figure live/metrics.json truth position_rmse_m), $(figure offline/metrics.json truth position_rmse_m) m; recording gives the same bytes: $same"
  rm -rf markers
done
latencies live/live.json

echo "memory of $hours h of sim:study, 60 times as fast, MB resident:"
"$waymark" live --replay sim:study --set sim.laps=$((hours * 40)) --speed 60 -o live --quiet &
while kill -0 $! 2>/dev/null; do
  awk '/^VmRSS/ { printf "  %.1f\n", $2 / 1024 }' /proc/$!/status 2>/dev/null || true
  sleep $((hours * 6))
done
wait $!
