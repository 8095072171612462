// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Arithmetic in which nothing is ever not a number, as -ffast-math has it.
#ifdef WAKELINE_COMPILE_FAIL
#undef __FINITE_MATH_ONLY__
#define __FINITE_MATH_ONLY__ 1
#endif
#include "wakeline/core/types.hpp"

int main() {}
