#!/usr/bin/env bash
# Adds a motion model, a sensor and a tracker setting to a copy of the tree as CONTRIBUTING.md says, builds the copy and
# uses them in C++ and in Python. Each model is its header and one line of the catalog; the setting is one place.
#
#   bash tests/addition/run.sh          both
#   bash tests/addition/run.sh --cpp    C++ alone, in half a minute
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../../python/setup.sh" tests
here=$root/tests/addition tree=$root/build/addition/tree build=$root/build/addition/build

rm -rf "$tree"
mkdir -p "$tree"
cp -R "$root"/{CMakeLists.txt,bindings,cpp,python} "$tree"
find "$tree/python" -name '*.so' -delete

include=$tree/cpp/include/wakeline
cp "$here/damped_velocity.hpp" "$include/motion/"
cp "$here/north_east.hpp" "$include/measurement/"
# add <file> <line that begins so> <what to put before it>: exactly one place.
add() {
  [[ $(grep -c "^$2" "$1") == 1 ]] || { echo "no single line begins with '$2' in $1" >&2; exit 1; }
  sed -i "s|^$2|$3\n&|" "$1"
}
add "$include/catalog/motions.hpp" '#include "wakeline/motion/singer.hpp"' '#include "wakeline/motion/damped_velocity.hpp"'
sed -i 's/^using Motions = TypeList</&DampedVelocity, /' "$include/catalog/motions.hpp"
add "$include/catalog/sensors.hpp" '#include "wakeline/measurement/position.hpp"' '#include "wakeline/measurement/north_east.hpp"'
sed -i 's/^using Sensors = TypeList</&NorthEast, /' "$include/catalog/sensors.hpp"
add "$include/track/config.hpp" '  double detection_probability = ' '  double added_margin_m = 2.0;'
add "$include/track/config.hpp" '        field("detection_probability"' \
  '        field("added_margin_m", \&C::added_margin_m, kNotNegative, "m", "A margin."),'

"$CXX" -std=c++20 -I "$tree/cpp/include" -isystem /usr/include/eigen3 "$here/use.cpp" -o "$build.use"
"$build.use"
if [[ ${1:-} == --cpp ]]; then exit; fi

cmake -S "$tree" -B "$build" -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O0 -DWAKELINE_TESTS=OFF -DWAKELINE_EXAMPLES=OFF \
  -DWAKELINE_PYTHON=ON -DPython_EXECUTABLE="$python" --log-level=WARNING
cmake --build "$build" --parallel "$jobs" --target _engine
cp "$build"/bindings/_engine*.so "$tree/python/wakeline/"
PYTHONPATH=$tree/python "$python" "$here/use.py"
