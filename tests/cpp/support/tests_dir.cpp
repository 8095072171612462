// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "support/tests_dir.hpp"

namespace wakeline::test {

std::filesystem::path tests_dir() { return WAKELINE_TESTS_DIR; }

}  // namespace wakeline::test
