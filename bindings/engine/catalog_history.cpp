// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "catalog.hpp"

namespace wakeline {

template class AnyModeHistoryOf<Filters>;
template Step<2> AnyModeHistory::update(const AnySensorOf<2>&, const Vec<double, 2>&) noexcept;
template Step<3> AnyModeHistory::update(const AnySensorOf<3>&, const Vec<double, 3>&) noexcept;

}  // namespace wakeline
