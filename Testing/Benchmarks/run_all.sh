#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# All benchmarks on occt-misc's models and those in the folders given; tables go to the terminal and
# to build/bench/*.md. BUILD names the build folder (default: build/release).
#   run_all.sh [--quick] [FOLDER...]     --quick: leave the verification at 1e-4 out
set -euo pipefail
here="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
export BUILD="${BUILD:-$here/../../build/release}"
tolerances=1e-3,1e-4
if [ "${1:-}" = --quick ]; then
  tolerances=1e-3
  shift
fi
status=0
python3 "$here/../Peers/compare_with_occt.py" "$@" || status=1
python3 "$here/scale.py" "$@" || status=1
python3 "$here/paper_tables.py" "$@" || status=1
python3 "$here/pictures.py" "$@" || status=1
for options in "" "--error estimated" "--occt"; do
  # A mesh that fails the verification is a finding, shown in its table; OpenCASCADE's do.
  # shellcheck disable=SC2086
  python3 "$here/../Peers/verify_all.py" --tolerances "$tolerances" $options "$@" || true
done
exit $status
