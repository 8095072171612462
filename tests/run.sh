#!/usr/bin/env bash
# Installs what is missing, builds, and runs the tests.
#
#   bash tests/run.sh              the C++ tests (ctest) and the Python tests (pytest)
#   bash tests/run.sh --sanitize   the C++ tests with the address and undefined-behaviour sanitizers
#   bash tests/run.sh --clang      the C++ tests with clang 14
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
cmake --build --preset "$preset" --parallel "$jobs"
ctest --preset "$preset" --parallel "$jobs"
if [[ $preset == dev ]]; then
  "$python" -m pytest
fi
