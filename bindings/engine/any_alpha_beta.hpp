// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include "any_filter.hpp"
#include "support/types.hpp"
#include "wakeline/filter/alpha_beta.hpp"

namespace wakeline::python {

/// An alpha-beta filter with beliefs of any layout.
template <int Order>
class AnyAlphaBeta : public AlphaBetaFilter<Order> {
  using Filter = AlphaBetaFilter<Order>;

 public:
  using Filter::Filter;

  Status start(const AnyBelief& belief) noexcept {
    if (belief.mean.size() == 4) return Filter::start(Gaussian<4>{belief.mean, belief.covariance});
    return Filter::start(Gaussian<2 * Order>{belief.mean, belief.covariance});
  }

  [[nodiscard]] AnyBelief estimate() const noexcept {
    const auto& belief = Filter::estimate();
    return {Order == 2 ? StateLayout::kKinematics : StateLayout::kAcceleration, belief.mean,
            belief.covariance};
  }

  /// It takes the position out of any sensor.
  [[nodiscard]] bool linear() const noexcept { return false; }
};

}  // namespace wakeline::python
