// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "wakeline/core/fields.hpp"
#include "wakeline/core/utf8.hpp"
#include "wakeline/track/input_log.hpp"
#include "wakeline/track/tracker.hpp"

namespace wakeline {

/// How late the inputs of a tracker may come, and the memory for them.
struct LateWindowConfig {
  double window_s = 0.0;
  int max_inputs = 4000;
  int max_plots = 50'000;

  static constexpr auto fields() noexcept {
    using C = LateWindowConfig;
    return field_table(
        field("window_s", &C::window_s, kTimeOrZero, "s",
              "What is at most so much older than the newest report is put in its place; 0: two "
              "turns of the slowest radar."),
        field("max_inputs", &C::max_inputs, between(16, 1'000'000), "inputs",
              "Room for inputs; with more in a window the window is shorter."),
        field("max_plots", &C::max_plots, between(1, 10'000'000), "plots",
              "Room for their plots, at least `max_plots` of the tracker; with more in a window "
              "the window is shorter."));
  }

  friend bool operator==(const LateWindowConfig&, const LateWindowConfig&) = default;

  void validate() const { validate_fields(*this); }
};

/// How many inputs came late.
struct LateCounts {
  std::int64_t late = 0;         ///< before an input that had come already, and put in their place
  std::int64_t too_late = 0;     ///< before the window: lost
  std::int64_t corrections = 0;  ///< of the picture
};

/// A tracker whose inputs may come late: the tracks are, bit for bit, as if all inputs had come in
/// the order of `InputLog`.
///
/// The calls are those of a tracker. An input in time is processed at once. For a late one the
/// tracker goes back to a snapshot of the time before and processes again what came since. This
/// takes place as soon as the work that came in pays for it, so that all corrections together cost
/// at most `kReplays` times what processing in order does, also with a sensor that is always late;
/// until then `tracker()` is the picture without some late data. `correct()` corrects it at any
/// time. A number that a track got within the window may become that of another one by a
/// correction; older ones stay. Actions of an operator are by the numbers that there are when they
/// take place. All memory is taken by the constructor; nothing else allocates or throws but `save`
/// and `restore`. To be used from one thread at a time.
template <class TrackerType>
class LateWindow {
 public:
  /// With the arguments of the tracker. Throws `std::invalid_argument` on a setting that makes no
  /// sense.
  template <class... Arguments>
  explicit LateWindow(const LateWindowConfig& config, const Arguments&... arguments)
      : config_(validated(config)), tracker_(arguments...), log_(config.max_inputs, most_plots()) {
    for (int k = 0; config.window_s == 0.0 && k < tracker_.radar_numbers(); ++k)
      config_.window_s = std::max(config_.window_s, 2.0 * tracker_.radar(k).period_s);
    snapshots_.reserve(kSnapshots);
    for (std::size_t k = 0; k < kSnapshots; ++k) {
      snapshots_.push_back({TrackerType(arguments...)});
      held_[k] = k;
    }
    const auto tracks = static_cast<std::size_t>(tracker_.config().max_tracks);
    const auto plots = static_cast<std::size_t>(tracker_.config().max_plots);
    for (std::vector<Number>* numbers : {&before_, &after_}) numbers->reserve(tracks);
    plot_track_id_.reserve(plots);
    events_.reserve(6 * tracks + plots + 1);
  }

  /// `Tracker::process`. A scan before the window is rejected with `kNegativeTimeStep`.
  ScanReport process(double time_s, std::span<const Plot> plots) noexcept {
    return receive(SectorInput{.time_s = time_s}, plots);
  }

  /// `Tracker::sector`, of any time in the window. A sector before it is rejected with
  /// `kNegativeTimeStep`. The report of a late one has the tracks of its plots where the picture
  /// was corrected at once. Events of a correction are numbers that there are now, or are no more
  /// (`kCorrected`).
  ScanReport sector(const Sector& sector) noexcept {
    return receive(
        SectorInput{sector.radar, sector.from_rad, sector.to_rad, sector.time_s, sector.own},
        sector.plots);
  }

  /// `Tracker::report`. One from before the window, or ahead by more than ten windows, takes place
  /// now.
  ReportResult report(const PositionReport& report) noexcept {
    if (!report.is_valid()) return {Status::kNotFinite, 0, {}};
    return receive(ReportInput(report), {});
  }

  /// `Tracker::partial`, of 256 values at most; placed as a report.
  ScanReport partial(const PartialScan& scan) noexcept {
    std::array<Plot, PartialInput::kMostValues> values = {};
    const std::size_t count = std::min(scan.values.size(), values.size());
    for (std::size_t k = 0; k < count; ++k) values[k].range_m = scan.values[k];
    return receive(
        PartialInput{scan.part, scan.sensor, scan.time_s, scan.std, scan.false_per_unit, scan.own},
        std::span(values.data(), count));
  }

  /// `Tracker::add_radar`. What is older than the newest report is too late from now on.
  int add_radar(const Radar& radar) {
    close();
    const int number = tracker_.add_radar(radar);
    for (Snapshot& snapshot : snapshots_) (void)snapshot.state.add_radar(radar);
    return number;
  }

  /// `Tracker::remove_radar`. What is older than the newest report is too late from now on.
  bool remove_radar(int number) noexcept {
    close();
    for (Snapshot& snapshot : snapshots_) (void)snapshot.state.remove_radar(number);
    return tracker_.remove_radar(number);
  }

  /// `Tracker::set_radar`, at a time; NaN: now.
  void set_radar(int number, const Radar& radar, double time_s = kNow) {
    require(tracker_.has_radar(number), "radar", "the number of a radar of this tracker", number);
    RadarChange action;
    action.number = number;
    action.radar = validated(radar);
    (void)act(time_s, action);
  }

  /// `Tracker::designate`, placed as a report.
  std::int64_t designate(double time_s, double north_m, double east_m, double position_std_m,
                         const std::optional<Gaussian<2>>& velocity = {}) noexcept {
    Designation action;
    action.time_s = time_s;
    action.north_m = north_m;
    action.east_m = east_m;
    action.position_std_m = position_std_m;
    action.velocity = velocity;
    return act(time_s, action);
  }

  /// `Tracker::merge`, at a time; NaN: now.
  bool merge(std::int64_t id, std::int64_t other_id, double time_s = kNow) noexcept {
    Merger action;
    action.id = id;
    action.other_id = other_id;
    return act(time_s, action);
  }

  /// `Tracker::drop`, at a time; NaN: now.
  bool drop(std::int64_t id, bool hush = false, double time_s = kNow) noexcept {
    Removal action;
    action.id = id;
    action.hush = hush;
    return act(time_s, action);
  }

  /// `Tracker::rename`, at a time; NaN: now.
  bool rename(std::int64_t id, std::string_view name, double time_s = kNow) noexcept {
    if (!is_utf8(name)) return false;
    Naming action;
    action.id = id;
    action.length = whole_letters(name, action.name.size() - 1);
    std::copy_n(name.begin(), action.length, action.name.begin());
    return act(time_s, action);
  }

  /// Whether all inputs are in the picture.
  [[nodiscard]] bool is_correct() const noexcept { return last_late_ == kNone; }

  /// Puts all inputs in the picture. The events are those of the correction.
  std::span<const Event> correct() noexcept {
    events_.clear();
    if (!is_correct()) replay([](std::size_t) { return false; });
    return events_;
  }

  /// The picture.
  [[nodiscard]] const TrackerType& tracker() const noexcept { return tracker_; }

  [[nodiscard]] const LateCounts& counts() const noexcept { return progress_.counts; }
  /// With the length of the window.
  [[nodiscard]] const LateWindowConfig& config() const noexcept { return config_; }
  /// Reports from before are too late.
  [[nodiscard]] double earliest_time_s() const noexcept {
    return std::max(progress_.newest_s - config_.window_s, progress_.dropped_s);
  }

  /// The whole state, the picture corrected, to be restored with the same settings and models.
  [[nodiscard]] std::vector<std::byte> save();

  /// Continues bit for bit from the saved one, as soon as the picture is corrected. False, and
  /// nothing changed, when the bytes are not the state of one with the same settings and models.
  [[nodiscard]] bool restore(std::span<const std::byte> bytes);

  /// All corrections cost at most so many times what processing in order does.
  static constexpr double kReplays = 1.75;

 private:
  static constexpr double kNow = std::numeric_limits<double>::quiet_NaN();
  static constexpr double kNever = -std::numeric_limits<double>::infinity();
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  static constexpr std::size_t kSnapshots = 8;
  static constexpr double kSpacing = 0.25;  ///< between snapshots, of the window
  static constexpr double kAhead = 10.0;    ///< of the window, that an action may be ahead
  static constexpr std::uint32_t kArchiveVersion = 1;

  /// The tracker after the first inputs of the log.
  struct Snapshot {
    TrackerType state;
    std::size_t inputs = 0;
    std::int64_t work = 0;  ///< of these and of all before the log
    double time_s = kNever;
  };

  struct Number {
    std::int64_t id;
    std::int64_t tentative_id;
    friend auto operator<=>(const Number& a, const Number& b) { return a.id <=> b.id; }
  };

  /// What has come so far.
  struct Progress {
    LateCounts counts = {};
    std::int64_t arrivals = 0;
    double newest_s = kNever;   ///< time of the newest report
    double dropped_s = kNever;  ///< no input before can be put in its place
    double credit = 0.0;        ///< work that corrections may cost
  };

  [[nodiscard]] int most_plots() const noexcept {
    return std::max(config_.max_plots, tracker_.config().max_plots);
  }

  /// An action for a later time takes place now.
  [[nodiscard]] double ahead_s() const noexcept {
    return progress_.newest_s + kAhead * config_.window_s;
  }

  [[nodiscard]] Snapshot& held(std::size_t k) noexcept { return snapshots_[held_[k]]; }
  [[nodiscard]] Snapshot& newest_held() noexcept { return held(count_ - 1); }

  /// What sensors report.
  template <class Input>
  auto receive(const Input& input, std::span<const Plot> plots) noexcept {
    using Result = decltype(input.give_to(tracker_, plots));
    events_.clear();
    plot_track_id_.clear();
    const auto most = static_cast<std::size_t>(tracker_.config().max_plots);
    const std::span<const Plot> kept = plots.first(std::min(plots.size(), most));
    make_room(kept.size());
    double time_s = input.true_time_s(tracker_);
    if (time_s < earliest_time_s()) {
      ++progress_.counts.too_late;
      if constexpr (Input::kIsScan)
        return Result{Status::kNegativeTimeStep, {}, events_, static_cast<int>(plots.size())};
    }
    Result result = input.give_to(tracker_, plots);
    if (result.status == Status::kNotFinite) return result;
    events_.insert(events_.end(), result.events.begin(), result.events.end());
    note_owners(result, kept.size());
    if constexpr (!Input::kIsScan) time_s = placed_s(time_s);
    const std::size_t place = put(time_s, input, kept);
    if constexpr (Input::kIsScan) {
      progress_.newest_s = std::max(progress_.newest_s, time_s);
      log_.bring_forward(ahead_s(), progress_.newest_s);
    }
    correct_if_paid([&](std::size_t at) {
      if (at != place) return false;
      result = input.give_to(tracker_, plots);
      note_owners(result, kept.size());
      return true;
    });
    hold_if_due();
    drop_settled();
    if (result.status == Status::kNegativeTimeStep && !is_correct()) result.status = Status::kOk;
    result.events = events_;
    if constexpr (requires { result.plot_track_id; }) result.plot_track_id = plot_track_id_;
    return result;
  }

  /// What an operator does.
  template <class Action>
  auto act(double time_s, const Action& action) noexcept {
    using Result = decltype(action.give_to(tracker_, {}));
    events_.clear();
    if (std::isinf(time_s)) return Result{};
    make_room(0);
    Result result = action.give_to(tracker_, {});
    const std::size_t place = put(placed_s(time_s), action, {});
    correct_if_paid([&](std::size_t at) {
      if (at == place) result = action.give_to(tracker_, {});
      return at == place;
    });
    return result;
  }

  /// When an input takes place that is not of a scan: now, where its time is before the window, too
  /// far ahead, or NaN.
  [[nodiscard]] double placed_s(double time_s) const noexcept {
    const bool known = progress_.newest_s > kNever;
    if (!known) return std::isnan(time_s) ? kNever : time_s;
    return time_s >= earliest_time_s() && time_s <= ahead_s() ? time_s : progress_.newest_s;
  }

  /// Puts an input that came in its place in the log, which is returned. Snapshots that had
  /// processed a later one are held no more.
  template <class Input>
  std::size_t put(double time_s, const Input& input, std::span<const Plot> plots) noexcept {
    const std::int64_t work = input.work(plots.size(), tracker_.size());
    const std::size_t place = log_.insert({time_s, progress_.arrivals++, work, input}, plots);
    work_ += work;
    progress_.credit = std::min(progress_.credit + kReplays * double(work), cost_since(held(0)));
    progress_.counts.late += time_s < progress_.newest_s;
    if (place + 1 == log_.size()) return place;
    while (newest_held().inputs > place) --count_;
    if (last_late_ != kNone && place <= last_late_) ++last_late_;
    last_late_ = last_late_ == kNone ? place : std::max(last_late_, place);
    return place;
  }

  /// What a correction from a snapshot costs, with two copies of the tracker.
  [[nodiscard]] double cost_since(const Snapshot& snapshot) const noexcept {
    const double copy = 50.0 + 0.2 * tracker_.size();
    return double(work_ - snapshot.work) + 2.0 * copy;
  }

  template <class Give>
  void correct_if_paid(const Give& give) noexcept {
    if (!is_correct() && cost_since(newest_held()) <= progress_.credit) replay(give);
  }

  /// Goes back to before all that came late and processes the inputs from there on; `give(place)`
  /// may do so for one and return true.
  template <class Give>
  void replay(const Give& give) noexcept {
    list_numbers(before_);
    const Snapshot& from = newest_held();
    progress_.credit = std::max(0.0, progress_.credit - cost_since(from));
    ++progress_.counts.corrections;
    tracker_.copy_state_from(from.state);
    std::int64_t work = from.work;
    for (std::size_t place = from.inputs; place < log_.size(); ++place) {
      if (!give(place)) give_again(place);
      work += log_[place].work;
      // Where the next late input of the same sensor will be, and before, as they may differ.
      if (place == last_late_ || (place < last_late_ && is_hold_due(log_[place].time_s)))
        hold(place + 1, work);
    }
    last_late_ = kNone;
    list_numbers(after_);
    announce_difference(before_, after_, TrackEvent::kLost, LossReason::kCorrected);
    announce_difference(after_, before_, TrackEvent::kConfirmed, LossReason::kNone);
  }

  void give_again(std::size_t place) noexcept {
    const InputLog::Entry& entry = log_[place];
    std::visit([&](const auto& input) { (void)input.give_to(tracker_, log_.plots_of(entry)); },
               entry.input);
  }

  /// Takes a snapshot of the tracker, which has processed so many inputs of the log.
  void hold(std::size_t inputs, std::int64_t work) noexcept {
    if (count_ > 0 && newest_held().inputs == inputs) return;
    if (count_ == kSnapshots) release_one();
    Snapshot& snapshot = held(count_++);
    snapshot.state.copy_state_from(tracker_);
    snapshot.inputs = inputs;
    snapshot.work = work;
    snapshot.time_s = log_[inputs - 1].time_s;
  }

  [[nodiscard]] bool is_hold_due(double time_s) noexcept {
    return time_s - newest_held().time_s >= kSpacing * config_.window_s;
  }

  void hold_if_due() noexcept {
    if (is_correct() && is_hold_due(progress_.newest_s)) hold(log_.size(), work_);
  }

  /// Releases the snapshot without which the others are least far apart; not the oldest, nor the
  /// newest.
  void release_one() noexcept {
    std::size_t least = 1;
    const auto gap_s = [&](std::size_t k) { return held(k + 1).time_s - held(k - 1).time_s; };
    for (std::size_t k = 2; k + 1 < count_; ++k)
      if (gap_s(k) < gap_s(least)) least = k;
    release(least);
  }

  void release(std::size_t k) noexcept {
    std::rotate(held_.begin() + static_cast<std::ptrdiff_t>(k),
                held_.begin() + static_cast<std::ptrdiff_t>(k) + 1,
                held_.begin() + static_cast<std::ptrdiff_t>(count_));
    --count_;
  }

  /// Drops the inputs up to the second snapshot, which is then the oldest.
  void drop_oldest() noexcept {
    const std::size_t inputs = held(1).inputs;
    log_.drop(inputs);
    release(0);
    for (std::size_t k = 0; k < count_; ++k) held(k).inputs -= inputs;
    if (last_late_ != kNone) last_late_ -= inputs;
  }

  /// Drops the inputs before which none can come any more.
  void drop_settled() noexcept {
    while (count_ > 1 && held(1).time_s < earliest_time_s()) drop_oldest();
  }

  /// Ends the window: no input can be put before now.
  void close() noexcept {
    (void)correct();
    log_.drop(log_.size());
    for (Snapshot& snapshot : snapshots_) snapshot.state.copy_state_from(tracker_);
    count_ = 1;
    held(0).inputs = 0;
    held(0).work = work_;
    held(0).time_s = progress_.dropped_s = progress_.newest_s;
  }

  /// Makes room for one more input, at the cost of the window.
  void make_room(std::size_t plots) noexcept {
    while (!log_.has_room_for(plots)) {
      if (!is_correct()) replay([](std::size_t) { return false; });
      if (count_ == 1) hold(log_.size(), work_);
      progress_.dropped_s = std::nextafter(held(1).time_s, std::numeric_limits<double>::infinity());
      drop_oldest();
    }
  }

  void note_owners(const auto& result, std::size_t plots) noexcept {
    if constexpr (requires { result.plot_track_id; }) {
      plot_track_id_.assign(plots, 0);
      std::copy(result.plot_track_id.begin(), result.plot_track_id.end(), plot_track_id_.begin());
    }
  }

  /// The numbers that are shown.
  void list_numbers(std::vector<Number>& numbers) const noexcept {
    numbers.clear();
    tracker_.for_each([&](const Track& track) {
      if (track.id > 0 && !track.hushed) numbers.push_back({track.id, track.tentative_id});
    });
    std::sort(numbers.begin(), numbers.end());
  }

  /// Announces the numbers of the first list that are not in the second.
  void announce_difference(const std::vector<Number>& these, const std::vector<Number>& others,
                           TrackEvent kind, LossReason reason) noexcept {
    for (const Number& number : these)
      if (!std::binary_search(others.begin(), others.end(), number) &&
          events_.size() < events_.capacity())
        events_.push_back({kind, number.id, number.tentative_id, tracker_.time_s(), reason});
  }

  void archive(Archive& fields, double& oldest_s, InputLog& log, Progress& progress) {
    fields.rules(kArchiveVersion, config_);
    for (int k = 0; k < tracker_.radar_numbers(); ++k)
      if (tracker_.has_radar(k)) fields.rules(tracker_.radar(k));
    fields(oldest_s);
    fields(progress);
    log.archive(fields);
  }

  /// The settings of radars, which may have changed since.
  static void archive_radars(Archive& fields, TrackerType& tracker) {
    for (int k = 0; k < tracker.radar_numbers(); ++k) {
      if (!tracker.has_radar(k)) continue;
      Radar radar = tracker.radar(k);
      for_each_field(radar, [&](const auto&, auto& value) { fields(value); });
      if (fields.loading() && fields.ok()) tracker.set_radar(k, radar);
    }
  }

  LateWindowConfig config_;
  TrackerType tracker_;  ///< the picture
  InputLog log_;
  std::vector<Snapshot> snapshots_;
  std::array<std::size_t, kSnapshots> held_ = {};  ///< the first `count_`, older ones first
  std::size_t count_ = 1;
  std::size_t last_late_ = kNone;  ///< place of the last input that is not in the picture
  std::int64_t work_ = 0;          ///< of all inputs
  Progress progress_;

  std::vector<Number> before_;  ///< a correction
  std::vector<Number> after_;
  std::vector<std::int64_t> plot_track_id_;
  std::vector<Event> events_;
};

template <class TrackerType>
std::vector<std::byte> LateWindow<TrackerType>::save() {
  (void)correct();
  return saved_state([this](Archive& fields) {
    std::vector<std::byte> oldest = held(0).state.save();
    fields(oldest, oldest.size());
    archive(fields, held(0).time_s, log_, progress_);
    archive_radars(fields, held(0).state);
  });
}

template <class TrackerType>
bool LateWindow<TrackerType>::restore(std::span<const std::byte> bytes) {
  if (count_ == kSnapshots) release_one();
  TrackerType& restored = held(count_).state;
  restored.copy_state_from(tracker_);
  std::vector<std::byte> oldest;
  double oldest_s = kNever;
  Progress progress;
  InputLog log(config_.max_inputs, most_plots());
  const bool is_read = read_state(bytes, [&](Archive& fields) {
    fields(oldest, bytes.size());
    archive(fields, oldest_s, log, progress);
    archive_radars(fields, restored);
  });
  if (!is_read || !restored.restore(oldest)) return false;
  std::swap(held_[0], held_[count_]);
  log_ = std::move(log);
  progress_ = progress;
  last_late_ = kNone;
  count_ = 1;
  held(0).time_s = oldest_s;
  held(0).inputs = 0;
  held(0).work = work_ = 0;
  tracker_.copy_state_from(held(0).state);
  for (std::size_t place = 0; place < log_.size(); ++place) {
    give_again(place);
    work_ += log_[place].work;
    if (log_[place].time_s - newest_held().time_s >= kSpacing * config_.window_s)
      hold(place + 1, work_);
  }
  return true;
}

}  // namespace wakeline
