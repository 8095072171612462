// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// The version of Wakeline, for conditional compilation. CMake and the Python package read it here.
#pragma once

#define WAKELINE_VERSION_MAJOR 0
#define WAKELINE_VERSION_MINOR 1
#define WAKELINE_VERSION_PATCH 0

/// One number that grows from version to version: 100 for 0.1.0, 10203 for 1.2.3.
#define WAKELINE_VERSION \
  (WAKELINE_VERSION_MAJOR * 10000 + WAKELINE_VERSION_MINOR * 100 + WAKELINE_VERSION_PATCH)
