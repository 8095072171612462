// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "wakeline/track/plane_index.hpp"

namespace wakeline {

/// Positions with variances, found by where they are.
///
/// How far a search has to reach depends on the errors of what is searched for. Positions with
/// about the same errors make a layer, so that a plot at the horizon, which may be kilometres off,
/// does not widen the search for those near the antenna. Memory is taken by the constructor.
class PlaceIndex {
 public:
  explicit PlaceIndex(int capacity) {
    layers_.reserve(kLayers);
    for (int k = 0; k < kLayers; ++k) layers_.push_back({PlaneIndex(capacity)});
  }

  void clear() noexcept {
    for (Layer& layer : layers_) {
      layer.places.clear();
      layer.largest_m2 = 0.0;
    }
  }

  /// Adds a place, [north, east] m, which must be finite, with a variance; it is found
  /// as `name`.
  void add(const Vec<double, 2>& position, double variance_m2, int name) noexcept {
    Layer& layer = layers_[static_cast<std::size_t>(layer_of(variance_m2))];
    layer.places.add(position, name);
    layer.largest_m2 = std::max(layer.largest_m2, variance_m2);
  }

  /// Sorts the places; to be called when all are there.
  void sort() noexcept {
    for (Layer& layer : layers_) layer.places.sort();
  }

  /// Calls `f(name)` for the places in a square about a position, layer by layer, at most so many
  /// of a layer, about the nearest: `reach_m(variance)` is its half side for places of at most that
  /// variance. Where all is crowded on one spot, a search takes no longer than elsewhere.
  template <class Reach, class Function>
  void for_each_nearest(const Vec<double, 2>& position, const Reach& reach_m, int most,
                        Function&& function) const {
    for (const Layer& layer : layers_)
      if (!layer.places.empty())
        layer.places.for_each_nearest(position, reach_m(layer.largest_m2), most, function);
  }

  /// The same for the elements of a vector by these names, which need not be in the cache: they are
  /// all called for before the first one is used.
  template <int kMost, class Element, class Reach, class Function>
  void for_each_nearest_of(const std::vector<Element>& elements, const Vec<double, 2>& position,
                           const Reach& reach_m, Function&& function) const {
    constexpr std::size_t kLine = 64;  // bytes of the cache
    std::array<int, std::size_t{kLayers} * kMost> found;
    std::size_t count = 0;
    for_each_nearest(position, reach_m, kMost, [&](int name) {
      found[count++] = name;
      const auto* element =
          reinterpret_cast<const std::byte*>(&elements[static_cast<std::size_t>(name)]);
      for (std::size_t k = 0; k < sizeof(Element); k += kLine) __builtin_prefetch(element + k);
    });
    for (std::size_t k = 0; k < count; ++k) function(found[k]);
  }

 private:
  /// Standard deviations below 32, 128, 512 m, 2 km, and any.
  static constexpr int kLayers = 5;

  static int layer_of(double variance_m2) noexcept {
    if (!(variance_m2 < 0x1p22)) return kLayers - 1;
    return variance_m2 < 0x1p10 ? 0 : (std::ilogb(variance_m2) - 6) / 4;
  }

  struct Layer {
    PlaneIndex places;
    double largest_m2 = 0.0;
  };
  std::vector<Layer> layers_;
};

}  // namespace wakeline
