#!/usr/bin/env bash
# Makes the release build: build/release/waymark and the libraries.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/setup.sh
echo "build: build/release"
cmake --preset release >/dev/null
cmake --build --preset release
echo "build: the program is build/release/waymark"
