#!/usr/bin/env bash
# All checks, from a fresh machine: format, layout, pages, release build with warnings as errors, tests, sanitizers, lint of
# what changed. Closes with ctest's count of the tests.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# Folders with threads: their tests also run under the thread sanitizer.
threaded=(core ekf fastslam vision slam study)

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

# What to lint against: main as it was published, or, on it, the last commit that is more than a day older than this one.
# Nothing where there is none.
changed_since() {
  local base
  base=$(git merge-base HEAD origin/main 2>/dev/null || true)
  if [ "$base" = "$(git rev-parse HEAD)" ] || [ -z "$base" ]; then
    base=$(git rev-list -1 --min-age=$(($(git show -s --format=%ct HEAD) - 86400)) HEAD)
  fi
  echo "$base"
}

# Lints what changed; scripts/tidy.sh without argument lints everything.
lint() {
  local base
  base=$(changed_since)
  if [ -n "$base" ]; then
    echo "lint: what changed since $(git log -1 --format='%h, %cs, %s' "$base")"
    scripts/tidy.sh "$base"
  else
    echo "lint: everything, because there is no earlier commit to compare with"
    scripts/tidy.sh
  fi
}

step "set-up"
scripts/setup.sh --dev
step "format, layout and pages"
scripts/format.sh --check
scripts/check_layout.sh
scripts/pages.sh --check
step "release build"
build ci
step "tests and examples"
check ci
step "pages"
npm test --prefix web
step "address and undefined-behaviour sanitizers"
build asan
check asan -LE '^house$'
step "thread sanitizer"
targets=("${threaded[@]/#/waymark_}")
build tsan "${targets[@]/%/_test}"
check tsan -L "^($(IFS='|' && echo "${threaded[*]}"))\$"
step "lint"
lint

step "passed"
grep -h 'tests passed' build/asan/ctest.log | sed 's/$/ (address and undefined-behaviour sanitizers)/'
grep -h 'tests passed' build/tsan/ctest.log | sed 's/$/ (thread sanitizer)/'
grep -h 'tests passed' build/ci/ctest.log
