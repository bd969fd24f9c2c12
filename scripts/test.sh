#!/usr/bin/env bash
# All checks, from a fresh machine: format, layout, release build with warnings as errors, tests, sanitizers, lint. Closes
# with ctest's count of the tests.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# Folders with raw memory, foreign bytes or threads; their tests also run under the sanitizers.
sanitized=(core kernels ekf fastslam vision io)

# step TEXT: announces what comes, with the seconds since the start.
step() { printf '\n== %s (at %s s)\n' "$1" "$SECONDS"; }

# build PRESET [TARGETS...]: configures and builds.
build() {
  local preset=$1
  shift
  cmake --preset "$preset" >/dev/null
  cmake --build --preset "$preset" ${1:+--target "$@"} -- --quiet
}

# check PRESET [CTEST ARGUMENTS...]: runs the tests of a build.
check() {
  local preset=$1
  shift
  ctest --preset "$preset" "$@" | tee "build/$preset/ctest.log"
}

step "set-up"
scripts/setup.sh --dev
step "format and layout"
scripts/format.sh --check
scripts/check_layout.sh
step "release build"
build ci
step "tests and examples"
check ci
step "pages"
npm test --prefix web
step "address and undefined-behaviour sanitizers"
targets=()
for folder in "${sanitized[@]}"; do
  if [ -f "tests/$folder/CMakeLists.txt" ]; then targets+=("waymark_${folder}_test"); fi
done
build asan "${targets[@]}"
check asan -L "^($(IFS='|' && echo "${sanitized[*]}"))\$"
step "lint"
scripts/tidy.sh

step "passed"
grep -h 'tests passed' build/asan/ctest.log | sed 's/$/ (sanitized)/'
grep -h 'tests passed' build/ci/ctest.log
