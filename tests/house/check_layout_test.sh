#!/usr/bin/env bash
# check_layout.sh passes a sound tree and names each kind of offence.
set -euo pipefail
check=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)/scripts/check_layout.sh
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT

mkdir -p "$tree/waymark/core"
cd "$tree/waymark/core"
echo 'waymark_folder(core SOURCES good.cpp)' >CMakeLists.txt
printf '#pragma once\n#include <vector>\n' >good.hpp
echo '#include "waymark/core/good.hpp"' >good.cpp
"$check" "$tree" || { echo "a sound tree was refused"; exit 1; }

# refused FILE TEXT: a file with this text must make the check fail and be named by it.
refused() {
  printf '%b' "$2" >"$1"
  if "$check" "$tree" >"$tree/said"; then
    echo "accepted: $1: $2"
    exit 1
  fi
  grep -q "waymark/core/$1" "$tree/said" || { echo "not named: $1"; cat "$tree/said"; exit 1; }
  rm "$1"
}
refused sideways.hpp '#pragma once\n#include "../slam/pipeline.hpp"\n'
refused upstairs.hpp '#pragma once\n#include "workbench/config/schema.hpp"\n'
refused short.hpp '#pragma once\n#include "good.hpp"\n'
refused unguarded.hpp 'int f();\n'
refused good.cpp 'auto root = YAML::Load(text);\n'
refused good.cpp 'auto text = json.dump(2);\n'
refused good.cpp 'workers_.emplace_back([] {});\n'
refused good.cpp 'std::thread worker([] {});\n'
refused forgotten.cpp '#include "waymark/core/good.hpp"\n'
