// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A unit that is compiled as C++17.
#ifdef WAKELINE_COMPILE_FAIL
#undef __cplusplus
#define __cplusplus 201703L
#endif
#include "wakeline/core/types.hpp"

int main() {}
