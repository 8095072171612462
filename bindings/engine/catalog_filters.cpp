// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "catalog.hpp"

namespace wakeline {

template class AnyFilterOf<Filters>;
template class AnyFilterBankOf<Filters>;
template Correction<2> AnyFilter::correct_by(const RangeBearing&, const Gaussian<2>&) noexcept;
template Correction<2> AnyFilter::correct_by(const ConvertedRangeBearing&,
                                             const Gaussian<2>&) noexcept;
template Correction<3> AnyFilter::correct_by(const RangeBearingDoppler&,
                                             const Gaussian<3>&) noexcept;

}  // namespace wakeline
