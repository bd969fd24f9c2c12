#!/usr/bin/env bash
# What a program of the engine includes and links: nothing but the engine, Eigen, Highway and the compiler's own.
# Usage: engine_needs_test.sh BUILD PREFIX EXAMPLE
set -euo pipefail
build=$1
prefix=$2
example=$3
trap 'rm -f "$build/example.d"' EXIT

lines=$(grep -cvE '^[[:space:]]*(//.*)?$' "$example")
[ "$lines" -le 45 ] || { echo "$example has $lines lines of code; it is to be about 40"; exit 1; }

c++ -std=c++20 -I "$prefix/include" -isystem /usr/include/eigen3 -M "$example" >"$build/example.d"
others=$(tr ' \\' '\n\n' <"$build/example.d" | grep '^/' | grep -vF "$prefix/include/waymark/" |
  grep -vE "^(${example//./\\.}|/usr/include/(eigen3|hwy)/|/usr/include/(c\+\+|[a-z0-9_]+-linux-gnu|linux|asm[a-z-]*|bits|sys|gnu|pthread|[a-z_0-9-]+\.h)|/usr/lib/gcc/)" || true)
[ -z "$others" ] || { echo "includes what is not the engine's:"; echo "$others"; exit 1; }

linked=$(ldd "$build/01_filter_in_your_loop" | awk '{print $1}' |
  grep -vE '^(linux-vdso|/lib|lib(hwy|stdc\+\+|m|gcc_s|c|pthread|asan|ubsan|tsan)\.)' || true)
[ -z "$linked" ] || { echo "links what is not the engine's: $linked"; exit 1; }
