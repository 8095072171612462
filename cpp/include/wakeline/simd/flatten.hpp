// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

/// Before a function of the hot path: inlines every call in it, so that small matrices stay in
/// registers. Most of the time to compile such a function goes into this; builds whose speed does
/// not matter, such as those of tests, define `WAKELINE_NO_FLATTEN`.
#ifdef WAKELINE_NO_FLATTEN
#define WAKELINE_FLATTEN
#else
#define WAKELINE_FLATTEN [[gnu::flatten]]
#endif
