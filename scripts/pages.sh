#!/usr/bin/env bash
# Bundles the pages of web/ into web/built/, from where they are built into the program; --check changes nothing and fails
# where a page is not what its sources bundle to. Needs scripts/setup.sh --pages.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

built=web/built
out=$built
case "${1:-}" in
  "") ;;
  --check)
    out=$(mktemp -d)
    trap 'rm -rf "$out"' EXIT
    ;;
  *) echo "usage: pages.sh [--check]" >&2; exit 2 ;;
esac

for page in web/*/page.html; do
  name=$(basename "$(dirname "$page")")
  node web/build.mjs "$name" "$out/$name.html"
done
if ! diff -rq "$built" "$out"; then
  echo "pages: $built is not what the sources bundle to: run scripts/pages.sh and commit what it makes" >&2
  exit 1
fi
echo "pages: $built holds what the sources bundle to"
