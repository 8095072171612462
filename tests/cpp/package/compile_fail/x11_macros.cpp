// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// After the macros of X11/Xlib.h and X11/X.h.
#ifdef WAKELINE_COMPILE_FAIL
#define Status int
#define Success 0
#endif
#include "wakeline/core/types.hpp"

int main() {}
