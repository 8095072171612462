// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Augmented noise for a motion that no readings drive.
#include "wakeline/filter/augmented_ukf.hpp"
#include "wakeline/motion/coordinated_turn.hpp"
#include "wakeline/navigation/usv_models.hpp"

int main() {
#ifdef WAKELINE_COMPILE_FAIL
  const wakeline::AugmentedUkf filter{wakeline::CoordinatedTurnRate{}};
#else
  const wakeline::AugmentedUkf filter{wakeline::UsvBiasMotion{}};
#endif
  return filter.started() ? 1 : 0;
}
