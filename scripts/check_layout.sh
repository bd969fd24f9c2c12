#!/usr/bin/env bash
# Checks what the compiler cannot: no include leaves its folder sideways, every header is guarded, and every source and
# test is part of the build. Usage: check_layout.sh [ROOT]. Prints each offence as file:line: text.
set -euo pipefail
cd "${1:-$(dirname "${BASH_SOURCE[0]}")/..}"

folders=()
for folder in waymark apps tests bench examples; do
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
complain 'include our headers as "waymark/<folder>/<file>.hpp" and those of others as <...>' < <(
  grep -rnE --include='*.[ch]pp' '^\s*#\s*include\s*"' waymark | grep -vE '"waymark/[a-z]+/' || true)
complain 'a header begins with #pragma once' < <(
  find "${folders[@]}" -name '*.hpp' -print0 | xargs -0 -r grep -L '^#pragma once' || true)
# One place each, so that what is checked there holds everywhere.
# only_in FILE PATTERN REASON
only_in() {
  complain "$3" < <(grep -rnE --include='*.[ch]pp' "$2" waymark apps 2>/dev/null | grep -v "^$1:" || true)
}
only_in waymark/core/load_yaml.cpp 'YAML::Load' 'load_yaml() refuses what unfolds without end'
only_in waymark/io/json_text.hpp '\.dump\(' 'json_text() takes names of any bytes'
only_in waymark/core/threads.cpp 'std::(jthread|async)|std::thread [a-z_]*[({]|(thread|worker)[a-z]*_?\.emplace' \
  'start_threads() ends cleanly where a thread cannot be started'

complain 'not named in the CMakeLists.txt beside it, so never compiled' < <(
  find "${folders[@]}" -name '*.cpp' -not -path 'examples/*' | while read -r source; do
    folder=$(dirname "$source")
    until [ -f "$folder/CMakeLists.txt" ] || [ "$folder" = . ]; do folder=$(dirname "$folder"); done
    grep -qF "${source#"$folder"/}" "$folder/CMakeLists.txt" 2>/dev/null || echo "$source"
  done)

exit "$offences"
