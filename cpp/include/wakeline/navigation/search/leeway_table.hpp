// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Leeway of search objects: the motion through the water that wind and waves cause, downwind and
// crosswind.
//
// Sources: A. A. Allen, J. V. Plourde, Review of Leeway: Field Experiments and Implementation, US
// Coast Guard CG-D-08-99, 1999, with the list of 2010 that Ø. Breivik published in 2011; the use of
// the standard deviations follows Ø. Breivik, A. A. Allen, An operational search and rescue model
// for the Norwegian Sea and the North Sea, Journal of Marine Systems 69, 2008. The last four kinds
// are those of Hannoshyna, Kalinichenko, Nikitin (12), which have no crosswind part.
#pragma once

#include <array>
#include <cmath>
#include <string_view>

#include "wakeline/core/types.hpp"
#include "wakeline/navigation/leeway.hpp"

namespace wakeline {

/// One component of leeway as a straight line over the wind speed W:
///     slope W + offset + e (std_slope W + std_offset),
/// e the standard normal error of an object, the same during its whole drift.
struct LeewayLine {
  double slope = 0.0;
  double offset_mps = 0.0;
  double std_slope = 0.0;
  double std_offset_mps = 0.0;

  [[nodiscard]] constexpr double speed_mps(double wind_mps, double error) const noexcept {
    return slope * wind_mps + offset_mps + error * (std_slope * wind_mps + std_offset_mps);
  }
};

/// Leeway of a kind of object. Crosswind components are positive to the right of the direction that
/// the wind blows to: an object drifts to the `right` or to the `left` of it, until it jibes.
struct Leeway {
  std::string_view kind;
  std::string_view summary;
  LeewayLine downwind;
  LeewayLine right;
  LeewayLine left;

  /// Velocity through the water, [north, east] m/s, in a wind that blows to [north, east], with the
  /// errors [downwind, crosswind] of the object. Zero in a calm, which has no direction.
  [[nodiscard]] Vec<double, 2> velocity_mps(const Vec<double, 2>& wind_mps,
                                            const Vec<double, 2>& error,
                                            bool to_right) const noexcept {
    const double wind = wind_mps.norm();
    if (wind == 0.0) return wind_mps;
    const Vec<double, 2> ahead = wind_mps / wind, abeam(-ahead[1], ahead[0]);
    return downwind.speed_mps(wind, error[0]) * ahead +
           (to_right ? right : left).speed_mps(wind, error[1]) * abeam;
  }
};

namespace detail {

/// A line of the table of Allen: slope in %, offset and standard deviation in cm/s. Half of the
/// deviation belongs to the offset, half to the slope at 10 m/s (20 kn).
constexpr LeewayLine allen_line(double slope, double offset, double std) noexcept {
  return {slope / 100, offset / 100, std / 2000, std / 200};
}

/// A kind of the paper: a factor that is uniform over its range.
constexpr Leeway downwind_only(std::string_view kind, std::string_view summary,
                               FloatingObject object) noexcept {
  constexpr double root_12 = 3.4641016151377544;
  const LeewayFactor k = leeway_factor(object);
  return {kind, summary, {k.middle(), 0.0, (k.greatest - k.least) / root_12, 0.0}, {}, {}};
}

}  // namespace detail

/// The table.
inline constexpr std::array kLeewayTable = [] {
  constexpr auto line = detail::allen_line;
  return std::array{
      // clang-format off
      Leeway{"person_in_water", "person in water, state unknown", line(0.96, 0, 12.0), line(0.54, 0, 9.40), line(-0.54, 0, 9.40)},
      Leeway{"person_vertical", "person in water, vertical, life jacket, conscious", line(0.48, 0, 8.30), line(0.15, 0, 6.70), line(-0.15, 0, 6.70)},
      Leeway{"person_sitting", "person in water, sitting, life jacket", line(1.60, -3.98, 2.42), line(0.13, 0.33, 2.11), line(-0.13, -0.33, 2.11)},
      Leeway{"person_survival_suit", "person in a survival suit, face up", line(1.71, 1.12, 3.93), line(1.36, -3.30, 1.71), line(-0.13, -2.65, 1.62)},
      Leeway{"person_scuba", "person in a scuba suit, face up", line(0.63, 0, 5.30), line(0.31, 0, 4.50), line(-0.31, 0, 4.50)},
      Leeway{"person_deceased", "person in water, deceased, face down", line(1.117, 10.2, 3.04), line(0.04, 3.90, 4.05), line(-0.04, -3.90, 4.05)},
      Leeway{"liferaft", "life raft, deep ballast, load unknown", line(3.52, -2.50, 6.10), line(0.62, -3.00, 3.50), line(-0.45, -0.20, 3.60)},
      Leeway{"liferaft_light", "life raft for 4-14, deep ballast, canopy, no drogue, light", line(3.75, -2.32, 4.51), line(1.00, -5.31, 3.91), line(-0.47, -0.14, 3.91)},
      Leeway{"liferaft_drogue", "life raft for 4-14, deep ballast, canopy, drogue, heavy", line(2.19, -0.96, 1.01), line(1.39, -7.90, 1.46), line(-1.39, 7.90, 1.46)},
      Leeway{"liferaft_large", "life raft for 15-50, deep ballast, canopy", line(3.68, -4.96, 5.37), line(0.34, -1.85, 2.50), line(-0.49, 1.58, 2.63)},
      Leeway{"liferaft_capsized", "life raft, deep ballast, capsized", line(0.88, 0, 2.50), line(0.18, 0, 2.40), line(-0.18, 0, 2.40)},
      Leeway{"liferaft_shallow", "life raft, shallow ballast, canopy", line(2.68, 0, 12.0), line(1.10, 0, 9.40), line(-1.10, 0, 9.40)},
      Leeway{"liferaft_shallow_no_drogue", "life raft, shallow ballast, canopy, no drogue", line(2.96, 0, 1.50), line(1.21, 0, 1.70), line(-1.21, 0, 1.70)},
      Leeway{"liferaft_no_ballast", "life raft, no ballast", line(3.70, 0, 12.0), line(1.98, 0, 9.40), line(-1.98, 0, 9.40)},
      Leeway{"liferaft_no_canopy", "life raft, no ballast, no canopy, drogue", line(3.15, -4.47, 4.00), line(1.51, 0, 5.00), line(-1.51, 0, 5.00)},
      Leeway{"liferaft_aviation", "life raft for 4-6, no ballast, canopy, no drogue", line(3.39, 0, 2.40), line(1.49, 0, 2.40), line(-1.49, 0, 2.40)},
      Leeway{"life_capsule", "hard-shell life capsule, 22 persons", line(3.52, 0, 1.90), line(1.44, 0, 2.00), line(-1.44, 0, 2.00)},
      Leeway{"sea_kayak", "sea kayak, person on deck", line(1.16, 11.12, 4.12), line(0.41, 0, 4.39), line(-0.41, 0, 4.39)},
      Leeway{"surf_board", "surf board with person", line(1.93, 0, 8.30), line(0.51, 0, 6.70), line(-0.51, 0, 6.70)},
      Leeway{"windsurfer", "windsurfer, mast and sail in the water", line(2.25, 5.03, 2.50), line(0.69, -1.30, 2.96), line(-0.69, 1.30, 2.96)},
      Leeway{"skiff", "skiff, outboard runabout", line(3.15, 0, 2.20), line(1.29, 0, 2.20), line(-1.29, 0, 2.20)},
      Leeway{"skiff_v_hull", "skiff, V hull", line(2.87, 3.98, 3.33), line(0.32, -2.93, 2.53), line(-0.62, 1.03, 3.05)},
      Leeway{"skiff_swamped", "skiff, swamped or capsized", line(1.65, 0, 3.10), line(0.39, 0, 2.90), line(-0.39, 0, 2.90)},
      Leeway{"sport_boat", "sport boat, modified V hull", line(6.54, 0, 3.00), line(2.19, 0, 2.80), line(-2.19, 0, 2.80)},
      Leeway{"sport_fisher", "sport fisher, center console", line(5.55, 0, 3.30), line(2.27, 0, 3.00), line(-2.27, 0, 3.00)},
      Leeway{"fishing_vessel", "fishing vessel, general", line(2.47, 0, 12.0), line(2.76, 0, 9.40), line(-2.76, 0, 9.40)},
      Leeway{"gill_netter", "fishing vessel, gill-netter with rear reel", line(3.72, -0.87, 3.33), line(1.41, 2.00, 3.36), line(-1.41, -2.00, 3.36)},
      Leeway{"coastal_freighter", "coastal freighter", line(1.87, 0, 8.30), line(2.09, 0, 6.70), line(-2.09, 0, 6.70)},
      Leeway{"sailing_yacht", "sailing yacht, monohull", line(4.50, 0, 19.40), line(4.95, 0, 18.42), line(-2.82, 0, 24.95)},
      Leeway{"sailing_yacht_fin_keel", "sailing yacht, fin keel, shallow draft", line(2.67, 0, 8.30), line(2.98, 0, 6.70), line(-2.98, 0, 6.70)},
      Leeway{"debris", "debris of a fishing vessel", line(1.97, 0, 8.30), line(0.36, 0, 6.70), line(-0.36, 0, 6.70)},
      Leeway{"oil_drum", "oil drum, 220 l", line(0.75, 2.66, 2.83), line(0.48, 2.88, 3.92), line(-0.45, -1.46, 4.59)},
      Leeway{"container", "container, 20 ft, 80 % submerged", line(1.25, 3.96, 2.81), line(0.19, 1.14, 4.36), line(-0.19, -1.14, 4.36)},
      Leeway{"mine", "moored mine broken loose", line(1.07, 4.47, 6.55), line(0.41, 1.15, 4.13), line(-0.41, -1.15, 4.13)},
      Leeway{"datum_buoy", "drifting datum marker buoy, no windage", {}, {}, {}},
      // clang-format on
      detail::downwind_only("buoy", "buoy or floating mine, 1.2-1.5 % of the wind",
                            FloatingObject::kBuoy),
      detail::downwind_only("dinghy", "dinghy, 3.2-4.5 % of the wind", FloatingObject::kDinghy),
      detail::downwind_only("launch", "rescue launch, 6.5 % of the wind", FloatingObject::kLaunch),
      detail::downwind_only("ship", "ship, 5.6-6.2 % of the wind", FloatingObject::kShip),
  };
}();

/// The entry of a kind, null if there is none.
constexpr const Leeway* find_leeway(std::string_view kind) noexcept {
  for (const Leeway& entry : kLeewayTable)
    if (entry.kind == kind) return &entry;
  return nullptr;
}

}  // namespace wakeline
