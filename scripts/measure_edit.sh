#!/usr/bin/env bash
# Measures how long a change takes in daily work: from saving a file to the end of the quick tests of its folder, in the dev
# preset, without the compiler's cache. Usage: measure_edit.sh [N [FOLDERS...]]. Takes every Nth source (20 unless given) and every
# options header of the folders (all unless given). Builds their tests first. Needs a machine that does nothing else.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

every=${1:-20}
shift || true
folders=("$@")
if [ ${#folders[@]} -eq 0 ]; then
  mapfile -t folders < <(find waymark workbench -mindepth 1 -maxdepth 1 -type d -printf '%f\n' | sort)
fi

# sources_of FOLDER NAMES: its files of that kind, but for those of modules.
sources_of() { find "waymark/$1" "workbench/$1" -maxdepth 1 -name "$2" 2>/dev/null | sort; }

# measure FILE: touches it, and prints the seconds that building and testing its folder then take.
measure() {
  local folder start
  folder=$(basename "$(dirname "$1")")
  touch "$1"
  start=$EPOCHREALTIME
  CCACHE_RECACHE=1 cmake --build --preset dev --target "waymark_${folder}_test" -- --quiet </dev/null
  ctest --preset quick -L "^$folder\$" </dev/null >build/dev/measured.log
  awk -v from="$start" -v to="$EPOCHREALTIME" -v file="$1" 'BEGIN { printf "%6.1f s  %s\n", to - from, file }'
}

cmake --preset dev >/dev/null
targets=("${folders[@]/#/waymark_}")
cmake --build --preset dev --target "${targets[@]/%/_test}" -- --quiet
for folder in "${folders[@]}"; do sources_of "$folder" '*.cpp'; done | awk -v n="$every" 'NR % n == 1 || n == 1' |
  while read -r file; do measure "$file"; done | tee build/dev/edits.txt
for folder in "${folders[@]}"; do sources_of "$folder" '*options.hpp'; done |
  while read -r file; do measure "$file"; done | tee build/dev/option_edits.txt
sort -n build/dev/edits.txt | awk '{ t[NR] = $1 } $1 <= 15 { ++quick } END {
  printf "%d sources: median %.1f s, longest %.1f s, within 15 s: %.0f %%\n", NR, t[int((NR + 1) / 2)], t[NR], 100 * quick / NR }'
sort -n build/dev/option_edits.txt | awk '{ last = $1 } END { if (NR) printf "%d options headers: longest %.1f s\n", NR, last }'
