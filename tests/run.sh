#!/usr/bin/env bash
# Installs what is missing, builds, and runs the tests.
#
#   bash tests/run.sh              the C++ tests (ctest) and the Python tests (pytest)
#   bash tests/run.sh --sanitize   every header with clang 14, and the C++ tests with its address and
#                                  undefined-behaviour sanitizers
#
# Where CI is set any warning is an error: not for users, whose compilers warn of other things than ours.
set -euo pipefail
case ${1:-} in
  '') preset=dev purpose=tests ;;
  --sanitize) preset=sanitize purpose=sanitize ;;
  *) sed -n 's/^#   //p' "${BASH_SOURCE[0]}" >&2; exit 2 ;;
esac
source "$(dirname "${BASH_SOURCE[0]}")/../python/setup.sh" "$purpose"

cd "$root"
cmake --preset "$preset" --log-level=WARNING ${CI:+-DWAKELINE_WARNINGS_AS_ERRORS=ON}
cmake --build --preset "$preset" --parallel "$jobs"
ctest --preset "$preset" --parallel "$jobs"
if [[ $preset == dev ]]; then
  "$python" -m pytest --numprocesses "$jobs" --dist loadfile --durations 20
fi
