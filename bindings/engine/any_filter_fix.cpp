// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "any_filter_update.hpp"

template wakeline::Correction<2> wakeline::python::AnyFilter::correct_by(
    const Fix&, const Gaussian<2>&) noexcept;
template wakeline::Correction<2> wakeline::python::AnyFilter::compare_by(
    const Fix&, const Gaussian<2>&) const noexcept;
