#!/usr/bin/env bash
# check_equations.sh passes a sound tree and names each kind of offence.
set -euo pipefail
check=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)/scripts/check_equations.sh
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
cd "$tree"

# sound: makes the tree anew.
sound() {
  rm -rf "${tree:?}"/*
  mkdir -p waymark/ekf workbench/eval apps docs
  cat >waymark/ekf/state.cpp <<'END'
void State::predict() { x = F * x; }  // Euler (1)
/// Euler 1750, equation 7: prose is no citation.
void State::update() {
  // Euler (2)
  P = H;  // Euler Algorithm 1
}
END
  echo 'double norm();  // Gauss (1)' >workbench/eval/norm.hpp
  cat >docs/equations.md <<'END'
# Equations

## Euler

| number | what it says | where |
| --- | --- | --- |
| (1) | prediction | [state.cpp](../waymark/ekf/state.cpp) `State::predict` |
| (2) | update | [state.cpp](../waymark/ekf/state.cpp) `State::update` |
| (3) † | | nothing computes it |
| Algorithm 1 | all | [state.cpp](../waymark/ekf/state.cpp) |
| Figure 1 | a drawing | |

## What follows

| (9) | of no paper | [gone.cpp](../waymark/gone.cpp) |

## Gauss

| number | what it says | where |
| --- | --- | --- |
| (1) | norm | [norm.hpp](../workbench/eval/norm.hpp) `norm` |
END
}

# refused WHERE REASON: the check fails and says so of this place.
refused() {
  if "$check" "$tree" >said; then
    echo "accepted: $1 $2"
    exit 1
  fi
  grep -qE "^$1:[0-9]+: .*$2" said || { echo "not said: $1 $2"; cat said; exit 1; }
  sound
}

sound
"$check" "$tree" || { echo "a sound tree was refused"; exit 1; }
[ -z "$("$check" "$tree")" ] || { echo "words about a sound tree"; exit 1; }

page=docs/equations.md
source=waymark/ekf/state.cpp
echo 'int x;  // Euler (4)' >>$source
refused $source 'Euler \(4\) has no row'
echo 'int x;  // Gauss (2)' >apps/main.cpp
refused apps/main.cpp 'Gauss \(2\) has no row'
echo 'int x;  // Euler (1)' >waymark/ekf/other-inl.h
refused waymark/ekf/other-inl.h 'does not link to this file'
for text in 'Euler 3' 'Euler (3) as printed' 'Euler (1),(2)' 'Euler equation 1' 'Euler algorithm 1'; do
  echo "int x;  // $text" >>$source
  refused $source 'a citation reads'
done
sed -i 's|  // Euler (1)||' $source
refused $page 'has no comment `// Euler \(1\)`'
sed -i 's|  // Euler Algorithm 1||' $source
refused $page 'has no comment `// Euler Algorithm 1`'
rm workbench/eval/norm.hpp
refused $page 'workbench/eval/norm.hpp is missing'
sed -i 's|State::update()|State::correct()|' $source
refused $page 'has no `State::update`'
sed -i '/^| (3)/d; s/^| Algorithm 1/| (4) | more | |\n&/' $page
refused $page 'Euler \(3\) is missing'
sed -i 's/^| Figure 1/| Figure 2/' $page
refused $page 'Euler Figure 1 is missing'
sed -i 's/^| (3)/| (2)/' $page
refused $page 'Euler \(2\) has another row'
sed -i '/^## /d' $page
refused $page 'has no paper'
rm $page
refused $page 'is missing'
