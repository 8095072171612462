// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "wakeline/core/archive.hpp"
#include "wakeline/track/beam.hpp"
#include "wakeline/track/identities.hpp"
#include "wakeline/track/partial_scan.hpp"
#include "wakeline/track/radar.hpp"
#include "wakeline/track/track.hpp"

namespace wakeline {

/// A sector, or a whole turn. Its plots are kept beside it.
struct SectorInput {
  static constexpr bool kIsAction = false, kIsScan = true;

  int radar = 0;
  double from_rad = 0.0;
  double to_rad = Beam::kTurn;
  double time_s = 0.0;
  std::optional<OwnShip> own = {};

  /// NaN where the radar is not known.
  [[nodiscard]] double true_time_s(const auto& tracker) const noexcept {
    return tracker.has_radar(radar) ? tracker.radar(radar).true_time_s(time_s)
                                    : std::numeric_limits<double>::quiet_NaN();
  }
  auto give_to(auto& tracker, std::span<const Plot> plots) const noexcept {
    return tracker.sector({radar, from_rad, to_rad, time_s, plots, own});
  }
  /// About what it costs a tracker, in plots.
  [[nodiscard]] std::int64_t work(std::size_t plots, int tracks) const noexcept {
    const double turns = Beam::width_rad(from_rad, to_rad) / Beam::kTurn;
    return 10 + static_cast<std::int64_t>(plots) + std::int64_t((turns + 1.0 / 64.0) * tracks);
  }
  [[nodiscard]] auto order() const noexcept { return std::tuple(radar, from_rad, to_rad); }

  void archive(Archive& fields) {
    fields(radar);
    fields(from_rad);
    fields(to_rad);
    fields(time_s);
    bool is_given = own.has_value();
    fields(is_given);
    OwnShip ship = own.value_or(OwnShip{});
    fields(ship);
    own = is_given ? std::optional(ship) : std::nullopt;
  }
};

/// `Tracker::report`, with copies of its texts.
struct ReportInput {
  static constexpr bool kIsAction = false, kIsScan = false;

  ReportInput() = default;
  explicit ReportInput(const PositionReport& report) noexcept
      : time_s(report.time_s), number{report.position_m[0],   report.position_m[1],
                                      report.position_std_m,  report.velocity_mps[0],
                                      report.velocity_mps[1], report.velocity_std_mps} {
    std::copy_n(report.source.begin(), std::min(report.source.size(), source.size() - 1),
                source.begin());
    std::copy_n(report.identity.begin(), std::min(report.identity.size(), identity.size() - 1),
                identity.begin());
  }

  std::array<char, PositionReport::kMostSource + 1> source = {};
  std::array<char, PositionReport::kMostIdentity + 1> identity = {};
  double time_s = 0.0;
  std::array<double, 6> number = {};  ///< position, its standard deviation, velocity and its own

  [[nodiscard]] double true_time_s(const auto&) const noexcept { return time_s; }
  auto give_to(auto& tracker, std::span<const Plot>) const noexcept {
    return tracker.report({source.data(),
                           identity.data(),
                           time_s,
                           {number[0], number[1]},
                           number[2],
                           {number[3], number[4]},
                           number[5]});
  }
  [[nodiscard]] static std::int64_t work(std::size_t, int tracks) noexcept {
    return 10 + tracks / 64;
  }
  [[nodiscard]] auto order() const noexcept {
    return std::tuple(std::string_view(source.data()), std::string_view(identity.data()), number[0],
                      number[1]);
  }
  void archive(Archive& fields) {
    fields(source);
    fields(identity);
    fields(time_s);
    fields(number);
    source.back() = identity.back() = '\0';
  }
};

/// `Tracker::partial`. Its values are kept beside it, as ranges of plots.
struct PartialInput {
  static constexpr bool kIsAction = false, kIsScan = false;
  static constexpr std::size_t kMostValues = 256;

  PositionPart part = PositionPart::kBearing;
  int sensor = 0;
  double time_s = 0.0, std = 1.0, false_per_unit = 1.0;
  OwnShip own = {};

  [[nodiscard]] double true_time_s(const auto&) const noexcept { return time_s; }
  auto give_to(auto& tracker, std::span<const Plot> plots) const noexcept {
    std::array<double, kMostValues> values;
    const std::size_t count = std::min(plots.size(), values.size());
    for (std::size_t k = 0; k < count; ++k) values[k] = plots[k].range_m;
    return tracker.partial(
        {part, sensor, time_s, std::span(values.data(), count), std, false_per_unit, own});
  }
  [[nodiscard]] static std::int64_t work(std::size_t plots, int tracks) noexcept {
    return 10 + static_cast<std::int64_t>(plots) * (1 + tracks / 8);
  }
  [[nodiscard]] auto order() const noexcept {
    return std::tuple(int(part), sensor, std, own.north_m, own.east_m);
  }
  void archive(Archive& fields) {
    fields(part);
    fields(sensor);
    fields(time_s);
    fields(std);
    fields(false_per_unit);
    fields(own);
  }
};

/// What an operator does.
struct OperatorAction {
  static constexpr bool kIsAction = true;
  [[nodiscard]] static std::int64_t work(std::size_t, int) noexcept { return 10; }
};

/// `Tracker::set_radar`, of settings that are valid.
struct RadarChange : OperatorAction {
  int number = 0;
  Radar radar = {};

  bool give_to(auto& tracker, std::span<const Plot>) const noexcept {
    if (tracker.has_radar(number)) tracker.set_radar(number, radar);
    return tracker.has_radar(number);
  }
  void archive(Archive& fields) {
    fields(number);
    for_each_field(radar, [&](const auto&, auto& value) { fields(value); });
  }
};

/// `Tracker::designate`.
struct Designation : OperatorAction {
  double time_s = 0.0, north_m = 0.0, east_m = 0.0, position_std_m = 0.0;
  std::optional<Gaussian<2>> velocity = {};

  std::int64_t give_to(auto& tracker, std::span<const Plot>) const noexcept {
    return tracker.designate(time_s, north_m, east_m, position_std_m, velocity);
  }
  void archive(Archive& fields) {
    for (double* each : {&time_s, &north_m, &east_m, &position_std_m}) fields(*each);
    bool is_given = velocity.has_value();
    fields(is_given);
    Gaussian<2> belief = velocity.value_or(Gaussian<2>{});
    fields(belief.mean);
    fields(belief.covariance);
    velocity = is_given ? std::optional(belief) : std::nullopt;
  }
};

/// `Tracker::merge`.
struct Merger : OperatorAction {
  std::int64_t id = 0, other_id = 0;

  bool give_to(auto& tracker, std::span<const Plot>) const noexcept {
    return tracker.merge(id, other_id);
  }
  void archive(Archive& fields) {
    fields(id);
    fields(other_id);
  }
};

/// `Tracker::drop`.
struct Removal : OperatorAction {
  std::int64_t id = 0;
  bool hush = false;

  bool give_to(auto& tracker, std::span<const Plot>) const noexcept {
    return tracker.drop(id, hush);
  }
  void archive(Archive& fields) {
    fields(id);
    fields(hush);
  }
};

/// `Tracker::rename`.
struct Naming : OperatorAction {
  std::int64_t id = 0;
  std::size_t length = 0;
  decltype(Track::name) name = {};

  bool give_to(auto& tracker, std::span<const Plot>) const noexcept {
    return tracker.rename(id, {name.data(), length});
  }
  void archive(Archive& fields) {
    fields(id);
    fields(length);
    fields(name);
    if (length > name.size()) fields.fail();
  }
};

/// Any input of a tracker; of one time in this order.
using TrackerInput = std::variant<SectorInput, ReportInput, PartialInput, RadarChange, Designation,
                                  Merger, Removal, Naming>;

/// The inputs of a tracker in the order in which they take place, whatever the order in which they
/// came.
///
/// They are ordered by time. Of one time, what sensors report is before what an operator does;
/// reports are ordered by their kind, then by their contents (a sector by radar, angles and plots),
/// actions as they came. Memory is taken by the constructor.
class InputLog {
 public:
  /// An input, when it came, what it costs and where its plots are.
  struct Entry {
    double time_s;
    std::int64_t arrival;  ///< counts all that came
    std::int64_t work;     ///< about what it costs a tracker
    TrackerInput input;
    std::size_t first_plot = 0;
    std::size_t plots = 0;
  };

  InputLog(int max_inputs, int max_plots)
      : max_inputs_(static_cast<std::size_t>(max_inputs)),
        max_plots_(static_cast<std::size_t>(max_plots)) {
    // Written once, so that a process has all memory from the start and not when it is first used.
    entries_.resize(max_inputs_, Entry{});
    entries_.clear();
    for (std::vector<Plot>* plots : {&plots_, &spare_}) {
      plots->resize(2 * max_plots_);
      plots->clear();
    }
  }

  [[nodiscard]] std::size_t size() const noexcept { return entries_.size(); }
  [[nodiscard]] const Entry& operator[](std::size_t place) const noexcept {
    return entries_[place];
  }
  [[nodiscard]] std::span<const Plot> plots_of(const Entry& entry) const noexcept {
    return std::span(plots_).subspan(entry.first_plot, entry.plots);
  }

  /// Whether there is room for one more input with so many plots.
  [[nodiscard]] bool has_room_for(std::size_t plots) const noexcept {
    return entries_.size() < max_inputs_ && plots <= max_plots_ - used_plots_;
  }

  /// Puts an input with its plots in its place, which is returned. There must be room.
  std::size_t insert(Entry entry, std::span<const Plot> plots) noexcept {
    if (plots_.size() + plots.size() > plots_.capacity()) close_gaps();
    entry.first_plot = plots_.size();
    entry.plots = plots.size();
    used_plots_ += plots.size();
    plots_.insert(plots_.end(), plots.begin(), plots.end());
    const auto place =
        std::upper_bound(entries_.begin(), entries_.end(), entry,
                         [this](const Entry& a, const Entry& b) { return is_before(a, b); });
    return static_cast<std::size_t>(std::distance(entries_.begin(), entries_.insert(place, entry)));
  }

  /// Drops the first inputs.
  void drop(std::size_t count) noexcept {
    const auto end = entries_.begin() + static_cast<std::ptrdiff_t>(count);
    for (auto entry = entries_.begin(); entry != end; ++entry) used_plots_ -= entry->plots;
    entries_.erase(entries_.begin(), end);
    if (used_plots_ == 0) plots_.clear();
  }

  /// Has the last inputs that are after a time take place at another one, not before those ahead of
  /// them: an action for a time that is too far ahead takes place now.
  void bring_forward(double after_s, double time_s) noexcept {
    for (auto entry = entries_.rbegin(); entry != entries_.rend() && entry->time_s > after_s;
         ++entry)
      entry->time_s = time_s;
  }

  /// Saves or restores the inputs.
  void archive(Archive& fields) {
    auto count = static_cast<std::uint64_t>(entries_.size());
    fields(count);
    if (count > max_inputs_) fields.fail();
    if (!fields.ok()) return;
    if (fields.loading()) {
      drop(entries_.size());
      entries_.resize(static_cast<std::size_t>(count), Entry{});
    }
    for (Entry& entry : entries_) {
      fields(entry.time_s);
      fields(entry.arrival);
      fields(entry.work);
      archive_input(fields, entry.input);
      archive_plots(fields, entry);
      if (!fields.ok()) return;
    }
  }

 private:
  [[nodiscard]] bool is_before(const Entry& a, const Entry& b) const noexcept {
    if (a.time_s != b.time_s) return a.time_s < b.time_s;
    const bool acts = is_action(a.input);
    if (acts != is_action(b.input)) return !acts;
    if (!acts)
      if (const std::strong_ordering order = compare_reports(a, b); order != 0) return order < 0;
    return a.arrival < b.arrival;
  }

  static bool is_action(const TrackerInput& input) noexcept {
    return std::visit([](const auto& each) { return each.kIsAction; }, input);
  }

  [[nodiscard]] std::strong_ordering compare_reports(const Entry& a,
                                                     const Entry& b) const noexcept {
    if (a.input.index() != b.input.index()) return a.input.index() <=> b.input.index();
    const std::strong_ordering order = std::visit(
        [&](const auto& left) {
          using Input = std::decay_t<decltype(left)>;
          if constexpr (Input::kIsAction)
            return std::strong_ordering::equal;
          else
            return compare(left.order(), std::get<Input>(b.input).order());
        },
        a.input);
    if (order != 0) return order;
    const std::span<const Plot> left = plots_of(a), right = plots_of(b);
    return std::lexicographical_compare_three_way(
        left.begin(), left.end(), right.begin(), right.end(), [](const Plot& x, const Plot& y) {
          return compare(std::tuple(x.time_s, x.range_m, x.bearing_rad),
                         std::tuple(y.time_s, y.range_m, y.bearing_rad));
        });
  }

  /// NaN has a place, too.
  template <class... Values>
  static std::strong_ordering compare(const std::tuple<Values...>& a,
                                      const std::tuple<Values...>& b) noexcept {
    auto result = std::strong_ordering::equal;
    const auto decide = [&](const auto& x, const auto& y) {
      if (result == 0) result = std::strong_order(x, y);
    };
    [&]<std::size_t... K>(std::index_sequence<K...>) {
      (decide(std::get<K>(a), std::get<K>(b)), ...);
    }
    (std::index_sequence_for<Values...>());
    return result;
  }

  /// Makes the plots those of the entries alone.
  void close_gaps() noexcept {
    spare_.clear();
    for (Entry& entry : entries_) {
      const std::span<const Plot> plots = plots_of(entry);
      entry.first_plot = spare_.size();
      spare_.insert(spare_.end(), plots.begin(), plots.end());
    }
    std::swap(plots_, spare_);
  }

  static void archive_input(Archive& fields, TrackerInput& input) {
    auto kind = static_cast<std::uint64_t>(input.index());
    fields(kind);
    [&]<std::size_t... K>(std::index_sequence<K...>) {
      const bool known = ((kind == K && (fields.loading() ? (void)input.emplace<K>() : void(),
                                         std::get<K>(input).archive(fields), true)) ||
                          ...);
      if (!known) fields.fail();
    }
    (std::make_index_sequence<std::variant_size_v<TrackerInput>>());
  }

  void archive_plots(Archive& fields, Entry& entry) {
    auto count = static_cast<std::uint64_t>(entry.plots);
    fields(count);
    if (count > max_plots_ - (fields.loading() ? used_plots_ : 0)) fields.fail();
    if (!fields.ok()) return;
    if (fields.loading()) {
      entry.first_plot = plots_.size();
      entry.plots = static_cast<std::size_t>(count);
      used_plots_ += entry.plots;
      plots_.resize(used_plots_);
    }
    for (Plot& plot : std::span(plots_).subspan(entry.first_plot, entry.plots)) {
      fields(plot.time_s);
      fields(plot.range_m);
      fields(plot.bearing_rad);
      fields(plot.own);
      fields(plot.covariance);
    }
  }

  std::size_t max_inputs_;
  std::size_t max_plots_;
  std::vector<Entry> entries_;
  std::vector<Plot> plots_;  ///< of the entries, with gaps
  std::vector<Plot> spare_;
  std::size_t used_plots_ = 0;
};

}  // namespace wakeline
