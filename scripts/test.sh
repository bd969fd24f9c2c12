#!/usr/bin/env bash
# All checks, from a fresh machine: format, layout, pages, reference, release build with warnings as errors, tests,
# sanitizers, lint of what changed. Closes with ctest's count of the tests.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# Folders with raw memory, foreign bytes or threads; their tests also run under the sanitizers.
sanitized=(core kernels ekf fastslam vision config logs bags datasets)
# Of folders whose tests would take long there, what is raw memory and foreign bytes.
sanitized_parts='sim\..*(DevelopRow|TraceRays|RipMap)|run\.(OpenSource|InputFormats|MatLogs|ChooseRun)'

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
step "format, layout, pages and reference"
scripts/format.sh --check
scripts/check_layout.sh
scripts/check_equations.sh
scripts/check_glossary.sh
scripts/pages.sh --check
scripts/doxygen.sh
step "release build"
build ci
step "tests and examples"
check ci
step "pages"
npm test --prefix web
step "address and undefined-behaviour sanitizers"
targets=("${sanitized[@]/#/waymark_}" waymark_sim waymark_run)
build asan "${targets[@]/%/_test}"
check asan -R "^(($(IFS='|' && echo "${sanitized[*]}"))\.|$sanitized_parts)"
step "lint of what differs from origin/main"
if git rev-parse --quiet --verify origin/main >/dev/null; then
  scripts/tidy.sh origin/main
else
  echo "lint: there is no origin/main to compare with; scripts/tidy.sh lints everything"
fi

step "passed"
grep -h 'tests passed' build/asan/ctest.log | sed 's/$/ (sanitized)/'
grep -h 'tests passed' build/ci/ctest.log
