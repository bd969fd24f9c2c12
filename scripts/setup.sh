#!/usr/bin/env bash
# Installs what is missing to build Waymark on Debian 12. --opencv adds what `waymark calibrate camera` finds boards and reads
# videos with, --pages what bundling pages needs (scripts/pages.sh), --dev both and what tests and checks need; --list only
# names the packages of the option after it. Quick, without root and without network, when nothing is missing.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

packages=(
  g++ cmake ninja-build pkg-config ccache
  libeigen3-dev libhwy-dev libcli11-dev libfmt-dev libyaml-cpp-dev nlohmann-json3-dev
  libmatio-dev zlib1g-dev libbz2-dev liblz4-dev libzstd-dev libsqlite3-dev libpng-dev libjpeg-dev libnlopt-dev
  libcivetweb-dev
  libapriltag-dev
)
opencv_packages=(libopencv-contrib-dev libopencv-calib3d-dev libopencv-videoio-dev)
dev_packages=(
  libgtest-dev libgmock-dev libbenchmark-dev git python3
  libopenmpi-dev openmpi-bin
  python3-rosbag python3-nav-msgs python3-sensor-msgs python3-geometry-msgs lz4 zstd
  gcc-avr avr-libc libsimavr-dev libelf-dev
  clang-format-14 clang-tidy-16 clangd-16 valgrind gcovr chromium fonts-dejavu-core
  doxygen
)

list=no
if [ "${1:-}" = --list ]; then
  list=yes
  shift
fi
pages=no
case "${1:-}" in
  "") ;;
  --opencv) packages+=("${opencv_packages[@]}") ;;
  --pages) pages=yes ;;
  --dev) packages+=("${opencv_packages[@]}" "${dev_packages[@]}") pages=yes ;;
  *) echo "usage: setup.sh [--list] [--opencv|--pages|--dev]" >&2; exit 2 ;;
esac
if [ "$pages" = yes ]; then
  command -v node >/dev/null || packages+=(nodejs)
  command -v npm >/dev/null || packages+=(npm)
fi

if [ "$list" = yes ]; then
  printf '%s\n' "${packages[@]}"
  exit
fi

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null || true)
  if [ "$status" != installed ]; then missing+=("$package"); fi
done

if [ ${#missing[@]} -gt 0 ]; then
  echo "setup: installing ${missing[*]}"
  as_root=()
  if [ "$(id -u)" -ne 0 ]; then as_root=(sudo); fi
  "${as_root[@]}" apt-get update -qq
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
fi

# The lock file that node_modules was installed from is remembered inside it.
installed_lock=web/node_modules/.installed-package-lock.json
if [ "$pages" = yes ] && ! cmp -s web/package-lock.json "$installed_lock"; then
  echo "setup: installing the node packages of web/"
  npm ci --prefix web --no-audit --no-fund --loglevel=error
  mkdir -p web/node_modules
  cp web/package-lock.json "$installed_lock"
fi
echo "setup: complete"
