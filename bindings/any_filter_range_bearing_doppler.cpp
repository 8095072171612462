// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "any_filter_update.hpp"

template wakeline::Step<3> wakeline::python::AnyFilter::update(const RangeBearingDoppler&,
                                                               const Vec<double, 3>&) noexcept;
