#!/usr/bin/env bash
# Checks what the compiler cannot: no include leaves its folder sideways, every header is guarded, and every source and
# test is part of the build. Usage: check_layout.sh [ROOT]. Prints each offence as file:line: text.
set -euo pipefail
cd "${1:-$(dirname "${BASH_SOURCE[0]}")/..}"

folders=()
for folder in waymark workbench workshop apps tests bench examples; do
  if [ -d "$folder" ]; then folders+=("$folder"); fi
done
offences=0

# complain REASON: prints the lines on standard input, if any, as offences.
complain() {
  local lines
  lines=$(cat)
  [ -n "$lines" ] || return 0
  printf '%s\n' "$lines" | sed "s|\$|    <- $1|"
  offences=1
}

complain 'an include must not leave its folder by a relative path' < <(
  grep -rnE --include='*.[ch]pp' '^\s*#\s*include\s*["<][^">]*\.\./' "${folders[@]}" || true)
floors=()
for floor in waymark workbench workshop; do
  if [ -d "$floor" ]; then floors+=("$floor"); fi
done
complain 'include our headers as "<floor>/<folder>/<file>.hpp" and those of others as <...>' < <(
  grep -rnE --include='*.[ch]pp' '^\s*#\s*include\s*"' "${floors[@]}" |
    grep -vE '"(waymark|workbench|workshop)/[a-z]+/' || true)
complain 'the engine includes nothing of the workbench, and neither anything of the workshop' < <(
  { grep -rnE --include='*.[ch]pp' '^\s*#\s*include\s*["<]work(bench|shop)/' waymark
    grep -rnE --include='*.[ch]pp' '^\s*#\s*include\s*["<]workshop/' workbench apps; } 2>/dev/null || true)
complain 'a header begins with #pragma once' < <(
  find "${folders[@]}" -name '*.hpp' -print0 | xargs -0 -r grep -L '^#pragma once' || true)
# One place each, so that what is checked there holds everywhere.
# only_in FILE PATTERN REASON
only_in() {
  complain "$3" < <(grep -rnE --include='*.[ch]pp' "$2" "${floors[@]}" apps 2>/dev/null | grep -v "^$1:" || true)
}
only_in workbench/config/load_yaml.cpp 'YAML::Load' 'load_yaml() refuses what unfolds without end'
only_in workbench/logs/json_text.hpp '\.dump\(' 'json_text() takes names of any bytes'
only_in waymark/core/threads.cpp 'std::(jthread|async)|std::thread [a-z_]*[({]|(thread|worker)[a-z]*_?\.emplace' \
  'start_threads() ends cleanly where a thread cannot be started'

complain 'not named in the CMakeLists.txt beside it, so never compiled' < <(
  find "${folders[@]}" -name '*.cpp' -not -path 'examples/*' | while read -r source; do
    folder=$(dirname "$source")
    until [ -f "$folder/CMakeLists.txt" ] || [ "$folder" = . ]; do folder=$(dirname "$folder"); done
    grep -qF "${source#"$folder"/}" "$folder/CMakeLists.txt" 2>/dev/null || echo "$source"
  done)

exit "$offences"
