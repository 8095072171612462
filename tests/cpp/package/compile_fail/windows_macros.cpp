// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// After windows.h without NOMINMAX.
#ifdef WAKELINE_COMPILE_FAIL
#define max(a, b) (((a) > (b)) ? (a) : (b))
#define min(a, b) (((a) < (b)) ? (a) : (b))
#endif
#include "wakeline/core/types.hpp"

int main() {}
