// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

namespace wakeline {

/// `a` where the condition holds, else `b`.
template <class Scalar>
constexpr Scalar select(bool condition, Scalar a, Scalar b) noexcept {
  return condition ? a : b;
}

}  // namespace wakeline
