#!/usr/bin/env bash
# check_glossary.sh passes a sound tree and names each word that is out.
set -euo pipefail
check=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)/scripts/check_glossary.sh
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
cd "$tree"
mkdir -p docs waymark web/built
cat >docs/glossary.md <<'END'
# Glossary

| term | meaning |
| --- | --- |
| `*gadget*` | a term is not a word that is out |

## Words not to use

| word | term |
| --- | --- |
| `*widget*` | instrument |
| `news` | information |
| `slow error*` | bias |
END
echo 'int instrument = newspaper; // gadget, slow, error' >waymark/a.cpp
echo 'a widget' >web/built/a.html
"$check" . || { echo 'a sound tree is refused'; exit 1; }

# refuses TEXT WORD: a file of this text is refused, by name, line and word.
refuses() {
  printf 'first\n%s\n' "$1" >waymark/b.cpp
  out=$("$check" . || true)
  grep -qF "waymark/b.cpp:2: \`$2\`: the term is" <<<"$out" || { echo "'$1' gives '$out'"; exit 1; }
}
refuses 'int kMostWidgets = 1;' widget
refuses 'struct SlowErrors {};' slowerror
refuses '// a slow error' 'slow error'
refuses 'double slow_errors_;' slow_error
refuses 'news' news
refuses 'split_news(1)' news
rm docs/glossary.md
if "$check" . >/dev/null; then echo 'a tree without glossary passes'; exit 1; fi
