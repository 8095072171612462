// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Prints the state of an estimator after a course, bit by bit.
#include <cmath>
#include <cstdio>

#include "wakeline/filter/ekf.hpp"
#include "wakeline/filter/ukf.hpp"
#include "wakeline/measurement/range_bearing.hpp"
#include "wakeline/motion/coordinated_turn.hpp"
#include "wakeline/multimodel/imm.hpp"

int main() {
  using namespace wakeline;
  const RangeBearing radar{};
  Imm imm{ModeChain<3>::from_sojourn_s({60.0, 30.0, 30.0}), Ekf{CoordinatedTurn{}},
          Ekf{CoordinatedTurn{.turn_rate_rad_s = 0.02}}, Ukf{CoordinatedTurnRate{}}};
  Gaussian<4> start{{3000.0, 5.0, 4000.0, -7.0}, Mat<double, 4, 4>::Identity() * 100.0};
  if (imm.start(start) != Status::kOk) return 1;
  for (int k = 0; k < 200; ++k) {
    const double angle = 0.9 + 0.002 * k + 0.01 * std::sin(1.7 * k);
    if (imm.predict(2.5) != Status::kOk) return 1;
    if (!imm.update(radar, Vec<double, 2>(5000.0 + 10.0 * std::cos(k), angle))) return 1;
  }
  Archive state;
  imm.archive(state);
  for (const std::byte byte : state.bytes()) std::printf("%02x", std::to_integer<unsigned>(byte));
  std::printf("\n");
}
