#!/usr/bin/env bash
# Checks that docs/equations.md and the comments that cite equations, as `// Vincke (12)`, lead to each other: every
# citation has a row that links to its file, every link of a row leads to a file that holds the citation and the symbols
# named behind the link, and no number is left out. Usage: check_equations.sh [ROOT]. Prints each offence as file:line:
# reason.
set -euo pipefail
cd "${1:-$(dirname "${BASH_SOURCE[0]}")/..}"

page=docs/equations.md
[ -f "$page" ] || { echo "$page:1: is missing"; exit 1; }
folders=()
for folder in waymark workbench apps; do
  if [ -d "$folder" ]; then folders+=("$folder"); fi
done
# A heading of one word begins the table of the paper that is cited by this word.
papers=$(sed -nE 's/^## ([A-Za-z]+)$/\1/p' "$page" | paste -sd'|')
[ -n "$papers" ] || { echo "$page:1: has no paper: a heading of the one word that citations call it by"; exit 1; }

citations() {
  grep -rnoE --include='*.[ch]pp' --include='*.h' "(^|[^/])// ($papers) .*" "${folders[@]}" || true
}

citations | awk -v page="$page" -v papers="$papers" '
  function complain(place, reason) { print place ": " reason; offences = 1 }
  function kind_of(item) { return item ~ /^\(/ ? "equation" : substr(item, 1, index(item, " ") - 1) }
  function number_of(item) { gsub(/[^0-9]/, "", item); return item + 0 }
  BEGIN { ITEM = "(\\([0-9]+\\)|(Algorithm|Table|Figure) [0-9]+)" }

  # A citation: file:line:// Vincke (12)
  FILENAME == "-" {
    split($0, part, ":")
    place = part[1] ":" part[2]
    text = $0
    sub(/^[^:]*:[^:]*:.*\/\/ /, "", text)
    paper = substr(text, 1, index(text, " ") - 1)
    item_here = substr(text, length(paper) + 2)
    if (item_here !~ "^" ITEM "$") {
      complain(place, "a citation reads `// " paper " (1)` or `// " paper " Algorithm 1` and no more")
      next
    }
    cited[part[1], paper, item_here] = place
    cites[++citations] = part[1] SUBSEP paper SUBSEP item_here
    next
  }

  # The page.
  /^## / { paper = $0 ~ "^## (" papers ")$" ? $2 : "" }
  paper != "" && $0 ~ "^\\| " ITEM " " {
    match($0, ITEM)
    item_here = substr($0, RSTART, RLENGTH)
    place = page ":" FNR
    if ((paper, item_here) in row) complain(place, paper " " item_here " has another row")
    row[paper, item_here] = place
    key = paper SUBSEP kind_of(item_here)
    if (number_of(item_here) > most[key]) most[key] = number_of(item_here)
    last[key] = place
    links = split($0, link, /\]\(\.\.\//)
    for (i = 2; i <= links; ++i) {
      file = link[i]
      sub(/\).*/, "", file)
      if (file !~ /^(waymark|workbench|apps)\//) continue
      linked[file, paper, item_here] = 1
      if ((getline line < file) < 0) { complain(place, file " is missing"); continue }
      source = line
      while ((getline line < file) > 0) source = source "\n" line
      close(file)
      if (!((file, paper, item_here) in cited)) complain(place, file " has no comment `// " paper " " item_here "`")
      symbols = link[i]
      sub(/^[^)]*\)/, "", symbols)
      sub(/\|.*/, "", symbols)
      names = split(symbols, symbol, "`")
      for (k = 2; k <= names; k += 2)
        if (index(source, symbol[k]) == 0) complain(place, file " has no `" symbol[k] "`")
    }
  }

  END {
    for (c = 1; c <= citations; ++c) {
      split(cites[c], at, SUBSEP)
      if (!((at[2], at[3]) in row))
        complain(cited[cites[c]], at[2] " " at[3] " has no row in " page)
      else if (!(cites[c] in linked))
        complain(cited[cites[c]], "the row of " at[2] " " at[3] " in " page " does not link to this file")
    }
    for (key in most) {
      split(key, at, SUBSEP)
      for (n = 1; n < most[key]; ++n) {
        item_here = at[2] == "equation" ? "(" n ")" : at[2] " " n
        if (!((at[1], item_here) in row)) complain(last[key], at[1] " " item_here " is missing")
      }
    }
    exit offences
  }' - "$page"
