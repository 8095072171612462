// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <string>

namespace wakeline::test {

/// The message with which `build` fails, or "none".
template <class Build>
std::string rejection_of(Build&& build) {
  try {
    (void)build();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "none";
}

}  // namespace wakeline::test
