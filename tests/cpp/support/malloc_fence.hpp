// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

namespace wakeline::test {

/// Counts every heap allocation of the calling thread (malloc and all that ends in it, operator new
/// included) while it lives. Where Eigen's assertions are on, an allocation by Eigen also stops the
/// test on the spot, which shows the stack.
///
///     NoHeap fence;
///     imm.predict(dt_s);
///     const auto step = imm.update(radar, z);
///     EXPECT_EQ(fence.allocations(), 0);
///
/// Fences nest; each counts from its own start.
class NoHeap {
 public:
  NoHeap();
  ~NoHeap();
  NoHeap(const NoHeap&) = delete;
  NoHeap& operator=(const NoHeap&) = delete;

  /// Allocations since construction.
  [[nodiscard]] long allocations() const;

 private:
  long start_;
  bool eigen_was_allowed_;
};

}  // namespace wakeline::test
