#!/usr/bin/env bash
# Makes the reference of the public headers, with the pages of docs/, in build/doxygen; a link or a citation that leads
# nowhere is an error. Public are waymark/waymark.hpp, what it includes, and what the examples include of the workbench.
# Needs doxygen; it comes with scripts/setup.sh --dev. Without bibtex papers go by their keys in docs/references.bib.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

headers() {
  echo waymark/waymark.hpp
  sed -nE 's|^#include "(waymark/[^"]+)".*|\1|p' waymark/waymark.hpp
  sed -nE 's|^#include <(workbench/[^>]+)>.*|\1|p' examples/*.cpp | sort -u
}

# Filters of headers: the dot of "et al." ends no summary, and without bibtex nothing is cited by number.
settings() {
  local filters="-e 's,et al\. ,et al.\\\\ ,g'"
  cat docs/Doxyfile
  echo "INPUT += $(headers | paste -sd' ')"
  if ! command -v bibtex >/dev/null; then
    echo "CITE_BIB_FILES ="
    filters+=" -e 's,.cite ([a-z0-9]+),[\1],g'"
  fi
  printf '%s\n' "FILTER_PATTERNS += \"*.hpp=sed -E $filters\""
}

command -v doxygen >/dev/null || { echo "doxygen: is not installed; scripts/setup.sh --dev installs it" >&2; exit 1; }
rm -rf build/doxygen
mkdir -p build
# bibtex runs where doxygen has put the style and the list; Debian's without the rest of TeX does not look there by itself.
settings | BSTINPUTS=.: BIBINPUTS=.: doxygen -
echo "doxygen: the reference is build/doxygen/index.html"
