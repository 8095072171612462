// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// What every binding of the engine parses anyway, to be precompiled.
#pragma once

#include "face.hpp"
#include "support/arrays.hpp"
#include "support/copies.hpp"
#include "support/fields.hpp"
