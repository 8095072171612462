// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "any_filter_update.hpp"

template wakeline::Step<2> wakeline::python::AnyFilter::update(const Position&,
                                                               const Vec<double, 2>&) noexcept;
