#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Install, build, run a case, draw its pictures:
#   ./run.sh [CASE.prm] [options of gemmule, such as --set "End time=1" or --output DIR]
# Without a case: parameters/examples/quick.prm. With NP=n in the environment: on n MPI ranks.
set -euo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source "$top/scripts/setup.sh"

case_file=$top/parameters/examples/quick.prm
if (($#)) && [[ "$1" != -* ]]; then
  case_file=$1
  shift
fi
[[ -f "$case_file" ]] || fail "there is no parameter file '$case_file' in $PWD"

install_packages
build "$top" gemmule
gemmule=$top/build/release/gemmule

# The linear algebra runs on MPI ranks; threads on top of them only get in their way.
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 DEAL_II_NUM_THREADS=1
for argument in "$@"; do
  case "$argument" in
    --help | --version | --check | --print-parameters) exec "$gemmule" "$case_file" "$@" ;;
  esac
done

launcher=()
if ((${NP:-1} > 1)); then
  launcher=(mpirun -n "$NP")
  ((EUID != 0)) || export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
fi
# mpirun answers Ctrl-C and SIGTERM by killing its processes a second later, which is too soon to save the
# state. SIGUSR1 it passes on. In a session of its own the terminal's Ctrl-C comes here only.
setsid "${launcher[@]}" "$gemmule" "$case_file" "$@" &
run=$!
signals=(INT TERM HUP QUIT USR1 USR2 XCPU PWR)
trap 'kill -USR1 "$run"' "${signals[@]}"
while true; do
  status=0
  wait "$run" || status=$?
  kill -0 "$run" 2>/dev/null || break # otherwise it was a signal that ended the waiting
done
trap - "${signals[@]}"
# 2 and 3: failed or stopped on the way; what has been computed is worth a picture.
((status == 0 || status == 2 || status == 3)) || exit "$status"

results=$("$gemmule" "$case_file" "$@" --print-parameters |
  sed -nE 's/^ *set +Output directory *= *([^#]*[^# ]).*/\1/p')
if python=$(find_python); then
  echo "Pictures:"
  "$python" "$top/postprocess" "$results" || status=$((status ? status : 1))
else
  echo "note: no pictures, since no Python with numpy, h5py, matplotlib and pandas was found" >&2
fi
echo "All results are in $results"
exit "$status"
