#!/usr/bin/env bash
# Runs the tests of a build, or of some folders of it, but for those of folders whose programs, files and recordings are what
# they were when all last passed. Usage: run_tests.sh PRESET [FOLDERS...]. `ctest --preset PRESET` runs them in any case.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

preset=$1
shift
folders=("$@")
build=build/$preset
passed=$build/passed.txt  # lines of folder and digest
data=${WAYMARK_DATA_DIR:-../shared/data}

# digest PATHS...: of the content of these files and folders; what is not there does not count.
digest() { { find "$@" -type f -print0 2>/dev/null || true; } | sort -z | xargs -0 sha256sum | sha256sum | cut -d ' ' -f 1; }

# state_of FOLDER: a digest of all that the outcome of its tests depends on.
state_of() {
  local read=("$build/tests/$1/waymark_$1_test")
  case $1 in
    figures | golden | program) read+=("$build/waymark" "$build/waymark-figures" tests/bags/writers) ;;
    kernels) read+=("$build/tests/$1/waymark_integer_checksums" scripts/check_arm.sh) ;;
    run) read+=(docs) ;;
  esac
  echo "$(digest "${read[@]}" "tests/$1") $common"
}

# tools: which of those are there without which tests are skipped.
tools() {
  command -v aarch64-linux-gnu-g++ qemu-aarch64-static mpirun node chromium chromium-browser google-chrome
  ls -d web/node_modules/@mcap
  /usr/bin/python3 -c 'import rosbag; print(rosbag.__file__)'
} 2>/dev/null

# either NAMES...: a pattern of any of them.
either() { (IFS='|' && echo "($*)"); }
# tests_of FOLDERS...: a pattern of the names of their tests.
tests_of() { echo "^$(either "$@")(\\.|\$)"; }

# The tests of these folders, less those that need not run again.
selected=()
if [ ${#folders[@]} -gt 0 ]; then
  selected=(-R "$(tests_of "${folders[@]}")")
else
  for list in tests/*/CMakeLists.txt; do
    folder=$(basename "$(dirname "$list")")
    # Tests of the tree itself read all of it.
    case $folder in support | house) ;; *) folders+=("$folder") ;; esac
  done
fi

common=$({
  digest configs tests/support web/package-lock.json "$build"/*.so
  { find -L "$data" -type f -printf '%p %s %T@\n' 2>/dev/null || true; } | sort
  tools || true
} | sha256sum | cut -d ' ' -f 1)
now=$(for folder in "${folders[@]}"; do echo "$folder $(state_of "$folder")"; done)
mapfile -t unchanged < <(comm -12 <(sort "$passed" 2>/dev/null) <(sort <<<"$now") | cut -d ' ' -f 1)
if [ ${#unchanged[@]} -gt 0 ]; then
  selected+=(-E "$(tests_of "${unchanged[@]}")")
  echo "not run again, unchanged since they passed: ${unchanged[*]}"
fi
ctest --preset "$preset" "${selected[@]}" | tee "$build/ctest.log"
{ grep -vE "^$(either "${folders[@]}") " "$passed" 2>/dev/null || true; echo "$now"; } >"$passed.new"
mv "$passed.new" "$passed"
