#!/usr/bin/env bash
# Installs what is missing, builds, and runs the tests.
#
#   bash tests/run.sh              the C++ tests (ctest) and the Python tests (pytest)
#   bash tests/run.sh --sanitize   the C++ tests with the address and undefined-behaviour sanitizers
#   bash tests/run.sh --clang      with clang 14: every header, and the tests of a few nouns
set -euo pipefail
case ${1:-} in
  '') preset=dev purpose=tests ;;
  --sanitize) preset=sanitize purpose=tests ;;
  --clang) preset=clang purpose=clang ;;
  *) sed -n 's/^#   //p' "${BASH_SOURCE[0]}" >&2; exit 2 ;;
esac
source "$(dirname "${BASH_SOURCE[0]}")/../python/setup.sh" "$purpose"

cd "$root"
cmake --preset "$preset" --log-level=WARNING
if [[ $preset == clang ]]; then
  cmake --build --preset clang --parallel "$jobs" \
    --target wakeline_headers wakeline_motion_test wakeline_measurement_test wakeline_association_test
  ctest --preset clang --parallel "$jobs" --label-regex '^(motion|measurement|association)$'
else
  cmake --build --preset "$preset" --parallel "$jobs"
  ctest --preset "$preset" --parallel "$jobs"
fi
if [[ $preset == dev ]]; then
  "$python" -m pytest
fi
