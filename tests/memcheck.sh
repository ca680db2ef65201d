#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# valgrind's memcheck on a few time steps of a small case:
#   tests/memcheck.sh [EXECUTABLE] [options of gemmule]
# The executable must not use instructions that valgrind does not know (AVX-512): take a debug build, which is not
# compiled for the machine's own processor. Exit code 0: no error, no definite leak but those of
# tests/support/valgrind.supp and of Open MPI.
set -euo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
gemmule=${1:-$top/build/debug/gemmule}
shift || true

results=$(mktemp -d)
trap 'rm -rf "$results"' EXIT
suppressions=(--suppressions="$top/tests/support/valgrind.supp")
for file in /usr/share/openmpi/openmpi-valgrind.supp /usr/lib/*/pmix2/share/pmix/pmix-valgrind.supp; do
  [[ -f "$file" ]] && suppressions+=(--suppressions="$file")
done

# When it is loaded, CGAL, which deal.II's debug library contains and nothing here uses, tests how the processor rounds.
# valgrind has one way of rounding only, and the test would end the program. So it is replaced by nothing.
cat >"$results/no_rounding_test.c" <<'EOF'
void _ZN4CGAL11Interval_ntILb0EE27Test_runtime_rounding_modesC1Ev(void *object) { (void)object; }
void _ZN4CGAL11Interval_ntILb0EE27Test_runtime_rounding_modesC2Ev(void *object) { (void)object; }
void _ZN4CGAL11Interval_ntILb1EE27Test_runtime_rounding_modesC1Ev(void *object) { (void)object; }
void _ZN4CGAL11Interval_ntILb1EE27Test_runtime_rounding_modesC2Ev(void *object) { (void)object; }
EOF
cc -shared -fPIC -o "$results/no_rounding_test.so" "$results/no_rounding_test.c"
export LD_PRELOAD="$results/no_rounding_test.so"

export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 DEAL_II_NUM_THREADS=1
# The component of Open MPI that talks to other processes leaves buffers uninitialised; one process needs none.
export OMPI_MCA_btl=self OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
valgrind --tool=memcheck --error-exitcode=99 --leak-check=full --show-leak-kinds=definite \
  --errors-for-leak-kinds=definite --num-callers=30 "${suppressions[@]}" \
  "$gemmule" "$top/parameters/examples/quick.prm" --output "$results/run" \
  --set "Mesh/Bulk level=2" --set "Mesh/Membrane level=4" --set "Mesh/Phase boundary level=4" \
  --set "End time=0.002" "$@"
