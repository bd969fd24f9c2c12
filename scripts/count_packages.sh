#!/usr/bin/env bash
# Prints how many packages scripts/setup.sh brings to a minimal Debian, and their size on disk. Nothing is installed: apt
# only plans. Arguments go to setup.sh, for example --dev.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# plan PACKAGES...: what apt would install for them on an empty disk, by name.
plan() {
  apt-get -s -o Dir::State::status=/dev/null install -y --no-install-recommends "$@" | awk '/^Inst / {print $2}' | sort
}

mapfile -t minimal < <(apt-cache dumpavail | awk -v RS= '/\nEssential: yes|\nPriority: (required|important)\n/ {sub(/^Package: /, ""); print $1}' | sort -u)
mapfile -t wanted < <(scripts/setup.sh --list "$@")
added=$(comm -13 <(plan "${minimal[@]}") <(plan "${minimal[@]}" "${wanted[@]}"))
# shellcheck disable=SC2086  # a list of names
kb=$(apt-cache show --no-all-versions $added | awk '/^Installed-Size:/ {sum += $2} END {print sum}')
echo "packages: $(wc -w <<<"$added") more than on a minimal Debian, $((kb / 1000)) MB on disk"
