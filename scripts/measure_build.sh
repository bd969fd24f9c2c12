#!/usr/bin/env bash
# What a whole build costs, with caches off and in a build folder of its own, which is removed: CPU seconds of all compiler
# processes and the memory of the largest, by library and program, the five largest, and the time on the clock. Usage: measure_build.sh
# [PRESET] [CMAKE ARGUMENTS...]; the preset is `release` unless given. Needs python3, and a machine that does nothing else.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

preset=${1:-release}
shift || true
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cat >"$work/measured" <<EOF
#!/usr/bin/env python3
import resource, subprocess, sys
status = subprocess.call(sys.argv[1:])
used = resource.getrusage(resource.RUSAGE_CHILDREN)
target = next((part[:-4] for word in sys.argv for part in word.split("/") if part.endswith(".dir")), "other")
name = sys.argv[-1].rsplit("/", 1)[-1]
with open("$work/log", "a") as log:
    print(target, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024, name, file=log)
sys.exit(status)
EOF
chmod +x "$work/measured"

export CCACHE_DISABLE=1
cmake --preset "$preset" -B "$work/build" "-DCMAKE_CXX_COMPILER_LAUNCHER=$work/measured" "$@" >/dev/null
start=$SECONDS
cmake --build "$work/build" >"$work/output" || { tail -n 40 "$work/output" >&2; exit 1; }
awk -v wall=$((SECONDS - start)) -v cores="$(nproc)" -v log_file="$work/log" '
  { files[$1]++; cpu[$1] += $2; if ($3 > most[$1]) most[$1] = $3; all++; sum += $2; if ($3 > largest) largest = $3 }
  END {
    for (target in files) printf "%-36s %4d processes %8.1f CPU s %6.0f MB\n", target, files[target], cpu[target], most[target] | "sort"
    close("sort")
    for (i = 0; i < 5 && (("sort -k3,3nr " log_file) | getline) > 0; i++)
      printf "  one of the largest: %s, %s, %.0f MB\n", $1, $4, $3
    printf "%-36s %4d processes %8.1f CPU s %6.0f MB\n", "sum, and the largest", all, sum, largest
    printf "%d s on the clock with %d cores, links included\n", wall, cores
  }' "$work/log"
