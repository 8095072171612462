// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace wakeline::test {

/// The folder tests/ of the checkout. (Of its units one alone is compiled with the path, so that a
/// second checkout uses what ccache has of the first.)
std::filesystem::path tests_dir();

}  // namespace wakeline::test
