#!/usr/bin/env bash
# CPU time of builds, user and system of all processes, in seconds and in units of a fixed piece of C++ that is compiled
# before and after, so that figures of two machines compare.
#
#   bash cpp/benchmarks/build_time.sh demo    bash python/demo.sh of a clean clone
#   bash cpp/benchmarks/build_time.sh tests   bash tests/run.sh of a clean clone
#   bash cpp/benchmarks/build_time.sh units   translation units of users, at -O2
#
# Clones hold what is committed; ccache is off. CXX is the compiler, g++ unless set.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd -P)
export CCACHE_DISABLE=1 CXX=${CXX:-g++}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# cpu_s <command>...: runs it and prints its CPU seconds.
cpu_s() {
  local TIMEFORMAT='%U %S'
  if ! { time "$@" >"$work/log" 2>&1; } 2>"$work/time"; then
    tail -n 40 "$work/log" >&2
    return 1
  fi
  awk '{printf "%.2f\n", $1 + $2}' "$work/time"
}

compile() {
  "$CXX" -std=c++20 "${@:2}" -I "$root/cpp/include" -isystem "${EIGEN:-/usr/include/eigen3}" -c "$work/$1.cpp" \
    -o "$work/$1.o"
}

cat >"$work/reference.cpp" <<'CPP'
#include <Eigen/Dense>
template <int N>
double of_size(const double* numbers) {
  const Eigen::Matrix<double, N, N> matrix = Eigen::Map<const Eigen::Matrix<double, N, N>>(numbers);
  const Eigen::LLT<Eigen::Matrix<double, N, N>> root(matrix);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, N, N>> axes(matrix);
  return root.solve(axes.eigenvalues()).sum() + axes.eigenvectors().sum();
}
double reference(const double* numbers) {
  return of_size<3>(numbers) + of_size<4>(numbers) + of_size<5>(numbers) + of_size<6>(numbers);
}
CPP
reference() { cpu_s compile reference -O3; }

# row <name> <CPU s> <CPU s of the unit>
row() { awk -v name="$1" -v s="$2" -v unit="$3" 'BEGIN {printf "%-44s %8.1f CPU s %7.2f units\n", name, s, s / unit}'; }

# clone <script>: the script in a clean clone.
clone() { git clone -q "$root" "$work/wakeline" && bash "$work/wakeline/$1" </dev/null; }

units() {
  local unit=$1 name spent
  cat >"$work/eigen.cpp" <<<'#include <Eigen/Dense>'
  cat >"$work/umbrella.cpp" <<<'#include <wakeline/wakeline.hpp>'
  cat >"$work/imm.cpp" <<'CPP'
#include <wakeline/filter/ekf.hpp>
#include <wakeline/measurement/range_bearing.hpp>
#include <wakeline/motion/coordinated_turn.hpp>
#include <wakeline/multimodel/imm.hpp>
using namespace wakeline;
Gaussian<4> run(const double* z, int scans) {
  const auto turning = [](double rate_rad_s) { return Ekf{CoordinatedTurn{.turn_rate_rad_s = rate_rad_s}}; };
  Imm imm{ModeChain<3>::staying(0.9), turning(0.0), turning(0.02), turning(-0.02)};
  (void)imm.start(Gaussian<4>{});
  for (int k = 0; k < scans; ++k) {
    (void)imm.predict(2.5);
    (void)imm.update(RangeBearing{}, Vec<double, 2>(z[2 * k], z[2 * k + 1]));
  }
  return imm.estimate();
}
CPP
  cat >"$work/tracker.cpp" <<'CPP'
#include <wakeline/track/tracker.hpp>
#include <wakeline/track/vessel_models.hpp>
#ifdef WAKELINE_COMPILED_TRACKER
#include <wakeline/track/compiled.hpp>
#endif
using namespace wakeline;
int run(std::span<const Plot> plots, double time_s) {
  const Radar radar;
  Tracker<VesselImm> tracker(radar, TrackerConfig{}, vessel_imm(radar));
  return int(tracker.process(time_s, plots).events.size());
}
CPP
  for name in eigen umbrella imm tracker; do
    spent=$(cpu_s compile "$name" -O2)
    row "$name.cpp" "$spent" "$unit"
  done
  spent=$(cpu_s compile tracker -O2 -DWAKELINE_COMPILED_TRACKER)
  row "tracker.cpp with wakeline::tracker" "$spent" "$unit"
}

case ${1:-} in
  demo) script=python/demo.sh ;;
  tests) script=tests/run.sh ;;
  units) ;;
  *) sed -n 's/^#   //p' "${BASH_SOURCE[0]}" >&2; exit 2 ;;
esac
unit=$(reference)
row "reference unit" "$unit" "$unit"
if [[ $1 == units ]]; then
  units "$unit"
else
  spent=$(cpu_s clone "$script")
  after=$(reference)
  row "reference unit, afterwards" "$after" "$unit"
  row "bash $script" "$spent" "$(awk -v a="$unit" -v b="$after" 'BEGIN {print (a + b) / 2}')"
fi
