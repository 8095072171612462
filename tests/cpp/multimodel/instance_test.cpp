// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A program may instantiate an estimator whole, in one of its files, to spare the others the time.
#include "wakeline/filter/ekf.hpp"
#include "wakeline/filter/square_root_ukf.hpp"
#include "wakeline/filter/ukf.hpp"
#include "wakeline/motion/constant_velocity.hpp"
#include "wakeline/motion/coordinated_turn.hpp"
#include "wakeline/multimodel/filter_bank.hpp"
#include "wakeline/multimodel/imm.hpp"
#include "wakeline/multimodel/uniform_bank.hpp"
#include "wakeline/multimodel/variant_bank.hpp"

namespace wakeline {

template class Kalman<ConstantVelocity>;
template class Ekf<CoordinatedTurnRate>;
template class Ukf<CoordinatedTurnRate>;
template class SquareRootUkf<CoordinatedTurnRate>;
template class Imm<FilterBank<Kalman<ConstantVelocity>, Ekf<CoordinatedTurnRate>>>;
template class Imm<UniformBank<Kalman<ConstantVelocity>, 3>>;
template class Imm<UniformBank<Kalman<ConstantVelocity>>>;
template class Imm<VariantBank<4, Kalman<ConstantVelocity>, Ekf<CoordinatedTurnRate>>>;

}  // namespace wakeline
