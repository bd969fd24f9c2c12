#!/usr/bin/env bash
# Each table of waymark-figures with small numbers: whether it is printed, and whether what stands in it can be.
# Usage: smoke_test.sh WAYMARK-FIGURES DATA SUBCOMMAND, DATA being where recordings are, if there are any; or
# smoke_test.sh WAYMARK-FIGURES DATA coverage SUBCOMMANDS...: whether these are all. Exit status 77 where the recording is missing.
# shellcheck disable=SC2317  # the tests are called by their names
set -uo pipefail
figures=$1
data=$2
subcommand=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0

fail() {
  echo "FAILED: $1"
  failures=$((failures + 1))
}

# prints ARGUMENTS...: the subcommand succeeds, says nothing on standard error, and every number is one.
prints() {
  "$figures" "$subcommand" "$@" >out.txt 2>err.txt || fail "status $?: $(cat err.txt)"
  [ ! -s err.txt ] || fail "complains: $(cat err.txt)"
  ! grep -qwiE 'nan|inf' out.txt || fail "not all numbers are finite"
}

# within PREFIX N LOW HIGH: there are lines that begin with PREFIX, and in each the Nth number behind it is in [LOW, HIGH].
within() {
  awk -v prefix="$1" -v n="$2" -v low="$3" -v high="$4" '
    index($0, prefix) == 1 {
      ++lines
      rest = substr($0, length(prefix) + 1)
      for (k = 1; match(rest, /-?[0-9]+(\.[0-9]+)?(e[-+]?[0-9]+)?/); ++k) {
        value = substr(rest, RSTART, RLENGTH) + 0
        if (k == n && value >= low && value <= high) ++good
        rest = substr(rest, RSTART + RLENGTH)
      }
    }
    END { exit !(lines > 0 && good == lines) }' out.txt || fail "no line '$1' with number $2 within $3 and $4"
}

# begins FILE BYTES: with these, in hexadecimal.
begins() {
  [ "$(od -An -tx1 -N$((${#2} / 2)) "$1" | tr -d ' \n')" = "$2" ] || fail "$1 does not begin with $2"
}

# needs RECORDING: it is skipped where that is missing.
needs() {
  [ -e "$data/$1" ] && return
  echo "SKIPPED: no recording $data/$1"
  exit 77
}

test_study() {
  prints --seeds 1
  within 'EKF mean pose NEES inside its 99 % band: ' 1 1 100
  within 'position RMSE, mean and median over the seeds: EKF ' 1 0.01 2
  within 'position RMSE, mean and median over the seeds: EKF ' 4 0.01 2
  within 'position RMSE, mean and median over the seeds: EKF ' 6 0.1 10
}

test_observe() {
  prints --seeds 1
  for mode in range-bearing range bearing; do
    within "$mode  " 1 0.01 5  # position, m
    within "$mode  " 5 0.01 5  # landmarks, m
  done
}

test_forest() {
  for filter in ekf fastslam; do
    prints --filter "$filter" --seeds 1 --trunks 40 --particles 20
    within 'known ' 1 0.005 2
    within 'unknown ' 1 0.005 2
    within 'unknown against known, position: mean ' 1 0.05 20
  done
}

test_compressed() {
  prints --landmarks 300 --frames 20
  within 'true ' 1 2 300  # landmarks
  within 'true ' 4 0 1000    # ms
  for mode in 'standard ' 'standard, rounding' 'fej ' 'fej, rounding'; do
    within "$mode" 4 0 1e-6  # m from the whole filter
  done
  within 'invariant ' 4 0 0.5
}

test_consistency() {
  prints --runs 2 --steps 50 -o page.html
  for mode in invariant fej standard; do
    within "$mode " 1 0.1 30  # NEES
    within "$mode " 5 0.001 5  # m
  done
  grep -q '</html>' page.html || fail 'no page'
}

test_cameras() {
  prints --seeds 1 --only 'zoom by'
  within '8 + 8, zoom by 1.5' 2 1 1  # found
  within '12 + 3, zoom by 2' 5 1 1   # exactly
  prints --seeds 1 --only '15 views, noise 1 px'
  within '15 views, noise 1 px' 2 0 0
  within 'one camera, errors independent' 1 1 1
}

test_room() {
  prints --seeds 1 --set sim.side_m=2
  within 'final error, m: median ' 1 0 1
  within 'position RMSE, m: median ' 1 0.001 1
  within 'pose NEES over a run: median ' 1 0.01 100
}

test_markers() {
  prints --seeds 1 --set sim.image_rate_hz=3
  within 'position RMSE, m: mean ' 1 0.001 0.2
  within 'markers, m: RMSE mean ' 1 0.0001 0.1
  within 'markers, m: RMSE mean ' 3 0 2  # missed
  within 'CPU per image of 640 x 480, detection to filter: ' 1 0.1 10000
}

test_budget() {
  prints --minutes 0.02 --seeds 1 --set sim.side_m=1.5
  grep -qE '^3[67] images with 5 ms each by the clock' out.txt || fail 'not the images of 1.2 s'
  for part in 1 0.5 0.2 0.1; do within "$part  " 3 0.001 1; done  # m
  within '1  ' 2 0 1  # left out, %
}

test_sheet() {
  prints sim:room sheet.png --images 4 --columns 2 --set sim.side_m=1.5 --set sim.image_rate_hz=3
  begins sheet.png 89504e470d0a1a0a0000000d4948445200000280000001e0  # a PNG of 640 x 480
}

test_mrclam() {
  needs mrclam6
  prints "$data/mrclam6" --robots 1
  within '1  ' 1 0.02 1
  within 'mean  ' 3 0.01 0.5  # map
}

test_woods() {
  needs lost-in-the-woods
  prints "$data/lost-in-the-woods" --seeds 1
  for filter in ekf fastslam; do within "$filter  " 1 0.005 0.5; done
}

test_loop() {
  needs mbot-apriltag
  prints "$data/mbot-apriltag/log-folder"
  within 'odometry alone ' 1 0.5 5
  within 'ekf ' 1 0 0.2
  within 'landmark RMSE, aligned on the landmarks: ' 1 0.001 0.2
}

test_desk() {
  needs monoslam-desk
  prints "$data/monoslam-desk" --frames 100 -o desk.svg
  within '100 images, ' 1 50 5000  # patches
  within 'found in the image after: ' 1 80 100
  within 'FB4 match ' 1 1 100000
  grep -q '</svg>' desk.svg || fail 'no drawing'
}

test_initialise() {
  needs monoslam-desk
  prints "$data/monoslam-desk" -o strips.svg
  within 'images until then, median ' 2 0.3 3  # m
  grep -q '</svg>' strips.svg || fail 'no drawing'
}

test_faults() {
  prints --seeds 1
  within 'of every landmark' 3 0.5 1.5
  within '10 % of all observations' 3 0.5 1.5
}

test_carried() {
  prints --seeds 1
  within 'three known landmarks seen five times each with 10 s left: ' 1 1 1
  within '  found back within 10 s: ' 1 1 1
}

# Every subcommand is tested: those of --help are those named.
test_coverage() {
  "$figures" --help >out.txt
  sed '1,/^Subcommands:/d' out.txt | awk 'NF { print $1 }' | sort >there.txt
  printf '%s\n' "$@" | sort >tested.txt
  diff there.txt tested.txt || fail 'not the subcommands that are tested'
}

declare -F "test_$subcommand" >/dev/null || fail "there is no test of $subcommand"
[ "$failures" -gt 0 ] || "test_$subcommand" "${@:4}"
[ "$failures" -eq 0 ] || cat out.txt 2>/dev/null
exit "$failures"
