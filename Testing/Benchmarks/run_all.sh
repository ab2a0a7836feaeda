#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# All benchmarks on occt-misc's models and those in the folders given; tables go to the terminal and
# to build/bench/*.md. BUILD names the build folder (default: build/release). A child process that
# fails or takes too long is a line beside its script's table. Exits 1, and names the script, if one
# fails or a child process crashes.
#   run_all.sh [--quick] [FOLDER...]   --quick: pictures, drawing, deformation, visible
#                            regions, times and our meshes at 1e-3 only
set -euo pipefail
here="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
export BUILD="${BUILD:-$here/../../build/release}"
quick=no tolerances=1e-3,1e-4 fewer=()
if [ "${1:-}" = --quick ]; then
  quick=yes tolerances=1e-3 fewer=(--quick)
  shift
fi

failed=()
times=()
# step SCRIPT [ARG...]: runs it with the folders, and goes on if it fails.
step() {
  local start=$SECONDS status=0 words="$*"
  printf '\n== %s\n' "$words"
  python3 "$here/$1" "${@:2}" "${folders[@]}" || status=$?
  # What fails a verification (3) is a finding, shown in its table; OpenCASCADE's meshes do.
  [ $status -eq 0 ] || [ $status -eq 3 ] || failed+=("$words (exit status $status)")
  times+=("$((SECONDS - start)) s: $words")
}

folders=("$@")
step pictures.py
step drawing.py "${fewer[@]}"
step deformation.py "${fewer[@]}"
step deforming.py "${fewer[@]}"
step free_form.py
step refinement.py
step ../Peers/compare_with_occt.py --tolerances "$tolerances"
if [ $quick = no ]; then
  step scale.py
  step paper_tables.py
fi
step visibility_truth.py --rays 1e5 --no-areas
step ../Peers/verify_all.py --tolerances "$tolerances"
if [ $quick = no ]; then
  step visibility.py
  step ../Peers/hidden_lines.py
  step ../Peers/verify_all.py --tolerances 1e-3 --error estimated
  step ../Peers/verify_all.py --tolerances "$tolerances" --occt
fi
printf '\n'
printf '%s\n' "${times[@]}"
if [ ${#failed[@]} -gt 0 ]; then
  printf 'FAILED: %s\n' "${failed[@]}"
  exit 1
fi
