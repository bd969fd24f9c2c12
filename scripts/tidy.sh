#!/usr/bin/env bash
# Lints sources and headers by .clang-tidy; every finding is an error. Usage: tidy.sh [REF]; with a git REF only the files
# that differ from it. A file that passed is not looked at again until it, or something that it includes, changes.
#
# The checks run inside clangd, which matches them on the declarations of the file itself. clang-tidy matches them on all
# of Eigen as well, to the same end, and takes five times as long. It is used for the few files that Highway compiles once
# per instruction set by including them in themselves, which clangd does not follow.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# The flags of every file: nothing is built there.
commands=build/lint
cache=${XDG_CACHE_HOME:-$HOME/.cache}/waymark/tidy
cmake --preset lint >/dev/null
mkdir -p "$cache"

# check FILE: prints the findings as file:line: [check] text, and fails where there are any.
check() {
  if grep -q '^#define HWY_TARGET_INCLUDE' "$1"; then
    clang-tidy-16 --quiet --extra-arg=-Wno-unknown-warning-option --extra-arg=-Wno-unused-command-line-argument -p "$commands" "$1" 2>/dev/null
  else
    clangd-16 --check="$1" --check-lines=1-1 --compile-commands-dir="$commands" --log=error 2>&1 |
      sed -E "s|^E\[[0-9:.]+\] \[([^]]*)\] Line ([0-9]+):|$1:\2: [\1]|"
  fi
}

# lint FILE KEY: checks a file and remembers KEY where it passed.
lint() {
  if check "$1"; then touch "$cache/$2"; else return 1; fi
}
export -f check lint
export commands cache
export SHELLOPTS  # pipefail in the shells below

sources() { git ls-files --cached --others --exclude-standard -- '*.cpp' '*.hpp'; }

# Hash of each of our files, and which of our files it includes.
declare -A hash includes
while read -r sum file; do
  hash[$file]=$sum
done < <(sources | xargs sha256sum .clang-tidy scripts/tidy.sh)
while IFS=: read -r file include; do
  case "$include" in
    waymark/* | workbench/* | workshop/* | apps/*) includes[$file]+=" $include" ;;
    *) includes[$file]+=" tests/$include" ;;
  esac
done < <(sources | xargs grep -oHP '^\s*#include "\K[^"]+')

# key_of FILE: a hash of all that a verdict on the file depends on.
key_of() {
  local -A seen=([.clang-tidy]=1 [scripts/tidy.sh]=1)
  local pending=("$1") file
  while [ ${#pending[@]} -gt 0 ]; do
    file=${pending[-1]}
    unset 'pending[-1]'
    if [ -n "${seen[$file]:-}" ] || [ -z "${hash[$file]:-}" ]; then continue; fi
    seen[$file]=1
    # shellcheck disable=SC2206  # a list of file names without spaces
    pending+=(${includes[$file]:-})
  done
  {
    echo "$1"
    for file in "${!seen[@]}"; do echo "${hash[$file]}"; done | sort
  } | sha256sum | cut -c1-64
}

files=$(if [ $# -gt 0 ]; then git diff --name-only --diff-filter=d "$1" -- '*.cpp' '*.hpp'; else sources; fi)
total=0
todo=()
for file in $files; do
  total=$((total + 1))
  key=$(key_of "$file")
  if [ ! -e "$cache/$key" ]; then todo+=("$file" "$key"); fi
done

echo "tidy: $((${#todo[@]} / 2)) of $total files to check"
if [ ${#todo[@]} -gt 0 ]; then
  printf '%s\n' "${todo[@]}" | xargs -n 2 -P 2 bash -c 'lint "$@"' lint
fi
