#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Install, build, run all tests; the last line says how many passed, failed and were skipped.
#   ./test.sh [options of ctest, such as -L unit]
set -euo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source "$top/scripts/setup.sh"

install_packages
build "$top"
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1

report=$top/build/release/test-report.xml
rm -f "$report"
ctest --test-dir "$top/build/release" --output-on-failure -j 2 --output-junit "$report" "$@" || true
[[ -f "$report" ]] || fail "ctest has not run the tests"

# The attributes of the report's first element, <testsuite tests="..." failures="..." disabled="..." skipped="...">.
attribute() {
  sed -nE "1,/>/s/.*[[:space:]]$1=\"([0-9]+)\".*/\1/p" <(tr '\n' ' ' <"$report" | sed 's/<testcase/\n&/g') | head -n 1
}
total=$(attribute tests)
# One that says that it cannot be made here (GTEST_SKIP) is skipped; one that could not be started has failed.
skipped=$(grep -c '<skipped message="SKIP_REGULAR_EXPRESSION_MATCHED"' "$report" || true)
failed=$(($(attribute failures) + $(attribute disabled) + $(attribute skipped) - skipped))
passed=$((total - failed - skipped))

echo "Testing the pictures"
if python=$(find_python) && (cd "$top" && "$python" -m unittest discover -s tests/postprocess); then
  passed=$((passed + 1))
else
  echo "The test of postprocess failed (or no Python with numpy, h5py, matplotlib and pandas was found)" >&2
  failed=$((failed + 1))
fi

echo "$passed passed, $failed failed, $skipped skipped"
((failed == 0 && passed > 1))
