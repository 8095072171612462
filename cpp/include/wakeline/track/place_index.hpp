// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "wakeline/simd/prefetch.hpp"
#include "wakeline/track/plane_index.hpp"
#include "wakeline/track/plane_slices.hpp"

namespace wakeline {

/// Positions with variances, found by where they are.
///
/// How far a search has to reach depends on the errors of what is searched for. Positions with
/// about the same errors make a layer, so that a plot at the horizon, which may be kilometres off,
/// does not widen the search for those near the antenna. Memory is taken by the constructor.
class PlaceIndex {
 public:
  explicit PlaceIndex(int capacity) {
    places_.reserve(static_cast<std::size_t>(capacity));
    slices_.reserve(int{kFew});
    for (PlaneIndex& layer : layers_) layer.reserve(capacity);
    clear();
  }

  void clear() noexcept {
    places_.clear();
    largest_m2_.fill(kNone);
  }

  /// Adds a place, [north, east] m, which must be finite, with a variance; it is found
  /// as `name`.
  void add(const Vec<double, 2>& position, double variance_m2, int name) noexcept {
    const int layer = layer_of(variance_m2);
    places_.push_back({position, name, layer});
    double& largest_m2 = largest_m2_[static_cast<std::size_t>(layer)];
    largest_m2 = std::max(largest_m2, variance_m2);
  }

  /// Sorts the places; to be called when all are there.
  void sort() noexcept {
    for (PlaneIndex& layer : layers_) layer.clear();
    if (is_few()) return slices_.lay_out(places_);
    slices_.clear();
    for (const Place& place : places_)
      layers_[static_cast<std::size_t>(place.layer)].add(place.position, place.name);
    for (PlaneIndex& layer : layers_) layer.sort();
  }

  /// Calls `f(name)` for the places in a square about a position, at most so many of a layer or, of
  /// few places, of all layers, about the nearest: `reach_m(variance)` is its half side for places
  /// of at most that variance.
  template <class Reach, class Function>
  void for_each_nearest(const Vec<double, 2>& position, const Reach& reach_m, int most,
                        Function&& function) const {
    std::array<double, kLayers> reach_of;
    for (std::size_t k = 0; k < kLayers; ++k)
      reach_of[k] = largest_m2_[k] > kNone ? reach_m(largest_m2_[k]) : -1.0;
    if (is_few()) return slices_.for_each_nearest(position, reach_of, most, function);
    for (std::size_t k = 0; k < kLayers; ++k)
      if (largest_m2_[k] > kNone)
        layers_[k].for_each_nearest(position, reach_of[k], most, function);
  }

  /// The same for the elements of a vector by these names, which need not be in the cache: they are
  /// all called for before the first one is used.
  template <int kMost, class Element, class Reach, class Function>
  void for_each_nearest_of(const std::vector<Element>& elements, const Vec<double, 2>& position,
                           const Reach& reach_m, Function&& function) const {
    static_assert(kMost <= PlaneSlices::kMostNear);
    std::array<int, kLayers * kMost> found;
    std::size_t count = 0;
    for_each_nearest(position, reach_m, kMost, [&](int name) {
      found[count++] = name;
      prefetch(elements[static_cast<std::size_t>(name)]);
    });
    for (std::size_t k = 0; k < count; ++k) function(found[k]);
  }

 private:
  /// Standard deviations below 32, 128, 512 m, 2 km, and any.
  static constexpr std::size_t kLayers = 5;
  static constexpr double kNone = -1.0;
  static constexpr std::size_t kFew = 256;

  static int layer_of(double variance_m2) noexcept {
    if (!(variance_m2 < 0x1p22)) return int{kLayers} - 1;
    return variance_m2 < 0x1p10 ? 0 : (std::ilogb(variance_m2) - 6) / 4;
  }

  /// Whether one pass through all layers looks at few, as of a sector.
  [[nodiscard]] bool is_few() const noexcept { return places_.size() <= kFew; }

  std::vector<Place> places_;
  PlaneSlices slices_;  ///< of few places, of all layers
  std::array<PlaneIndex, kLayers> layers_;
  std::array<double, kLayers> largest_m2_{};  ///< largest variance of a layer, or `kNone`
};

}  // namespace wakeline
