#!/usr/bin/env bash
# Checks that code, configs, pages and texts use the terms of docs/glossary.md: fails where a word stands that its table of
# "Words not to use" names. Usage: check_glossary.sh [ROOT]. Prints each offence as file:line: reason.
set -euo pipefail
cd "${1:-$(dirname "${BASH_SOURCE[0]}")/..}"

page=docs/glossary.md
[ -f "$page" ] || { echo "$page:1: is missing"; exit 1; }

# Where a word is in its place: beginning of the path, word or `*` for any, reason.
exceptions='
.clang-tidy            unnamed    a parameter without a name
tests/bags/            leg        joints of a walking robot
CHANGELOG.md           *          names things as they were called at the time
workbench/logs/map_forms.cpp  sighting  key of the JSON form of a map, which older programs read
tests/logs/map_forms_test.cpp  sighting  reads that key
docs/map-format.md     sighting   describes that key
workbench/config/former_keys  *  keys that were renamed
tests/config/former_keys      *  keys that were renamed
'

# Rows of the table: | `word` | term |. A word stands for itself as a whole; `*` before or behind it for what it is part of, a
# space for a space, an underscore or nothing.
rows=$(awk '/^## / { inside = /^## Words not to use/ } inside && /^\| `/ {
  split($0, cell, / \| /); word = cell[1]; sub(/^\| `/, "", word); sub(/`$/, "", word); sub(/ \|$/, "", cell[2])
  before = sub(/^\*/, "", word) ? "" : "(^|[^a-zA-Z0-9])"
  behind = sub(/\*$/, "", word) ? "" : "($|[^a-zA-Z0-9])"
  gsub(/ /, "[ _]?", word)
  print before word behind "\t" cell[2] }' "$page")
[ -n "$rows" ] || { echo "$page:1: has no table of words not to use"; exit 1; }

files=$(git ls-files --cached --others --exclude-standard 2>/dev/null || find . -type f -printf '%P\n')
files=$(grep -vE '^(web/(built|node_modules)/|web/package-lock\.json|docs/glossary\.md|docs/references\.bib|CITATION|LICENSE)|(^|/)check_glossary|\.(png|jpg|svg|csv|bag|db3|mat)$' <<<"$files")

status=0
all=$(cut -f1 <<<"$rows" | paste -sd'|')
found=$(tr '\n' '\0' <<<"$files" | xargs -0 grep -nIiE -- "$all" 2>/dev/null || true)
[ -z "$found" ] || awk -v rows="$rows" -v exceptions="$exceptions" '
  BEGIN {
    n = split(rows, row, "\n")
    for (i = 1; i <= n; ++i) { split(row[i], part, "\t"); out[i] = tolower(part[1]); term[i] = part[2] }
    e = split(exceptions, line, "\n")
    for (i = 1; i <= e; ++i) if (split(line[i], part, " ") > 1) { where[i] = part[1]; which[i] = part[2] }
  }
  {
    file = substr($0, 1, index($0, ":") - 1)
    rest = substr($0, length(file) + 2)
    number = substr(rest, 1, index(rest, ":") - 1)
    text = tolower(substr(rest, length(number) + 2))
    for (i = 1; i <= n; ++i) {
      if (!match(text, out[i])) continue
      word = substr(text, RSTART, RLENGTH)
      gsub(/^[^a-z0-9]+|[^a-z0-9]+$/, "", word)
      allowed = 0
      for (k in where)
        if (index(file, where[k]) == 1 && (which[k] == "*" || index(word, which[k]))) allowed = 1
      if (!allowed) { print file ":" number ": `" word "`: the term is " term[i] " (docs/glossary.md)"; offences = 1 }
    }
  }
  END { exit offences }' <<<"$found" || status=1
exit $status
