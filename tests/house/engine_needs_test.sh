#!/usr/bin/env bash
# A program of some 40 lines compiles, links and runs against the installed engine where nothing else is to be seen but Eigen,
# Highway, and what belongs to the compiler and the C library. Usage: engine_needs_test.sh PREFIX EXAMPLE
set -euo pipefail
prefix=$1
example=$2
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT

lines=$(grep -cvE '^[[:space:]]*(//.*)?$' "$example")
[ "$lines" -le 45 ] || { echo "$example has $lines lines of code; it is to be about 40"; exit 1; }

# Directories of headers that the compiler looks into by itself, but of /usr/include only Eigen, Highway and the C library.
mkdir "$tree/include"
ln -s /usr/include/eigen3 /usr/include/hwy /usr/include/*.h "$tree/include"
for folder in arpa asm asm-generic bits gnu linux net netinet rpc sys; do
  if [ -d "/usr/include/$folder" ]; then ln -s "/usr/include/$folder" "$tree/include"; fi
done
search=(-isystem "$tree/include/eigen3")
for folder in $(c++ -xc++ -E -v /dev/null 2>&1 >/dev/null | sed -n '/^#include </,/^End/s/^ //p'); do
  case "$folder" in
    /usr/include) search+=(-isystem "$tree/include") ;;
    /usr/local/*) ;;
    *) search+=(-isystem "$folder") ;;
  esac
done

echo '#include <fmt/format.h>' >"$tree/other.cpp"
if c++ -nostdinc -nostdinc++ "${search[@]}" -fsyntax-only "$tree/other.cpp" 2>/dev/null; then
  echo "other packages can be seen, so this test would show nothing"
  exit 1
fi
folders=(core models kernels association ekf fastslam smooth vision slam)
libraries=$(find "$prefix" -name 'libwaymark_*.a' | grep -E "libwaymark_($(IFS='|' && echo "${folders[*]}"))\.a")
# shellcheck disable=SC2086  # one word per library
c++ -std=c++20 -nostdinc -nostdinc++ "${search[@]}" -I "$prefix/include" -o "$tree/program" "$example" \
  -Wl,--start-group $libraries -Wl,--end-group -lhwy -pthread
"$tree/program"

linked=$(ldd "$tree/program" | awk '{print $1}' | grep -vE '^(linux-vdso|/lib|lib(hwy|stdc\+\+|m|gcc_s|c|pthread)\.)' || true)
[ -z "$linked" ] || { echo "links what is not the engine's: $linked"; exit 1; }
