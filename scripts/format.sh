#!/usr/bin/env bash
# Formats all C++ sources by .clang-format; --check changes nothing and fails where a file would change.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

case "${1:-}" in
  "") mode=(-i) ;;
  --check) mode=(--dry-run --Werror) ;;
  *) echo "usage: format.sh [--check]" >&2; exit 2 ;;
esac
# One version, because versions disagree about layout.
formatter=clang-format-14
echo "format: $formatter ${mode[*]}"
git ls-files -z --cached --others --exclude-standard -- '*.cpp' '*.hpp' '*-inl.h' |
  xargs -0 -r -n 20 -P 2 "$formatter" "${mode[@]}"
