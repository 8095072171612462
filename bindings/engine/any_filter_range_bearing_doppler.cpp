// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "any_filter_update.hpp"

template wakeline::Correction<3> wakeline::python::AnyFilter::correct_by(
    const RangeBearingDoppler&, const Gaussian<3>&) noexcept;
