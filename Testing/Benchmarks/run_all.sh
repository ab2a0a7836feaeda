#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# All benchmarks on occt-misc's models and those in the folders given; tables go to the terminal and
# to build/bench/*.md. BUILD names the build folder (default: build/release). Exits 1, and names them,
# if scripts fail; a child process that fails or takes too long is a line of its script's table.
#   run_all.sh [--quick] [FOLDER...]   --quick: at 1e-3 only, one run each, without the paper's tables
set -euo pipefail
here="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
export BUILD="${BUILD:-$here/../../build/release}"
quick=no tolerances=1e-3,1e-4 repeat=3
if [ "${1:-}" = --quick ]; then
  quick=yes tolerances=1e-3 repeat=1
  shift
fi

failed=()
times=()
# step SCRIPT [ARG...]: runs it with the folders, and goes on if it fails.
step() {
  local start=$SECONDS status=0 words="$*"
  printf '\n== %s\n' "$words"
  python3 "$here/$1" "${@:2}" "${folders[@]}" || status=$?
  # A mesh that fails the verification (3) is a finding, shown in its table; OpenCASCADE's do.
  [ $status -eq 0 ] || [ $status -eq 3 ] || failed+=("$words (exit status $status)")
  times+=("$((SECONDS - start)) s: $words")
}

folders=("$@")
step pictures.py
step ../Peers/compare_with_occt.py --tolerances "$tolerances" --repeat "$repeat"
if [ $quick = no ]; then
  step scale.py
  step paper_tables.py
fi
step ../Peers/verify_all.py --tolerances "$tolerances"
if [ $quick = no ]; then
  step ../Peers/verify_all.py --tolerances "$tolerances" --error estimated
  step ../Peers/verify_all.py --tolerances "$tolerances" --occt
fi
printf '\n'
printf '%s\n' "${times[@]}"
if [ ${#failed[@]} -gt 0 ]; then
  printf 'FAILED: %s\n' "${failed[@]}"
  exit 1
fi
