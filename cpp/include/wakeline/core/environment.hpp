// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// What the headers ask of the unit that includes them. Each header includes this one first, itself
// or by another.
#pragma once

#if __cplusplus < 202002L
#error "wakeline needs C++20: compile with -std=c++20 (CMake: cxx_std_20)"
#endif

#if defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__
#error "wakeline: -ffast-math and -ffinite-math-only remove the checks for NaN"
#endif

#ifdef Status
#error \
    "wakeline: Status is a macro (of X11/Xlib.h): include wakeline first, or write #undef Status before it"
#endif
#ifdef Success
#error \
    "wakeline: Success is a macro (of X11/X.h) and a name of Eigen: include wakeline first, or write #undef Success before it"
#endif
#if defined(min) || defined(max)
#error \
    "wakeline: min or max is a macro (of windows.h): define NOMINMAX, or write #undef min and #undef max before wakeline"
#endif

// `wakeline::tracker` is linked. Units for a wider instruction set compile the tracker themselves, as
// their lanes are wider.
#if defined(WAKELINE_COMPILED_TRACKER) && !defined(__AVX__)
#define WAKELINE_USES_COMPILED_TRACKER
#endif
