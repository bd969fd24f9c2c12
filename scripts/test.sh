#!/usr/bin/env bash
# All checks, from a fresh machine: format, layout, pages, reference, release build with warnings as errors, tests,
# sanitizers, lint of what changed. Closes with ctest's count of the tests.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# step TEXT: announces what comes, with the seconds since the start.
step() { printf '\n== %s (at %s s)\n' "$1" "$SECONDS"; }

# build PRESET [TARGETS...]: configures and builds.
build() {
  local preset=$1
  shift
  cmake --preset "$preset" >/dev/null
  cmake --build --preset "$preset" ${1:+--target "$@"} -- --quiet
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
scripts/run_tests.sh ci
step "pages"
npm test --prefix web
step "address and undefined-behaviour sanitizers"
mapfile -t folders < <(find waymark workbench -mindepth 1 -maxdepth 1 -type d -printf '%f\n' | sort)
targets=("${folders[@]/#/waymark_}")
build asan "${targets[@]/%/_test}"
scripts/run_tests.sh asan "${folders[@]}"
step "lint of what differs from origin/main"
if git rev-parse --quiet --verify origin/main >/dev/null; then
  scripts/tidy.sh origin/main
else
  echo "lint: there is no origin/main to compare with; scripts/tidy.sh lints everything"
fi

step "passed"
sed -n 's/.*tests passed.*/& (programs under a sanitizer)/p' build/asan/ctest.log
grep -h 'tests passed' build/ci/ctest.log
