#!/usr/bin/env bash
# What goes wrong around the program: outputs that are full or closed, names of any bytes, hostile files, no threads, no
# memory. It ends in time, with its status and one line, and never by a signal. Usage: faults_test.sh WAYMARK
set -uo pipefail
waymark=$(realpath "$1")
exec 3>&1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0

fail() {
  echo "FAILED: $1" >&3
  failures=$((failures + 1))
}

# ends STATUS COMMAND...: within a minute, with that status.
ends() {
  local status=$1
  shift
  timeout 60 "$@"
  local got=$?
  [ "$got" -eq "$status" ] || fail "$*: status $got, expected $status"
}

# says STATUS WORDS COMMAND...: ends so, and with one line on standard error that has WORDS in it.
says() {
  local status=$1 words=$2
  shift 2
  ends "$status" "$@" >out.txt 2>err.txt
  [ "$(wc -l <err.txt)" -eq 1 ] || fail "$*: expected one line, got: $(cat err.txt)"
  grep -qF -- "$words" err.txt || fail "$*: '$words' is not in: $(cat err.txt)"
}

is_json() { node -e 'JSON.parse(require("fs").readFileSync(0))' <"$1" || fail "$1 is no JSON"; }

"$waymark" sim square -o log --seed 3 --quiet || fail 'no log'

# Standard error that is closed or full takes no line, and changes nothing else.
ends 2 "$waymark" run nowhere -o o 2>&-
ends 2 "$waymark" run nowhere -o o 2>/dev/full
ends 2 "$waymark" frobnicate 2>&-
# A file that is opened while it is closed must not take its place, and get what is meant for it.
ends 1 "$waymark" run log -o closed --json >&- 2>&-
grep -q 'waymark: ' closed/* && fail 'an error went into a result'

# Standard output that is closed or full is noticed; what is on disk is there all the same.
for command in 'run log -o full --json' 'run log -o full' 'check log --json' 'check log' 'config' '--help' '--version' \
  'map show full/map.waymark' 'eval full --truth log' 'sim square -o again' 'demo -o demo'; do
  # shellcheck disable=SC2086
  "$waymark" $command >/dev/full 2>err.txt
  [ $? -eq 1 ] || fail "$command >/dev/full does not end with 1"
  [ "$(wc -l <err.txt)" -eq 1 ] && grep -q '^waymark: cannot write to standard output' err.txt ||
    fail "$command >/dev/full says: $(cat err.txt)"
done
[ -s full/report.html ] || fail 'run wrote no report because standard output is full'
"$waymark" check log >&- 2>err.txt
[ $? -eq 1 ] || fail 'check >&- does not end with 1'
grep -q 'cannot write to standard output: Bad file descriptor' err.txt || fail "check >&- says: $(cat err.txt)"
ends 0 "$waymark" run log -o full --quiet >/dev/full
ends 2 "$waymark" run nowhere -o o >/dev/full 2>err.txt
grep -q nowhere err.txt || fail "an error with a full standard output says: $(cat err.txt)"

# Names are bytes; JSON and pages get a replacement for what is not UTF-8.
latin=$'R\xe4ume'
cp -r log "$latin"
ends 0 "$waymark" run "$latin" -o "out-$latin" --json >run.json
is_json run.json
for file in trajectory.tum map.csv map.waymark config.yaml metrics.json report.html; do
  [ -s "out-$latin/$file" ] || fail "run of a folder in Latin-1 wrote no $file"
done
ends 0 "$waymark" check "$latin" --json >check.json
is_json check.json
ends 0 "$waymark" eval "out-$latin" --truth "$latin" --json >eval.json
is_json eval.json
ends 0 "$waymark" map convert "out-$latin/map.waymark" -o map.json >out.txt
is_json map.json
ends 0 "$waymark" sweep "$latin" --axis seed=1,2 -o "sweep-$latin" --json >sweep.json
is_json sweep.json
ends 0 "$waymark" calibrate odometry "$latin" -o "cal-$latin" --json >cal.json
is_json cal.json
ends 0 "$waymark" run log -o again --config "out-$latin/config.yaml" >out.txt

# Files whose size says nothing of what they come to.
laughs() { # laughs INNERMOST: maps of ten aliases to the one before, 14 deep
  printf 'l0: &l0 %s\n' "$1"
  for level in {1..14}; do
    printf 'l%d: &l%d {' "$level" "$level"
    for key in {0..9}; do printf 'k%d: *l%d, ' "$key" $((level - 1)); done
    printf '}\n'
  done
}
for innermost in '{}' '[]' '~' ha; do
  laughs "$innermost" >laughs.yaml
  says 2 'laughs.yaml:' "$waymark" config --validate laughs.yaml
done
rm -rf damaged && cp -r log damaged && laughs '{}' >damaged/log.yaml
says 2 'log.yaml:' "$waymark" check damaged
rm -rf damaged && cp -r log damaged && laughs '{}' >damaged/camera.yaml
says 2 'camera.yaml:' "$waymark" check damaged
mkdir bag && laughs '{}' | sed '1i rosbag2_bagfile_information: 1' >bag/metadata.yaml
says 2 'metadata.yaml:' "$waymark" check bag

# Devices and pipes in place of files.
mkfifo pipe
for file in /dev/zero pipe; do
  says 2 "$file" "$waymark" config --validate "$file"
  says 2 "$file" "$waymark" run "$file" -o o
  says 2 "$file" "$waymark" check "$file"
  rm -rf damaged && cp -r log damaged && ln -sf "$(realpath "$file")" damaged/wheels.csv
  says 2 'wheels.csv' "$waymark" run damaged -o o
  ln -sf "$(realpath "$file")" "${file##*/}.waymark"
  says 2 'waymark: cannot read' "$waymark" map show "${file##*/}.waymark"
done

# A database in which a query is what makes the rows.
if /usr/bin/python3 -c 'import sqlite3' 2>/dev/null; then
  /usr/bin/python3 - <<'PYTHON'
import sqlite3
database = sqlite3.connect("view.db3")
database.executescript("""
  CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT);
  INSERT INTO topics VALUES (1, '/odom', 'nav_msgs/msg/Odometry', 'cdr');
  CREATE VIEW messages AS WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM c)
    SELECT x AS id, 1 AS topic_id, x AS timestamp, x'00' AS data FROM c;""")
PYTHON
  says 2 'messages is a view, not a table' "$waymark" check view.db3
else
  echo 'SKIPPED: no python3 to write a database with'
fi

# Limits on memory, which the sanitizers do not go with.
if prlimit --as=700000000 "$waymark" --version >/dev/null 2>&1; then
  says 1 'could not start 255 threads' prlimit --as=700000000 \
    "$waymark" run sim:square --filter fastslam --threads 256 -o o
  says 1 '1 of 2 runs failed, the first because: out of memory' prlimit --as=1000000000 \
    "$waymark" sweep sim:square --axis fastslam.particles=10,10000000 --set filter=fastslam --threads 2 -o memory
  [ "$(wc -l <memory/sweep.csv)" -eq 3 ] || fail "sweep: expected a header and 2 rows: $(cat memory/sweep.csv)"
  says 1 'out of memory' prlimit --as=1000000000 \
    "$waymark" run sim:square --filter fastslam --particles 10000000 -o o
else
  echo 'SKIPPED: this build does not run in a limited address space'
fi

[ "$failures" -eq 0 ] && echo "all passed"
exit "$failures"
