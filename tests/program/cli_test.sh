#!/usr/bin/env bash
# The program as a user meets it. Usage: cli_test.sh WAYMARK DATA, the latter being where recordings are, if there are any.
set -uo pipefail
waymark=$1
data=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0

fail() {
  echo "FAILED: $1"
  failures=$((failures + 1))
}

# refuses STATUS WORDS COMMAND...: the command ends with STATUS and one line on standard error that has WORDS in it.
refuses() {
  local status=$1 words=$2
  shift 2
  "$waymark" "$@" >out.txt 2>err.txt
  local got=$?
  [ "$got" -eq "$status" ] || fail "waymark $*: status $got, expected $status"
  [ "$(wc -l <err.txt)" -eq 1 ] || fail "waymark $*: expected one line, got: $(cat err.txt)"
  grep -qF -- "$words" err.txt || fail "waymark $*: '$words' is not in: $(cat err.txt)"
}

# does COMMAND...: the command succeeds and says nothing on standard error.
does() {
  "$waymark" "$@" >out.txt 2>err.txt || fail "waymark $*: status $?: $(cat err.txt)"
  [ ! -s err.txt ] || fail "waymark $*: complains: $(cat err.txt)"
}

# Wrong usage.
refuses 2 "unknown command 'frobnicate'; see \`waymark --help\`" frobnicate
refuses 2 "unknown command 'rnu'; did you mean run?" rnu
refuses 2 "calibrate: unknown command 'camra'; did you mean camera? See \`waymark calibrate --help\`" calibrate camra
refuses 2 'run: unknown option --fliter; did you mean --filter? See `waymark run --help`' run sim:square --fliter ekf
refuses 2 'run: unknown option --frobnicate; see `waymark run --help`' run sim:square --frobnicate
refuses 2 "check: unexpected argument 'twice'" check sim:square twice
refuses 2 'give a command: run, live, demo,'
refuses 2 'give a log: `waymark run LOG`' run
refuses 2 'give a second map: `waymark map merge MAP SECOND_MAP --output OUT`' map merge a.waymark
refuses 2 'give --truth LOG_OR_FILE' eval out
refuses 2 "--filter cannot be 'ekff'; allowed: ekf or fastslam" run sim:square -o o --filter ekff
refuses 2 'allowed: a number, 1e-06 to 1000' run sim:square -o o --set sensor.range_sigma_m=-1
refuses 2 'sensor.range_sigma_m' run sim:square -o o --set sensor.range_sigma=1
refuses 2 "--particles cannot be '0'" run sim:square -o o --filter fastslam --particles 0
refuses 2 "--particles cannot be 'many'" run sim:square -o o --filter fastslam --particles many
refuses 2 '--particles cannot be' run sim:square -o o --filter fastslam --particles -5
refuses 2 '--particles cannot be' run sim:square -o o --filter fastslam --particles 99999999999999999999
refuses 2 'range-bearing, range, bearing, pixel or markers' run sim:square -o o --filter fastslam --observe sonar
refuses 2 'ml takes range-bearing' run sim:forest -o o --filter fastslam --observe range
refuses 2 'ekf or fastslam' run sim:square -o o --filter ukf
refuses 2 'square' run sim:sqare -o o
refuses 2 'need identities' run sim:forest -o o --observe bearing
refuses 2 'known, nearest, jcbb or ml' run sim:forest -o o --associate guess
refuses 2 'the EKF takes known, nearest or jcbb' run sim:forest -o o --associate ml
refuses 2 'FastSLAM takes known or ml' run sim:forest -o o --filter fastslam --associate jcbb
refuses 2 'nowhere.yaml' run sim:square -o o --config nowhere.yaml
printf 'map:\n  capacity: -3\n' >bad.yaml
refuses 2 'bad.yaml:2' config --validate bad.yaml

# Config keys, shown, all and in part; those of earlier versions.
does config
grep -q 'particles:' out.txt || fail "config: a key that pages name is not shown"
! grep -q 'landmark_noise_px:' out.txt || fail "config: shows a key that no page tells to set"
does config --all
grep -q 'landmark_noise_px:' out.txt || fail "config --all: lacks a key"
does config sensor
[ "$(grep -vcE '^ |^$|^sensor:' out.txt)" -eq 0 ] || fail "config sensor: prints other sections"
refuses 2 'did you mean' config senzor
refuses 2 'fastslam.kld_error was removed' run sim:square -o o --set fastslam.kld_error=0.05
printf 'seed: 3\nekf:\n  capacity: 50  # small\n  likelihood: student\n' >old.yaml
refuses 2 'old.yaml:3: ekf.capacity is now map.capacity' run sim:square -o o --config old.yaml
does config --migrate old.yaml
does config --validate old.yaml
does config map --config old.yaml
grep -q 'capacity: 50' out.txt || fail "config --migrate: lost a value: $(cat old.yaml)"
does config --migrate old.yaml
grep -q 'nothing to change' out.txt || fail "config --migrate: changed a migrated file"
printf 'ekf: {capacity: 50, likelihood: student}\n' >flow.yaml
refuses 2 'change it by hand' config --migrate flow.yaml
printf 'ekf:\n  capacity: 50\n  likelyhood: student\n' >wrong.yaml
cp wrong.yaml kept.yaml
refuses 2 'did you mean ekf.likelihood' config --migrate wrong.yaml
cmp -s wrong.yaml kept.yaml || fail "config --migrate: changed a file that it refused"
printf 'sim:\n  side_m: 3\n' >world.yaml
does sim world.yaml -o world --set sim.speed_mps=1
printf 'sim:\n  side_m: 3\nfilter: ekf\n' >world.yaml
refuses 2 'a world has only keys `sim.*`; give filter by --config' run sim:world.yaml -o o
refuses 2 'nowhere.yaml' run sim:nowhere.yaml -o o

# Instruction sets that there are not.
WAYMARK_INSTRUCTION_SET=avx9 refuses 2 "WAYMARK_INSTRUCTION_SET: 'avx9'" --version
WAYMARK_INSTRUCTION_SET='' refuses 2 "WAYMARK_INSTRUCTION_SET: ''" --version

# Inputs that are no logs.
refuses 2 'nowhere' run nowhere -o o
mkdir empty
refuses 2 'empty' run empty -o o
refuses 2 'empty' check empty
refuses 2 'nowhere.tum' eval nowhere.tum --truth empty

printf 'MATLAB 5.0 MAT-file, broken off' >x.mat
refuses 2 'x.mat: is not a MATLAB file' run x.mat -o o
{ printf '%-124s' 'MATLAB 5.0 MAT-file, broken off' && printf '\0\001IM\016\0\0\0\377\377\0\0'; } >y.mat
refuses 2 'y.mat: damaged MATLAB file' run y.mat -o o

# A log, whole and damaged.
does sim square -o log --seed 3
does check log
grep -q 'run: waymark run log -o out' out.txt || fail 'check names no command to run'
refuses 2 'log: of several inputs each must be a ROS bag' check log log
does check sim:forest
grep -q 'run: waymark run sim:forest -o out' out.txt || fail 'check names no command for a log without identities'
does sim forest -o forest --set sim.laps=1
does run forest --filter fastslam -o without_identity --json
grep -q '"associate": "ml"' out.txt || fail 'a log folder without identities is not associated'
does run forest -o without_identity --json
grep -q '"associate": "jcbb"' out.txt || fail 'a log folder without identities is not associated by the EKF'
does run log -o whole
grep -q '^verdict: ' <(head -n 1 out.txt) || fail 'run does not begin with its verdict'
grep -q '"verdict"' whole/metrics.json || fail 'metrics.json has no verdict'
grep -q '"lost_s": \[\]' whole/metrics.json || fail 'metrics.json does not say whether the robot was lost'
for file in trajectory.tum trajectory_covariance.csv map.csv map.waymark config.yaml metrics.json report.html; do
  [ -s "whole/$file" ] || fail "run wrote no $file"
done
does config --all
cp out.txt my.yaml
does run log -o templated --config my.yaml
cmp -s whole/trajectory.tum templated/trajectory.tum || fail 'the output of config, given as it is, changes a run'
does run log -o again --config whole/config.yaml --threads 2
for file in trajectory.tum trajectory_covariance.csv map.csv; do
  cmp -s "whole/$file" "again/$file" || fail "$file differs when run again with its own config and two threads"
done
does eval whole --truth log --json
grep -q position_rmse_m out.txt || fail 'eval prints no errors'
does eval whole/trajectory.tum --truth whole/trajectory.tum
does eval log --truth log
grep -q 'its odometry alone is scored' out.txt || fail 'eval does not say that it scores odometry'
does eval whole --truth whole/trajectory.tum
does eval whole --truth whole --json
grep -q 'landmark_rmse_m' out.txt || fail 'eval does not take a run as truth'
refuses 2 'log/log.yaml:' eval log/log.yaml --truth log
awk '{ print $1, $2, $4, $3, $5, -$7, $6, $8 }' whole/trajectory.tum >upright.tum
does eval upright.tum --truth upright.tum
grep -q 'scored in space' out.txt || fail 'eval does not say that a path is scored in space'
does eval upright.tum --truth upright.tum --plane xz
! grep -q 'scored in space' out.txt || fail 'eval does not score in the plane that it is told'
awk '{ print $1, $2, $3, $4, 0, 0, 0, 1 }' whole/trajectory.tum >unturned.tum
does eval unturned.tum --truth whole/trajectory.tum
grep -q 'rows of the result have the same orientation' out.txt || fail 'eval takes one orientation as measured'
awk '{ print 1, 0, 0, $2, 0, 1, 0, $3, 0, 0, 1, $4 }' whole/trajectory.tum >kitti.txt
does eval kitti.txt --truth kitti.txt
head -n 5 kitti.txt >short.txt
refuses 2 'poses without stamps (KITTI) cannot be matched by number' eval short.txt --truth kitti.txt
refuses 2 'poses without stamps (KITTI) can be scored only' eval kitti.txt --truth whole/trajectory.tum
refuses 2 'plane' eval kitti.txt --truth kitti.txt --plane up

# Without a result nothing is written, and nothing printed.
cp -r whole untouched
for wrong in '--observe pixel' '--set wheels.track_m=0' '--from 1e6' '--from 20 --to 10'; do
  # shellcheck disable=SC2086
  refuses 2 '' run log -o untouched $wrong
  [ ! -s out.txt ] || fail "run $wrong prints: $(cat out.txt)"
  diff -rq whole untouched || fail "run $wrong wrote into its output folder"
done
does run sim:square --seed 3 -o memory
cmp -s whole/trajectory.tum memory/trajectory.tum || fail 'a log from memory gives another path than from disk'

# Saved maps: the same bytes when nothing happened between, and what cannot be gone on from.
does run log -o first --to 20
does run log -o second --from 20.001 --to 20.002 --map first/map.waymark
cmp -s <(sed 1,3d first/map.waymark) <(sed 1,3d second/map.waymark) || fail 'a map that was only read and written differs'
does run log -o second --from 20 --map first/map.waymark
refuses 2 'map.file: a saved map needs filter=ekf' run log -o o --map first/map.waymark --filter fastslam
refuses 2 'map.capacity=3' run log -o o --map first/map.waymark --set map.capacity=3
refuses 2 'nowhere.waymark' run log -o o --map nowhere.waymark
sed 's/^waymark_map: 1/waymark_map: 9/' first/map.waymark >broken.waymark
refuses 2 "broken.waymark:1: version '9'" run log -o o --map broken.waymark
awk '/^covariance/ { print; getline; $1 = "-1" } { print }' first/map.waymark >broken.waymark
refuses 2 'broken.waymark: the covariance is not positive' run log -o o --map broken.waymark
head -c "$(($(wc -c <first/map.waymark) / 2))" first/map.waymark >broken.waymark
refuses 2 'broken.waymark' run log -o o --map broken.waymark

# A map, held: the robot is found, the landmarks stay, and another place is told.
does run log -o found --from 5 --map whole/map.waymark --localize
places() { awk '/^(marker|barcode)/ { print $2, $4, $5 }' "$1"; }
cmp -s <(places whole/map.waymark) <(places found/map.waymark) || fail 'localising moves landmarks'
refuses 2 'map.localize: needs a saved map' run log -o o --localize
awk '/^(marker|barcode)/ { $4 = -$4 } { print }' whole/map.waymark >mirrored.waymark
refuses 2 'the map is of another place' run log -o o --map mirrored.waymark --localize
sed -E 's/^(marker|barcode) /&9/' whole/map.waymark >renamed.waymark
refuses 2 'the map has 0' run log -o o --map renamed.waymark --localize

# Saved maps by hand.
does map show whole/map.waymark
grep -q 'landmarks of dimension 2' out.txt || fail 'map show does not say what is in the map'
does map convert whole/map.waymark -o m.json
does map convert m.json -o m.waymark
cmp -s whole/map.waymark m.waymark || fail 'a map comes back from JSON differently'
does map convert m.json -o m.csv
cmp -s whole/map.csv m.csv || fail 'a map as a table differs from map.csv'
does map merge whole/map.waymark m.json -o both.waymark
refuses 2 'the maps contradict each other' map merge whole/map.waymark mirrored.waymark -o o.waymark
refuses 2 '0 landmarks in common' map merge whole/map.waymark renamed.waymark -o o.waymark
refuses 2 'a survey needs variances: columns id,x_m,y_m,sxx,sxy,syy' map fix whole/map.waymark --survey log/landmarks.csv -o o.waymark
awk -F, 'NR == 1 { print "id,x_m,y_m,sxx,syy" } NR > 1 { print $1 "," $2 "," $3 ",1e-6,1e-6" }' log/landmarks.csv >survey.csv
does map fix whole/map.waymark --survey survey.csv -o fixed.waymark
does run log -o found --from 5 --map fixed.waymark --localize
refuses 2 'ends with .waymark' map convert m.json -o m.txt

# Images: from disk as from memory, and what can be wrong with them.
short=(--set sim.side_m=2 --set sim.speed_mps=1 --set sim.corner_radius_m=0.3)
does sim room -o room "${short[@]}"
does check room
grep -q 'run: waymark run room -o out --observe pixel' out.txt || fail 'check does not say how images are run'
does run room -o seen
does run sim:room "${short[@]}" -o seen-memory
cmp -s seen/trajectory.tum seen-memory/trajectory.tum || fail 'images from memory give another path than from disk'
[ "$(wc -l <seen/map.csv)" -gt 10 ] || fail 'images give no map'
grep -q 'landmark_dimension: 3' seen/map.waymark || fail 'a map from images has no heights'
grep -q '"FB4 match"' seen/metrics.json || fail 'metrics.json lacks the blocks of the tracker'
[ "$(wc -c <seen/report.html)" -lt 3000000 ] || fail 'a report with images is too large'
refuses 2 'filter=ekf' run room -o o --filter fastslam
refuses 2 'its landmarks are of dimension 3' run log -o o --map seen/map.waymark
grep -q '^patches: ' seen/map.waymark || fail 'a map from images has no patches'
does run room -o seen-again --from 0.2 --map seen/map.waymark
refuses 2 'map.localize: needs observe=range-bearing or markers' run room -o o --map seen/map.waymark --localize
refuses 2 'observe' run log -o o --observe pixel
spoil() { rm -rf spoilt && cp -r room spoilt; }
spoil && sed -i 's/image_width: 320/image_width: 640/' spoilt/camera.yaml
refuses 2 'camera.yaml: image_width and image_height are 640 and 240' run spoilt -o o
spoil && rm spoilt/images/*9.png && head -c 100 room/images/000020.png >spoilt/images/000020.png
does run spoilt -o o
grep -q 'missing in images' out.txt || fail 'missing images are not named'
grep -q 'images skipped: 1, the first because' out.txt || fail 'a damaged image is not named'
spoil && rm spoilt/camera.yaml
does check spoilt
grep -q 'camera.yaml is missing' out.txt || fail 'check does not say that the camera is unknown'
refuses 2 'into the log as camera.yaml, or set camera.width_px' run spoilt -o o
refuses 2 'into the log as camera.yaml, or set camera.width_px' run spoilt -o o --observe pixel
camera=(--set camera.width_px=320 --set camera.height_px=240 --set camera.fu_px=277 --set camera.fv_px=277)
does run spoilt -o o "${camera[@]}"
refuses 2 'no image' run spoilt -o o "${camera[@]}" --set camera.width_px=640
pgm() { printf 'P5\n%s %s\n255\n' "$1" "$2" && head -c $(($1 * $2)) /dev/zero | tr '\0' "$3"; } # WIDTH HEIGHT GREY
spoil && pgm 320 240 '\0' >spoilt/images/000020.png && pgm 320 240 '\377' >spoilt/images/000021.png
pgm 160 120 '\0' >spoilt/images/000030.png && cp spoilt/images/000040.png spoilt/images/000041.png
does run spoilt -o o
for note in '2 images show nothing' 'has 160 x 120 pixels, expected 320 x 240' '1 images skipped: same stamp or same pixels'; do
  grep -q "$note" out.txt || fail "the notes lack: $note"
done
spoil && sed -i '20{h;d};22G' spoilt/images.csv
refuses 2 'images.csv:22' run spoilt -o o
spoil && rm spoilt/images/*.png
refuses 2 'no image' run spoilt -o o
does run room -o o --set tracker.frame_budget_ms=0.3
grep -q 'for lack of time' out.txt || fail 'a budget that is too small is not named'

# Given pixels: the camera is in the folder too, and so is everything that can be wrong.
mono() { # a log of three steps, made anew
  rm -rf mono && mkdir mono
  printf 'camera matrix:\n180 0 320\n0 180 240\n0 0 1\ncam_transform:\n0 0 1 0.2\n-1 0 0 0\n0 -1 0 0\n0 0 0 1\nz_near: 0\nz_far: 5\nwidth: 640\nheight: 480\n' >mono/camera.dat
  printf '1 3 0.5 0.5\n2 4 -0.5 0.2\n' >mono/world.dat
  for i in 0 1 2; do
    printf '%s 0.%s 0 0 0.%s 0 0\n' "$i" "$i" "$i" >>mono/trajectory.dat
    printf 'seq: %s\ngt_pose: 0 0 0\nodom_pose: 0 0 0\npoint 0 1 287 208 \npoint 1 2 344 230 \n' "$i" >mono/meas-0000$i.dat
  done
}
mono && does run mono -o o
grep -q 'noise of 1 px was added to every point' out.txt || fail 'added noise is not named'
does check mono
grep -q 'planar mono SLAM' out.txt || fail 'planar-mono-slam is not recognised'
mono && rm mono/meas-00001.dat
refuses 2 'trajectory.dat:2: meas-00001.dat of this step is missing' run mono -o o
mono && printf 'point 2 3 10' >>mono/meas-00002.dat
refuses 2 'meas-00002.dat:6: expected point INDEX WORLD_ID COL ROW' run mono -o o
mono && sed -i 's/344/nan/' mono/meas-00001.dat
refuses 2 "meas-00001.dat:5: 'nan'" run mono -o o
mono && head -c 500 /dev/urandom >mono/camera.dat
refuses 2 'camera.dat:' run mono -o o

# An observation mode that the log cannot give.
cp -r log bearings && cut -d, -f1,2,4 log/observations.csv >bearings/observations.csv
refuses 2 'observe' run bearings -o o --filter fastslam --observe range
refuses 2 'observe' run bearings -o o --filter fastslam
does run bearings -o o --filter fastslam --observe bearing

damage() { # damage FILE SED-SCRIPT: a copy of the log in damaged/ with one file changed
  rm -rf damaged partial
  cp -r log damaged
  sed -i "$2" "damaged/$1"
}
damage observations.csv '900s/.*/12.5,3,nan,0.1/'
refuses 2 'observations.csv:900' run damaged -o partial
[ -s partial/trajectory.tum ] || fail 'what was computed before the bad row is not on disk'
damage observations.csv '900s/.*/12.5,3/'
refuses 2 'observations.csv:900' run damaged -o partial
damage wheels.csv '700s/,.*/,inf,1/'
refuses 2 'wheels.csv:700' run damaged -o partial
damage wheels.csv '700s/^[^,]*/0.5/'
refuses 2 'wheels.csv:700' run damaged -o partial
damage observations.csv '800s/^\([^,]*,[^,]*\),[^,]*/\1,-2/'
refuses 2 'observations.csv:800' run damaged -o partial
damage log.yaml 's/track_m/trak_m/'
refuses 2 'track_m' run damaged -o partial
damage log.yaml 's/^waymark_log.*/waymark_log: 1\nwheels: {/'
refuses 2 'log.yaml' run damaged -o partial
rm -rf damaged && cp -r log damaged && : >damaged/wheels.csv
refuses 2 'wheels.csv' run damaged -o partial
rm -rf damaged && cp -r log damaged && head -c 5000 log/wheels.csv >damaged/wheels.csv
"$waymark" run damaged -o partial >out.txt 2>err.txt
[ $? -le 2 ] || fail 'a truncated file ends the program abnormally'
rm -rf damaged && cp -r log damaged && head -c 5000 /dev/urandom >damaged/observations.csv
refuses 2 'observations.csv' run damaged -o partial

# An output that cannot be written.
: >a-file
refuses 2 'a-file' run log -o a-file/out

# Ctrl-C in the middle: status 1, and the results so far are on disk.
"$waymark" run sim:square -o stopped --set sim.laps=20 --set sim.sensor_rate_hz=60 --filter fastslam --particles 3000 >out.txt 2>err.txt &
pid=$!
sleep 5
kill -INT "$pid"
wait "$pid"
status=$?
[ "$status" -eq 1 ] || fail "Ctrl-C: status $status, expected 1"
[ -s stopped/trajectory.tum ] || fail 'Ctrl-C: no trajectory on disk'
[ -s stopped/report.html ] || fail 'Ctrl-C: no report on disk'

# --json prints JSON and nothing else.
"$waymark" run log -o o --json 2>/dev/null | node -e 'JSON.parse(require("fs").readFileSync(0))' || fail 'run --json prints no JSON'
"$waymark" check log --json | node -e 'JSON.parse(require("fs").readFileSync(0))' || fail 'check --json prints no JSON'
"$waymark" demo -o demo --json | node -e 'JSON.parse(require("fs").readFileSync(0))' || fail 'demo --json prints no JSON'
[ -s demo/report.html ] || fail 'demo wrote no report'

# The bench: every figure with its name, what it depends on, a positive value and a unit.
refuses 2 'ekf' bench ukf
does bench ekf --quick
grep -q 'ekf.step ' out.txt || fail 'bench prints no step'
does bench ekf --quick --json
node -e '
  const { machine, results } = JSON.parse(require("fs").readFileSync(0));
  const keys = {"ekf.step": "landmarks observations mode", "ekf.step_wall": "landmarks observations threads",
    "ekf.plain_rank_update": "landmarks observations", "ekf.plain_rank_update_ratio": "landmarks observations",
    "ekf.plain_textbook": "landmarks observations", "ekf.plain_textbook_ratio": "landmarks observations",
    "ekf.flop_bound": "landmarks observations", "ekf.flop_bound_distance": "landmarks observations",
    "ekf.block": "landmarks observations block"};
  const expect = (good, what) => { if (!good) { console.error(what); process.exitCode = 1; } };
  for (const key of ["cpu", "cores", "instruction_set", "fma_gflops", "version", "compiler"])
    expect(machine[key], "machine." + key);
  for (const name in keys) expect(results.some((r) => r.name === name), "no " + name);
  for (const mode of ["invariant", "standard", "compressed invariant", "compressed standard"])
    expect(results.some((r) => r.name === "ekf.step" && r.params.mode === mode), "no mode " + mode);
  for (const r of results) {
    expect(Object.keys(r).join(" ") === "name params value unit", "keys of " + JSON.stringify(r));
    expect(Object.keys(r.params).join(" ") === keys[r.name], "params of " + JSON.stringify(r));
    expect(r.value > 0 && ["ms", "us", "x"].includes(r.unit), "value or unit of " + JSON.stringify(r));
  }' <out.txt || fail 'bench --json is not what it should be'

does bench camera --quick --json
node -e '
  const { results } = JSON.parse(require("fs").readFileSync(0));
  const expect = (good, what) => { if (!good) { console.error(what); process.exitCode = 1; } };
  for (const name of ["camera.fast", "camera.zmssd", "camera.frame", "camera.block", "camera.block_published"])
    expect(results.some((r) => r.name === name && r.value > 0), "no " + name);
  for (const mode of ["default", "article"])
    for (const quantile of ["p50", "p99.9"])
      expect(results.some((r) => r.params.mode === mode && r.params.quantile === quantile), mode + " " + quantile);
  const blocks = results.filter((r) => r.name === "camera.block" && r.params.mode === "default").map((r) => r.params.block.slice(0, 3));
  expect(blocks.join(" ") === "FB1 FB2 FB3 FB4 FB5 FB6 FB7 FB8 FB9", "blocks: " + blocks);
  ' <out.txt || fail 'bench camera --json is not what it should be'

# A sweep: mistakes, a table, and going on after it was killed.
refuses 2 'close keys: fastslam.particles' sweep sim:square -o s --axis particles=1,2
refuses 2 'unknown key nothing' sweep sim:square -o s --axis nothing=1,2
refuses 2 'allowed: whole number' sweep sim:square -o s --axis fastslam.particles=0,5
refuses 2 'nothing varies' sweep sim:square -o s
refuses 2 'nowhere' sweep nowhere -o s --axis seed=1,2
refuses 2 'allowed: whole number' sweep sim:square -o s --axis fastslam.particles=10,none
quick=(sweep sim:square --set sim.side_m=2 --set sim.speed_mps=1 --axis seed=1..3 --axis filter=ekf,fastslam)
does "${quick[@]}" -o s
[ "$(wc -l <s/sweep.csv)" -eq 7 ] || fail "sweep: expected a header and 6 rows: $(cat s/sweep.csv)"
[ -s s/sweep.html ] || fail 'sweep wrote no page'
refuses 2 'is of another sweep' sweep sim:square -o s --axis seed=1..3
settings() { cut -d, -f1-8 "$1"; }  # without times
long=(sweep sim:study --axis seed=1..40 --axis filter=fastslam --set fastslam.particles=50 --threads 2)
"$waymark" "${long[@]}" -o killed >out.txt 2>err.txt &
pid=$!
until [ -f killed/journal.csv ] && [ "$(wc -l <killed/journal.csv)" -gt 4 ]; do sleep 0.02; done
kill -KILL $pid
wait $pid 2>/dev/null
done_before=$(($(wc -l <killed/journal.csv) - 2))
does "${long[@]}" -o killed
grep -q "of 40 runs were already done" out.txt || fail "sweep did not go on: $(cat out.txt)"
[ "$done_before" -lt 40 ] || fail 'the sweep was over before it was killed'
[ "$(wc -l <killed/sweep.csv)" -eq 41 ] || fail 'a sweep that went on lacks runs'
[ "$(sort killed/journal.csv | uniq -d | wc -l)" -eq 0 ] || fail 'a sweep that went on made runs twice'
if command -v mpirun >/dev/null; then
  if mpirun -n 2 --oversubscribe --allow-run-as-root --mca btl self,vader "$waymark" "${quick[@]}" -o mpi >out.txt 2>err.txt; then
    cmp <(settings s/sweep.csv) <(settings mpi/sweep.csv) || fail 'mpirun gives another table'
  elif ! grep -q 'built without MPI' err.txt; then
    fail "mpirun: $(cat err.txt)"
  fi
else
  echo 'SKIPPED: no mpirun on this machine'
fi

# Tuning: a config that can be run with, the same from any number of threads, and what it refuses.
quick_tune=(sim:square --set sim.side_m=2 --set sim.speed_mps=1 --set sim.landmarks=8 --set map.capacity=8)
sigmas=(--keys sensor.range_sigma_m,sensor.bearing_sigma_deg)
does tune "${quick_tune[@]}" "${sigmas[@]}" -o t1 --threads 1
grep -q 'good' out.txt || fail 'tune does not say how flat it is'
does tune "${quick_tune[@]}" "${sigmas[@]}" -o t2 --threads 2 --json
grep -q '"held_out"' out.txt || fail 'tune --json has no held-out scores'
cmp -s t1/tuned.yaml t2/tuned.yaml || fail 'tune depends on the number of threads'
[ -s t1/report.html ] || fail 'tune wrote no report'
does run "${quick_tune[@]}" --config t1/tuned.yaml -o o
refuses 2 'give a log: `waymark tune LOG`' tune
refuses 2 'nowhere' tune nowhere -o o
refuses 2 'close keys: sensor.range_sigma_m' tune "${quick_tune[@]}" --keys sensor.range_sigma -o o
refuses 2 'filter is not a real number' tune "${quick_tune[@]}" --keys filter -o o
refuses 2 '--set sensor.range_sigma_ratio=0.01' tune "${quick_tune[@]}" --keys sensor.range_sigma_ratio -o o
refuses 2 'wheel angles' tune "${quick_tune[@]}" sim:square@sim.odometry=velocity -o o
refuses 2 'rmse' tune "${quick_tune[@]}" --by luck -o o
mkdir few
printf 'waymark_log: 1\nname: few\n' >few/log.yaml
printf 'stamp_s,v_mps,w_radps\n0,1,0\n1,1,0\n' >few/velocity.csv
refuses 2 'no observations' tune few -o o
printf 'stamp_s,id,range_m,bearing_rad\n0,1,3,0.1\n0.5,1,2.5,0.1\n' >few/observations.csv
refuses 2 'too few' tune few -o o
refuses 2 'no ground truth' tune few --by rmse -o o
"$waymark" tune "${quick_tune[@]}" -o t3 >out.txt 2>err.txt &
sleep 0.5
kill -INT $! 2>/dev/null
wait $!
grep -q 'the best values so far are in t3/tuned.yaml' err.txt || [ -s t3/report.html ] || fail "tune, stopped: $(cat err.txt)"

# Calibrating a camera: what is no set of images, and what the images do not show.
refuses 2 'calibrate: give a command: camera' calibrate
refuses 2 'give images: `waymark calibrate camera IMAGES`' calibrate camera
refuses 2 'empty: no images' calibrate camera empty
refuses 2 'nowhere: there is no such file' calibrate camera nowhere
refuses 2 '--corners 9' calibrate camera room/images --corners 9
refuses 2 '--squares' calibrate camera room/images --board charuco
refuses 2 '--board circles' calibrate camera room/images --board circles
refuses 2 'unknown key' calibrate camera room/images --set input.image=x
WAYMARK_MODULE_DIR=$PWD/empty refuses 2 'scripts/setup.sh --opencv' calibrate camera room/images
WAYMARK_MODULE_DIR=$PWD/empty refuses 2 'scripts/setup.sh --opencv' calibrate camera x.mat
if grep -q 'is not installed' < <("$waymark" calibrate camera x.mat 2>&1); then
  echo 'SKIPPED: this build has no OpenCV'
else
  refuses 2 'is neither an image' calibrate camera x.mat
  refuses 2 'no chessboard with 9x6 inner corners' calibrate camera 'room/images/00000*.png' --corners 9x6
  mkdir blank && for i in 1 2 3; do pgm 320 240 '\200' >blank/$i.pgm; done
  refuses 2 'no chessboard was found' calibrate camera blank
  refuses 2 'no chessboard was found' calibrate camera 'room/images/00000*.png'
  mkdir broken && for i in 1 2 3; do head -c 100 room/images/000020.png >broken/$i.png; done
  refuses 2 'none of 3 images can be read' calibrate camera broken --corners 9x6
  photos=${WAYMARK_DATA_DIR:-$data}/calib-chessboard
  if [ -d "$photos" ]; then
    does calibrate camera "$photos/left*.jpg" --corners 9x6 --square_m 0.025 -o left
    grep -q '13 of 13 views' out.txt || fail "calibrate does not use all photos: $(cat out.txt)"
    ! grep -q WEAK out.txt || fail "a good set is called weak: $(cat out.txt)"
    [ -s left/report.html ] || fail 'calibrate wrote no page'
    spoil && cp left/camera.yaml spoilt/
    refuses 2 'camera.yaml: image_width and image_height are 640 and 480' run spoilt -o o
    refuses 2 'they seem to show 9x6: try --corners 9x6' calibrate camera "$photos/left*.jpg" --corners 9x7
    mkdir mixed && cp "$photos"/left0[1-9].jpg mixed && chmod u+w mixed/* && cp room/images/000020.png mixed
    head -c 9000 "$photos/left11.jpg" >mixed/left11.jpg
    does calibrate camera mixed -o mixed-out --json
    node -e '
      const { weak, views, weaknesses } = JSON.parse(require("fs").readFileSync(0));
      const of = (name) => views.find((v) => v.name === name).verdict;
      if (!weak || !weaknesses[0].what.includes("only 9 views")) throw "not weak";
      if (of("000020.png") !== "no board" || of("left11.jpg") !== "unreadable") throw "verdicts";
      ' <out.txt || fail "calibrate --json is not what it should be: $(cat out.txt)"
    refuses 2 '2 of 2 images show' calibrate camera "$photos/left01.jpg" "$photos/left02.jpg" --corners 9x6
  else
    echo "SKIPPED: no recording $photos"
  fi
fi

# What a log says of its robot: mistakes, a straight way, and what was found as a config.
refuses 2 'nowhere' calibrate odometry nowhere -o c
refuses 2 'no landmark was observed' calibrate odometry sim:square -o c --set sim.landmarks=0
mkdir still
printf 'waymark_log: 1\nname: still\n' >still/log.yaml
printf 'stamp_s,id,range_m,bearing_rad\n0,1,2,0\n1,1,2,0\n' >still/observations.csv
refuses 2 'no odometry' calibrate mount still -o c
refuses 2 'nothing can be run: there is no odometry' run still -o o
does calibrate mount sim:square --to 8 -o straight
grep -q 'not observable in this log' out.txt || fail 'calibrate says nothing of a straight way'
does calibrate odometry log -o c --set wheels.track_m=0.3 --quiet
[ ! -s out.txt ] || fail "calibrate --quiet says: $(cat out.txt)"
for file in calibration.yaml calibration.json report.html; do
  [ -s "c/$file" ] || fail "calibrate wrote no $file"
done
grep -q '^wheels.track_m: 0.3[1-5]' c/calibration.yaml || fail "calibrate found: $(cat c/calibration.yaml)"
does run log -o calibrated --config c/calibration.yaml
does calibrate odometry log -o c --json
does calibrate sensor log -o cs --set sensor.range_sigma_m=0.2
grep -q '^sensor.range_sigma_m: 0.0[45]' cs/calibration.yaml || fail "calibrate sensor found: $(cat cs/calibration.yaml)"
refuses 2 'give a log' calibrate sensor
refuses 2 'give a log' calibrate sensor log --places places.csv
refuses 2 'places.csv' calibrate sensor --places places.csv
mkdir static
printf 'waymark_log: 1\nname: static\n' >static/log.yaml
printf 'stamp_s,id,range_m,bearing_rad\n0,1,2.04,0.01\n1,1,2.06,0.01\n2,1,2.05,0.01\n' >static/observations.csv
printf 'log,range_m,bearing_deg\nstatic,2,0\nfar,2,0\n' >places.csv
refuses 2 'far' calibrate sensor --places places.csv -o cs
printf 'log,range_m,bearing_deg\nstatic,2,0\nstatic,2,0\n' >places.csv
does calibrate sensor --places places.csv -o cs
grep -q '^sensor.range_offset_m: 0.05' cs/calibration.yaml || fail "calibrate sensor found: $(cat cs/calibration.yaml)"
refuses 2 'no landmark' calibrate sensor sim:square -o cs --set sim.landmarks=0
does calibrate odometry log -o c --json
cmp -s out.txt c/calibration.json || fail 'calibrate --json prints something else than calibration.json'

# Every level of help shows an example.
for command in '' run demo sim eval sweep tune check calibrate 'calibrate camera' 'calibrate odometry' 'calibrate mount' 'calibrate sensor' bench config map 'map show' 'map convert' 'map merge' 'map fix'; do
  # shellcheck disable=SC2086
  "$waymark" $command --help | grep -q 'Example' || fail "waymark $command --help shows no example"
done

[ "$failures" -eq 0 ] && echo "all passed"
exit "$failures"
