// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Models that are activated and deactivated, in a bank without inactive filters.
#include "wakeline/filter/ekf.hpp"
#include "wakeline/motion/coordinated_turn.hpp"
#include "wakeline/multimodel/likely_model_set_imm.hpp"
#include "wakeline/multimodel/uniform_bank.hpp"

using namespace wakeline;

int main() {
#ifdef WAKELINE_COMPILE_FAIL
  constexpr int kModels = 5;
#else
  constexpr int kModels = kRuntimeModes;
#endif
  using Bank = UniformBank<Ekf<CoordinatedTurn>, kModels>;
  const Bank bank(Ekf{CoordinatedTurn{}}, 5);
  const LikelyModelSetImm<Bank> models({}, ModeChain<kModels>::staying(0.9, 5), bank);
  return models.started() ? 1 : 0;
}
