#!/usr/bin/env bash
# All checks, from a fresh machine: format, layout, release build with warnings as errors, tests, sanitizers, lint. Closes
# with ctest's count of the tests.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# step TEXT: announces what comes, with the seconds since the start.
step() { printf '\n== %s (at %s s)\n' "$1" "$SECONDS"; }

# test_preset PRESET [ctest arguments...]: configures, builds and tests.
test_preset() {
  local preset=$1
  shift
  cmake --preset "$preset" >/dev/null
  cmake --build --preset "$preset" -- --quiet
  ctest --preset "$preset" "$@" | tee "build/$preset/ctest.log"
}

step "set-up"
scripts/setup.sh --dev
step "format and layout"
scripts/format.sh --check
scripts/check_layout.sh
step "release build, tests and examples"
test_preset ci
if [ -f web/package.json ]; then
  step "pages"
  npm test --prefix web --if-present
fi
step "address and undefined-behaviour sanitizers"
test_preset asan -LE 'house|examples'
step "lint"
scripts/tidy.sh

step "passed"
grep -h 'tests passed' build/asan/ctest.log | sed 's/$/ (sanitized)/'
grep -h 'tests passed' build/ci/ctest.log
