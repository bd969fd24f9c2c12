#!/usr/bin/env bash
# Checks that the integer kernels give the same bits on this machine's instruction sets and on an emulated ARM with
# NEON. Usage: check_arm.sh NATIVE_PROGRAM, with waymark_integer_checksums of a build. Says "skipped" where the cross
# compiler or the emulator is missing (Debian: g++-aarch64-linux-gnu, qemu-user-static).
set -euo pipefail
native=$(realpath "${1:?usage: check_arm.sh NATIVE_PROGRAM}")
cd "$(dirname "${BASH_SOURCE[0]}")/.."

compiler=aarch64-linux-gnu-g++
emulator=qemu-aarch64-static
for tool in "$compiler" "$emulator"; do
  if ! command -v "$tool" >/dev/null; then
    echo "check_arm: skipped, there is no $tool"
    exit 0
  fi
done

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# The headers of Highway are the same for all processors, but lie beside those of this one.
mkdir "$work/include"
ln -s /usr/include/hwy "$work/include/hwy"
"$compiler" -std=c++20 -O2 -static -DHWY_COMPILE_ONLY_STATIC -I "$work/include" -I . -o "$work/checksums" \
  tests/kernels/integer_checksums.cpp waymark/kernels/zmssd.cpp waymark/kernels/fast_corners.cpp

"$native" | tee "$work/lines"
"$emulator" -cpu cortex-a72 "$work/checksums" | tee -a "$work/lines"
if [ "$(sed 's/ on .*//' "$work/lines" | sort -u | wc -l)" -ne 1 ]; then
  echo "check_arm: the lines above differ" >&2
  exit 1
fi
echo "check_arm: the same bits everywhere"
