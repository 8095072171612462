// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "wakeline/core/types.hpp"
#include "wakeline/track/beam.hpp"
#include "wakeline/track/config.hpp"
#include "wakeline/track/identities.hpp"
#include "wakeline/track/partial_scan.hpp"
#include "wakeline/track/radar.hpp"
#include "wakeline/track/results.hpp"
#include "wakeline/track/track.hpp"

namespace wakeline {

template <class Estimator>
class SideBySide;  // simd/side_by_side.hpp

template <class Estimator, class Steps>
struct TrackerParts;  // track/tracker_parts.hpp

/// Whether `wakeline::tracker` is linked and has the tracker of that estimator.
template <class Estimator>
inline constexpr bool kTrackerIsCompiled = false;

/// Keeps tracks of all vessels that some radars see, scan by scan.
///
/// Each track is an estimator with a probability of existence, and of visibility to each radar.
/// It is updated by every radar that covers it; a miss counts in its life only where no other radar
/// has seen it within a period. All memory is taken by the constructor; `process` neither allocates
/// nor throws. A tracker may be used from one thread at a time; trackers share nothing. `Steps`
/// predicts and updates the estimators of many tracks at once. Sources: D. Mušicki, R. Evans,
/// "Joint integrated probabilistic data association", IEEE Trans. AES-40, 2004; J. L. Williams, R.
/// A. Lau, IEEE Trans. AES-50, 2014; Bar-Shalom, Li, Multitarget-Multisensor Tracking, 1995.
template <class Estimator, class Steps = SideBySide<Estimator>>
class Tracker {
  static_assert(
      kTrackerIsCompiled<Estimator> || requires { sizeof(TrackerParts<Estimator, Steps>); },
      "wakeline: wakeline::tracker has the tracker of vessels alone; for another one "
      "#include <wakeline/track/tracker_parts.hpp>");

 public:
  /// Throws `std::invalid_argument` on a setting that makes no sense.
  Tracker(const Radar& radar, const TrackerConfig& config, const Estimator& prototype)
      : Tracker(std::span(&radar, 1), config, prototype) {}

  /// The same with several radars, `kMostRadars` at most, which are numbered from 0.
  Tracker(std::span<const Radar> radars, const TrackerConfig& config, const Estimator& prototype);

  Tracker(Tracker&&) noexcept;
  Tracker& operator=(Tracker&&) noexcept;
  ~Tracker();

  /// Processes the plots of one scan, a whole turn of the first radar that ends at `time_s`: a
  /// track without a plot has missed it. Times of scan and plots are by the radar's clock;
  /// `time_s()`, tracks and events have true time (`Radar::time_offset_s`). Rejects a scan that is
  /// before the last one of its radar, or more than a period before that of another one
  /// (`kNegativeTimeStep`), or after `latest_time_s()` (`kNotFinite`): nothing changes.
  ScanReport process(double time_s, std::span<const Plot> plots) noexcept;

  /// Processes a part of the antenna's turn.
  ///
  /// Tracks whose gate the beam has passed are updated or have missed, once a turn; others, and
  /// plots that may be theirs, wait for the next sector, so that `plot_track_id` is 0 for these.
  /// Where sectors leave a gap, tracks are neither updated nor miss; a track that the beam has not
  /// passed for two periods coasts by time, a miss a period. A sector of no width lets time pass.
  /// One of a whole turn is `process`. Rejects a sector of a radar that is not known or from
  /// nowhere to nowhere (`kNotFinite`), of a time that `process` rejects, or behind the beam after a
  /// quarter of a turn of such, as of an antenna that turns anticlockwise (`kNegativeTimeStep`):
  /// nothing changes.
  ScanReport sector(const Sector& sector) noexcept;

  /// Adds a radar and returns its number, the least that is free; takes memory. Throws
  /// `std::invalid_argument` on a setting that makes no sense, and when there are `kMostRadars`.
  int add_radar(const Radar& radar);

  /// Removes a radar and what was learned of it; tracks continue by the others. False when there is
  /// none of that number or it is the last one.
  bool remove_radar(int number) noexcept;

  /// Changes the settings of a radar, such as the errors and the period of another range scale,
  /// and keeps all tracks. Throws `std::invalid_argument` on a setting that makes no sense and when
  /// there is no radar of that number.
  void set_radar(int number, const Radar& radar);

  [[nodiscard]] bool has_radar(int number) const noexcept;

  /// One more than the largest number of a radar.
  [[nodiscard]] int radar_numbers() const noexcept;

  /// The radar of that number, which is known.
  [[nodiscard]] const Radar& radar(int number = 0) const noexcept;

  /// The probability that a radar can see the target of a track; of those that can, the largest.
  [[nodiscard]] double visibility(const Track& track) const noexcept;

  /// Takes the position that a vessel reports of itself.
  ///
  /// The report may be `kOldestReport_s` before the last scan or after it, and reports of one
  /// identity come in their order. It is of the track that its identity is believed to be, which is
  /// decided by where the reports of the identity are, one after the other, and of a new track
  /// where there is none near and the vessel has reported before. It updates the track only while
  /// they agree, so that an identity that is wrong, stolen or old drags no track away; events tell
  /// of it. A track that reports is kept while its vessel can be silent. Rejects what is not valid
  /// or later than that (`kNotFinite`), and what is older than that or than the last report of the
  /// same identity
  /// (`kNegativeTimeStep`): nothing changes. Takes the velocity where the estimator has a form for
  /// it, as `Imm` has.
  ReportResult report(const PositionReport& report) noexcept;

  /// Takes bearings or ranges of targets without the other part of their position.
  ///
  /// They update the confirmed tracks, start none, and count no misses. Values between several
  /// tracks are shared by their likelihoods. The time may be as far from the last scan as that of a
  /// report; the estimate of a later time takes them as its velocity says. Errors of such a sensor
  /// stay for a while: values that come faster than the antenna turns count as much as one a turn.
  /// `plot_track_id` is of each value up to `max_plots` the track it most probably belongs to.
  ScanReport partial(const PartialScan& scan) noexcept;

  /// The vessel that a track is believed to be by its reports, or null; `time_s` is that of its
  /// last report.
  [[nodiscard]] const Identity* identity_of(const Track& track) const noexcept;

  /// How probable it is that a track is the vessel of `identity_of`; 0 without one.
  [[nodiscard]] double identity_probability(const Track& track) const noexcept;

  /// The track of the vessel that reports under an identity, or null.
  [[nodiscard]] const Track* find(std::string_view source,
                                  std::string_view identity) const noexcept;

  /// Calls `f(track)` for every track, tentative and hushed ones too, older ones first. Each has
  /// the estimate of its own time; `kinematics_at` has all at one.
  template <class Function>
  void for_each(Function&& function) const {
    for (const int slot : slots()) function(at(slot));
  }

  [[nodiscard]] int size() const noexcept;

  /// The track of that number, or null.
  [[nodiscard]] const Track* find(std::int64_t id) const noexcept;

  /// The estimator of a track of this tracker.
  [[nodiscard]] const Estimator& estimator_of(const Track& track) const noexcept;

  /// The belief of a track of this tracker as it is reported, at a time such as `time_s()`, before
  /// its estimate at constant velocity; NaN where the time is not finite or so far ahead that the
  /// prediction fails. To the covariance of the estimator, `Track::kinematics`, it adds errors that
  /// stay from scan to scan and alterations of course that do not show yet (`reported`).
  [[nodiscard]] Gaussian<4> kinematics_at(const Track& track, double time_s) const noexcept;

  /// Until when a scan is processed and a target can be designated: an hour after the last scan, or
  /// ever before the first one. A time further ahead is of another clock. After a longer silence
  /// of the radar a scan without plots is needed an hour after the last one.
  [[nodiscard]] double latest_time_s() const noexcept;

  /// Confirms the track in whose gate the operator points, or starts a confirmed one at rest, or
  /// with the velocity given, [north, east].
  ///
  /// Returns its number, or 0 when there is no room, a number is not finite or out of range or the
  /// time is more than an hour from the last scan. Of several tracks the nearest is confirmed, in
  /// standard deviations; it is hushed no more. Where the tracker is full, the weakest tentative
  /// track is deleted for a new one, without an event.
  [[nodiscard]] std::int64_t designate(double time_s, double north_m, double east_m,
                                       double position_std_m,
                                       const std::optional<Gaussian<2>>& velocity = {}) noexcept;

  /// Deletes a track; false when there is none of that number. With `hush` its vessel is followed
  /// in silence, so that it does not start again under another number: the track is not shown, has
  /// no events and no plots reported, until its vessel is lost, it is designated or dropped again.
  bool drop(std::int64_t id, bool hush = false) noexcept;

  /// Says that two tracks are of one vessel: the second is deleted, and the first takes its name
  /// and its identity if it has none. False when there are no two of these numbers. Where the
  /// vessel has two echoes, `drop` with `hush` keeps the second from a new number.
  bool merge(std::int64_t id, std::int64_t other_id) noexcept;

  /// Names a track (31 bytes at most are kept, of UTF-8 whole letters); false when there is none of
  /// that number or the name is not UTF-8.
  bool rename(std::int64_t id, std::string_view name) noexcept;

  /// The whole state, to be restored by a tracker with the same settings and models that is
  /// compiled for the same instruction set.
  [[nodiscard]] std::vector<std::byte> save() const;

  /// Continues bit for bit from the saved tracker. False, and nothing changed, when the bytes are
  /// not the state of a tracker with the same settings and models.
  [[nodiscard]] bool restore(std::span<const std::byte> bytes);

  /// Continues bit for bit from another tracker with the same settings and models, as `restore`
  /// does from what it saved, also with its radars. No memory is taken where there are as many.
  void copy_state_from(const Tracker& other) noexcept;

  [[nodiscard]] const Estimator& prototype() const noexcept;
  [[nodiscard]] const TrackerConfig& config() const noexcept;

  /// Whether there was a scan.
  [[nodiscard]] bool started() const noexcept;

  /// Time of the last scan; 0 before the first.
  [[nodiscard]] double time_s() const noexcept;

 private:
  [[nodiscard]] std::span<const int> slots() const noexcept;
  [[nodiscard]] const Track& at(int slot) const noexcept;

  std::unique_ptr<TrackerParts<Estimator, Steps>> parts_;
};

}  // namespace wakeline

#ifdef WAKELINE_USES_COMPILED_TRACKER
#include "wakeline/track/compiled.hpp"
#else
#include "wakeline/track/tracker_parts.hpp"
#endif
