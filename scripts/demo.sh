#!/usr/bin/env bash
# From a fresh machine to a first map: sets up, builds, and runs the demo, which needs no data and names its report.
# Arguments go to `waymark demo`.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/build.sh
echo "demo: build/release/waymark demo $*"
exec build/release/waymark demo "$@"
