// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "wakeline/core/archive.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline {

namespace detail {

/// exp(-dt / memory), remembered for steps that many plots of a scan have in common.
class Fading {
 public:
  explicit Fading(double memory_s) : memory_s_(memory_s) {}

  double after(double dt_s) noexcept {
    Step& step = steps_[std::bit_cast<std::uint64_t>(dt_s) * 0x9E3779B97F4A7C15u >> 56];
    if (step.dt_s != dt_s) step = {dt_s, std::exp(-dt_s / memory_s_)};
    return step.factor;
  }

 private:
  struct Step {
    double dt_s = std::numeric_limits<double>::quiet_NaN();
    double factor = 0.0;
  };

  double memory_s_;
  std::array<Step, 256> steps_;
};

}  // namespace detail

/// What a map has learned from the plots of one target, as if all were where the last one was.
struct LearnedPlots {
  Vec<double, 2> position = Vec<double, 2>::Zero();
  double plots = 0.0;  ///< as many as were left of them at `time_s`
  double time_s = 0.0;

  void archive(Archive& fields) {
    fields(position);
    fields(plots);
    fields(time_s);
  }
};

/// What a target's own plots have added to the density of clutter.
struct OwnPlots {
  LearnedPlots of_map;
  LearnedPlots of_patches;

  void archive(Archive& fields) {
    of_map.archive(fields);
    of_patches.archive(fields);
  }
};

/// The density of false plots over the plane, learned with a fading memory. Fixed echoes and shore
/// grow dense and thus stop looking like targets.
///
/// A grid of cells, bilinear between their centres, in tiles of four, which share a line of the
/// cache. The table of tiles has a fixed size; of two with the same place in it the weaker is
/// forgotten.
class ClutterMap {
 public:
  static constexpr std::size_t kMostTiles = 1 << 13;

  /// `cell_m` 0 switches the map off. It has room for so many tiles, a power of two.
  ClutterMap(double cell_m, double memory_s, std::size_t tiles = kMostTiles)
      : cell_m_(cell_m), memory_s_(memory_s), fading_(memory_s) {
    if (enabled()) tiles_.resize(std::min(tiles, kMostTiles));
  }

  [[nodiscard]] bool enabled() const noexcept { return cell_m_ > 0.0; }
  [[nodiscard]] double cell_m() const noexcept { return cell_m_; }

  /// A time, or a later one at which no plot that was learned counts for much more than when it
  /// came.
  [[nodiscard]] double no_sooner_s(double time_s) const noexcept {
    return std::max(time_s, latest_s_ - 0.1 * memory_s_);
  }

  /// False plots per m² and scan about a position, for scans `period_s` apart, of which the last
  /// was at `time_s`.
  [[nodiscard]] double density(const Vec<double, 2>& position, double time_s,
                               double period_s) const noexcept {
    if (!enabled()) return 0.0;
    double plots = 0.0;
    for (const Corner& corner : corners(position)) plots += corner.share * plots_in(corner);
    return per_m2_and_scan(plots > 0.0 ? plots * faded_at(time_s) : 0.0, period_s);
  }

  /// The part of that density that these plots are.
  [[nodiscard]] double density_of(const LearnedPlots& learned, const Vec<double, 2>& position,
                                  double time_s, double period_s) const noexcept {
    if (!enabled() || learned.plots == 0.0) return 0.0;
    const double shares = shared(cells_along(position[0]), cells_along(learned.position[0])) *
                          shared(cells_along(position[1]), cells_along(learned.position[1]));
    return per_m2_and_scan(shares * faded(learned, time_s), period_s);
  }

  /// The plots, as many as are left at `time_s`, in the four cells about a position.
  [[nodiscard]] std::array<double, 4> plots_about(const Vec<double, 2>& position,
                                                  double time_s) const noexcept {
    std::array<double, 4> plots{};
    if (!enabled()) return plots;
    const double left = faded_at(time_s);
    const std::array<Corner, 4> corner = corners(position);
    for (std::size_t k = 0; k < corner.size(); ++k) plots[k] = plots_in(corner[k]) * left;
    return plots;
  }

  /// As many of them as these plots are.
  [[nodiscard]] std::array<double, 4> plots_about(const LearnedPlots& learned,
                                                  const Vec<double, 2>& position,
                                                  double time_s) const noexcept {
    std::array<double, 4> plots{};
    const double left = enabled() ? faded(learned, time_s) : 0.0;
    if (left == 0.0) return plots;
    const auto share = [](double along, std::int32_t cell) {
      return std::max(1.0 - std::abs(along - cell), 0.0);
    };
    const double north = cells_along(learned.position[0]), east = cells_along(learned.position[1]);
    const std::array<Corner, 4> corner = corners(position);
    for (std::size_t k = 0; k < corner.size(); ++k)
      plots[k] = left * share(north, corner[k].north) * share(east, corner[k].east);
    return plots;
  }

  /// Adds a plot that `add` learns to those of its target.
  void remember(const Vec<double, 2>& position, double time_s, double weight,
                LearnedPlots& learned) const noexcept {
    learned = {position, faded(learned, time_s) + weight, time_s};
  }

  /// Learns a plot that is false with probability `weight`.
  void add(const Vec<double, 2>& position, double time_s, double weight) noexcept {
    if (!enabled()) return;
    if (std::abs(time_s - epoch_s_) > kEpochs * memory_s_) begin_epoch(time_s);
    latest_s_ = std::max(latest_s_, time_s);
    const double of_epoch = weight / faded_at(time_s);
    for (const Corner& corner : corners(position)) {
      Tile& tile = tiles_[place(corner)];
      const auto added = static_cast<float>(of_epoch * corner.share);
      if (!tile.has(corner)) {
        if (*std::max_element(tile.plots.begin(), tile.plots.end()) > added) continue;
        tile = {{}, corner.north >> 1, corner.east >> 1};
      }
      tile.plots[cell_of(corner)] += added;
    }
  }

  /// Saves or restores what has been learned.
  void archive(Archive& fields) {
    const std::size_t size = tiles_.size();
    fields(tiles_, size);
    fields(epoch_s_);
    fields(latest_s_);
    if (tiles_.size() == size) return;
    tiles_.resize(size);
    fields.fail();
  }

 private:
  static constexpr double kEpochs = 50.0;  ///< memories after which a new epoch begins

  struct Corner {
    std::int32_t north;
    std::int32_t east;
    double share;
  };
  /// Two cells by two.
  struct alignas(32) Tile {
    std::array<float, 4> plots = {};  ///< as many as would fade from the epoch on to what is left
    std::int32_t north = 0;
    std::int32_t east = 0;
    std::array<std::int32_t, 2> unused = {};  ///< no padding, as archives hold all bytes

    [[nodiscard]] bool has(const Corner& corner) const noexcept {
      return north == corner.north >> 1 && east == corner.east >> 1;
    }
  };

  static std::size_t cell_of(const Corner& corner) noexcept {
    return static_cast<std::size_t>(2 * (corner.north & 1) + (corner.east & 1));
  }

  /// As many as would fade from the epoch on to what is left of them.
  [[nodiscard]] double plots_in(const Corner& corner) const noexcept {
    const Tile& tile = tiles_[place(corner)];
    return tile.has(corner) ? static_cast<double>(tile.plots[cell_of(corner)]) : 0.0;
  }

  /// What is left of the plots of a target.
  [[nodiscard]] double faded(const LearnedPlots& learned, double time_s) const noexcept {
    return learned.plots > 0.0 ? learned.plots * fading_.after(time_s - learned.time_s) : 0.0;
  }

  /// What is left of a plot of the epoch.
  [[nodiscard]] double faded_at(double time_s) const noexcept {
    return fading_.after(time_s - epoch_s_);
  }

  /// Counts the plots of all cells as of another epoch.
  void begin_epoch(double time_s) noexcept {
    const double factor = time_s > epoch_s_ ? faded_at(time_s) : 0.0;
    for (Tile& tile : tiles_)
      for (float& plots : tile.plots) plots *= static_cast<float>(factor);
    epoch_s_ = latest_s_ = time_s;
  }

  /// The density that faded plots in one cell mean.
  [[nodiscard]] double per_m2_and_scan(double plots, double period_s) const noexcept {
    const double per_scan = 1.0 - fading_.after(period_s);
    return plots * per_scan / (cell_m_ * cell_m_);
  }

  /// Along one axis, from the centre of the cell at the origin, in cells.
  [[nodiscard]] double cells_along(double m) const noexcept {
    constexpr double kEdge = 1e9;  // cells beyond this index are one, and so is NaN
    return std::min(std::max(-kEdge, m / cell_m_ - 0.5), kEdge);
  }

  /// The cell below such a number, which fits: a call of `std::floor` costs more.
  static std::int32_t cell_below(double cells) noexcept {
    const auto cell = static_cast<std::int32_t>(cells);
    return cell - (static_cast<double>(cell) > cells ? 1 : 0);
  }

  /// Sum over the cells of the shares that two places along one axis have in each, multiplied.
  static double shared(double u, double v) noexcept {
    const std::int32_t i = cell_below(u), j = cell_below(v);
    const double a = u - i, b = v - j;
    return i == j       ? (1 - a) * (1 - b) + a * b
           : i + 1 == j ? a * (1 - b)
           : j + 1 == i ? (1 - a) * b
                        : 0.0;
  }

  /// The four cells whose centres surround a position, with their bilinear shares.
  [[nodiscard]] std::array<Corner, 4> corners(const Vec<double, 2>& position) const noexcept {
    const double u = cells_along(position[0]);
    const double v = cells_along(position[1]);
    const std::int32_t i = cell_below(u), j = cell_below(v);
    const double a = u - i;
    const double b = v - j;
    return {{{i, j, (1 - a) * (1 - b)},
             {i, j + 1, (1 - a) * b},
             {i + 1, j, a * (1 - b)},
             {i + 1, j + 1, a * b}}};
  }

  [[nodiscard]] std::size_t place(const Corner& corner) const noexcept {
    const auto spread = [](std::int32_t cell, std::uint64_t factor) {
      return factor * static_cast<std::uint32_t>(cell >> 1);
    };
    const std::uint64_t hash =
        spread(corner.north, 0x9E3779B97F4A7C15u) ^ spread(corner.east, 0xC2B2AE3D27D4EB4Fu);
    return static_cast<std::size_t>(hash >> 50) & (tiles_.size() - 1);
  }

  double cell_m_;
  double memory_s_;
  double epoch_s_ = 0.0;
  double latest_s_ = -std::numeric_limits<double>::infinity();  ///< of the plots learned
  mutable detail::Fading fading_;  // what it remembers it would find again
  std::vector<Tile> tiles_;
};

}  // namespace wakeline
