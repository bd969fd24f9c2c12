#!/usr/bin/env bash
# `waymark live` as a user meets it: a log at its pace, wheels on a serial port, JSON lines over UDP, the monitor, and recordings
# that give the same bytes again. Usage: live_test.sh WAYMARK
set -euo pipefail
waymark=$1
work=$(mktemp -d)
trap 'kill $(jobs -p) 2>/dev/null || true; rm -rf "$work"' EXIT
cd "$work"
unset http_proxy https_proxy

fail() {
  echo "FAILED: $*" >&2
  exit 1
}

# same_bytes A B: two runs gave the same path and map.
same_bytes() {
  for file in trajectory.tum map.csv map.waymark; do
    cmp "$1/$file" "$2/$file" || fail "$file of $1 and $2 differ"
  done
}

# A log at many times its pace, and its recording, at two speeds and with images.
for speed in 20 60; do
  "$waymark" live --replay sim:study --set sim.laps=1 --speed $speed --record study.mcap -o study --quiet
  "$waymark" run study.mcap -o again --quiet
  same_bytes study again
done
grep -q '"late_events"' study/live.json || fail 'live.json counts no late events'
"$waymark" live --replay sim:marker-room --set sim.laps=1 --speed 10 --record room.mcap -o room --quiet
"$waymark" run room.mcap -o again --quiet
same_bytes room again

# Wheels on a serial port and observations as datagrams, from a robot in ten lines of Python; the pose of now comes back.
cat >robot.py <<'PY'
import json, math, os, pty, socket, subprocess, sys, termios, time, tty

board, port = pty.openpty()
tty.setraw(board)
sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
receiver = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
receiver.bind(("127.0.0.1", 47032))
receiver.setblocking(False)
live = subprocess.Popen([sys.argv[1], "live", "--wheels", os.ttyname(port), "--ticks-per-turn", "1000", "--listen",
                         "udp://127.0.0.1:47031", "--publish", "udp://127.0.0.1:47032", "--for", "6", "-o", "robot", "--quiet",
                         "--record", "robot.mcap", "--set", "wheels.left_radius_m=0.05", "--set", "wheels.right_radius_m=0.05",
                         "--set", "wheels.track_m=0.3"])
landmarks = {1: (1.5, 1.0), 2: (1.0, -1.0), 3: (-1.0, 0.5), 4: (0.0, 2.0)}
x = y = theta = left = right = 0.0
v, w, dt = 0.3, 0.4, 1.0 / 30.0
begin = time.time()
sequence, poses = 0, []
while live.poll() is None:
    x, y, theta = x + v * dt * math.cos(theta), y + v * dt * math.sin(theta), theta + w * dt
    left += (v - 0.15 * w) * dt / 0.05
    right += (v + 0.15 * w) * dt / 0.05
    ticks = [round(1000 * angle / (2 * math.pi)) for angle in (left, right)]
    text = f"E {sequence} {int(1000 * (time.time() - begin)) + 7777} {ticks[0]} {ticks[1]}"
    check = 0
    for c in text.encode():
        check ^= c
    os.write(board, f"{text}*{check:02X}\n".encode())
    if sequence % 3 == 0:
        seen = []
        for number, (lx, ly) in landmarks.items():
            bearing = math.atan2(ly - y, lx - x) - theta
            seen.append({"id": number, "range_m": math.hypot(lx - x, ly - y),
                         "bearing_rad": math.atan2(math.sin(bearing), math.cos(bearing))})
        sender.sendto(json.dumps({"stamp_s": time.time(), "observations": seen}).encode(), ("127.0.0.1", 47031))
    sequence += 1
    try:
        while True:
            poses.append(json.loads(receiver.recv(4096)))
    except BlockingIOError:
        pass
    time.sleep(max(0.0, begin + sequence * dt - time.time()))
assert live.returncode == 0, live.returncode
assert len(poses) > 100, len(poses)
gone = math.hypot(poses[-1]["x_m"] - poses[0]["x_m"], poses[-1]["y_m"] - poses[0]["y_m"])
assert gone > 0.3, gone
PY
python3 robot.py "$waymark"
[ "$(grep -c '^[0-9]' robot/map.csv)" = 4 ] || fail 'the robot did not see its four landmarks'
"$waymark" run robot.mcap -o again --quiet
same_bytes robot again

# The monitor: page, state, a button that ends the session.
"$waymark" live --replay sim:study --speed 1 --monitor 127.0.0.1:47033 -o watched >watched.txt &
for _ in $(seq 100); do
  curl -s -o page.html http://127.0.0.1:47033/ && break
  sleep 0.1
done
grep -q 'id="monitor"' page.html || fail 'the monitor has no page'
curl -s -N --max-time 3 http://127.0.0.1:47033/events >events.txt || true
grep -q '"light":"good"' events.txt || fail "the light is not good: $(tail -c 300 events.txt)"
grep -q '"landmarks":\[\[' events.txt || fail 'the monitor shows no landmarks'
curl -s -X POST -H 'X-Waymark: 1' http://127.0.0.1:47033/do/mark | grep -q done || fail 'the mark was not taken'
sleep 0.3
curl -s -X POST -H 'X-Waymark: 1' http://127.0.0.1:47033/do/stop | grep -q done || fail 'the button does not end the session'
wait %1 || fail 'the session that was ended failed'
[ "$(wc -l <watched/marks.csv)" = 2 ] || fail 'marks.csv does not have the mark'
grep -q '^verdict: ' watched.txt || fail 'the session did not print its verdict'

# A session that is killed leaves a recording of all but its last half second.
"$waymark" live --replay sim:study --speed 1 --record killed.mcap -o killed --quiet &
sleep 4
kill -9 %1
wait %1 2>/dev/null || true
"$waymark" run killed.mcap -o again --json --quiet >killed.json
python3 - <<'PY'
import json
duration = json.load(open("killed.json"))["duration_s"]
assert duration > 2.5, duration
PY

# What is wrong is said, with the status of wrong usage.
for wrong in '' '--wheels /dev/null' '--listen udp://127.0.0.1' '--publish tcp://127.0.0.1:1 --listen -' '--monitor 8080 --listen -' \
  '--replay sim:study --speed 0' '--replay nowhere'; do
  status=0
  # shellcheck disable=SC2086  # several words
  "$waymark" live $wrong -o wrong </dev/null 2>error.txt || status=$?
  [ $status = 2 ] || fail "live $wrong: status $status"
  [ "$(wc -l <error.txt)" = 1 ] || fail "live $wrong: $(cat error.txt)"
done
