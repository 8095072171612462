// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// What a Tracker is made of. A unit that uses the tracker of `wakeline::tracker` does without.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "wakeline/core/utf8.hpp"
#include "wakeline/track/partial_stages.hpp"
#include "wakeline/track/picture.hpp"
#include "wakeline/track/report_stages.hpp"
#include "wakeline/track/scan_stages.hpp"
#include "wakeline/track/tracker.hpp"

namespace wakeline {

/// The picture of a tracker and the stages by which its inputs change it.
template <class Estimator, class Steps>
struct TrackerParts {
  TrackerParts(std::span<const Radar> radars, const TrackerConfig& config,
               const Estimator& prototype)
      : picture(radars, config, prototype) {}

  Picture<Estimator, Steps> picture;
  ScanStages<Estimator, Steps> scans{picture};
  ReportStages<Estimator, Steps> reports{picture};
  PartialStages<Estimator, Steps> partials{picture};
};

template <class Estimator, class Steps>
Tracker<Estimator, Steps>::Tracker(std::span<const Radar> radars, const TrackerConfig& config,
                                   const Estimator& prototype)
    : parts_(std::make_unique<TrackerParts<Estimator, Steps>>(radars, config, prototype)) {}

template <class Estimator, class Steps>
Tracker<Estimator, Steps>::Tracker(Tracker&&) noexcept = default;

template <class Estimator, class Steps>
Tracker<Estimator, Steps>& Tracker<Estimator, Steps>::operator=(Tracker&&) noexcept = default;

template <class Estimator, class Steps>
Tracker<Estimator, Steps>::~Tracker() = default;

template <class Estimator, class Steps>
ScanReport Tracker<Estimator, Steps>::process(double time_s, std::span<const Plot> plots) noexcept {
  return parts_->scans.process(0, time_s, plots, nullptr);
}

template <class Estimator, class Steps>
ScanReport Tracker<Estimator, Steps>::sector(const Sector& sector) noexcept {
  const double width_rad = Beam::width_rad(sector.from_rad, sector.to_rad);
  if (std::isnan(width_rad)) return parts_->picture.rejected(Status::kNotFinite);
  return parts_->scans.process(sector.radar, sector.time_s, sector.plots,
                               Beam::is_turn(width_rad) ? nullptr : &sector);
}

template <class Estimator, class Steps>
int Tracker<Estimator, Steps>::add_radar(const Radar& radar) {
  return parts_->picture.add_radar(radar);
}

template <class Estimator, class Steps>
bool Tracker<Estimator, Steps>::remove_radar(int number) noexcept {
  Picture<Estimator, Steps>& picture = parts_->picture;
  if (!picture.has_radar(number) || picture.radars_in_use() == 1) return false;
  picture.radars[static_cast<std::size_t>(number)].in_use = false;
  picture.at_hand = 0;
  while (!picture.has_radar(picture.at_hand)) ++picture.at_hand;
  return true;
}

template <class Estimator, class Steps>
void Tracker<Estimator, Steps>::set_radar(int number, const Radar& radar) {
  require(has_radar(number), "radar", "the number of a radar of this tracker", number);
  parts_->picture.radars[static_cast<std::size_t>(number)].radar = validated(radar);
}

template <class Estimator, class Steps>
bool Tracker<Estimator, Steps>::has_radar(int number) const noexcept {
  return parts_->picture.has_radar(number);
}

template <class Estimator, class Steps>
int Tracker<Estimator, Steps>::radar_numbers() const noexcept {
  return static_cast<int>(parts_->picture.radars.size());
}

template <class Estimator, class Steps>
const Radar& Tracker<Estimator, Steps>::radar(int number) const noexcept {
  return parts_->picture.radars[static_cast<std::size_t>(number)].radar;
}

template <class Estimator, class Steps>
double Tracker<Estimator, Steps>::visibility(const Track& track) const noexcept {
  double largest = 0.0;
  for (const RadarState& radar : parts_->picture.radars)
    if (radar.in_use) largest = std::max(largest, radar.look(track).visibility);
  return largest;
}

template <class Estimator, class Steps>
ReportResult Tracker<Estimator, Steps>::report(const PositionReport& report) noexcept {
  return parts_->reports.process(report);
}

template <class Estimator, class Steps>
ScanReport Tracker<Estimator, Steps>::partial(const PartialScan& scan) noexcept {
  return parts_->partials.process(scan);
}

template <class Estimator, class Steps>
const Identity* Tracker<Estimator, Steps>::identity_of(const Track& track) const noexcept {
  return track.identity < 0 ? nullptr : &parts_->picture.identities[track.identity];
}

template <class Estimator, class Steps>
double Tracker<Estimator, Steps>::identity_probability(const Track& track) const noexcept {
  return parts_->picture.identity_probability(track);
}

template <class Estimator, class Steps>
const Track* Tracker<Estimator, Steps>::find(std::string_view source,
                                             std::string_view identity) const noexcept {
  const Picture<Estimator, Steps>& picture = parts_->picture;
  const int number = picture.identities.find(source, identity);
  const int slot = number < 0 ? -1 : picture.slot_of_identity(number);
  return slot < 0 ? nullptr : &at(slot);
}

template <class Estimator, class Steps>
const Track* Tracker<Estimator, Steps>::find(std::int64_t id) const noexcept {
  return std::as_const(parts_->picture.tracks).find(id);
}

template <class Estimator, class Steps>
int Tracker<Estimator, Steps>::size() const noexcept {
  return parts_->picture.tracks.size();
}

template <class Estimator, class Steps>
std::span<const int> Tracker<Estimator, Steps>::slots() const noexcept {
  return parts_->picture.tracks.slots();
}

template <class Estimator, class Steps>
const Track& Tracker<Estimator, Steps>::at(int slot) const noexcept {
  return parts_->picture.tracks.at(slot);
}

template <class Estimator, class Steps>
const Estimator& Tracker<Estimator, Steps>::estimator_of(const Track& track) const noexcept {
  return std::as_const(parts_->picture).estimator_of(track.slot);
}

template <class Estimator, class Steps>
const Estimator& Tracker<Estimator, Steps>::prototype() const noexcept {
  return parts_->picture.prototype;
}

template <class Estimator, class Steps>
const TrackerConfig& Tracker<Estimator, Steps>::config() const noexcept {
  return parts_->picture.config;
}

template <class Estimator, class Steps>
bool Tracker<Estimator, Steps>::started() const noexcept {
  return parts_->picture.started;
}

template <class Estimator, class Steps>
double Tracker<Estimator, Steps>::time_s() const noexcept {
  return parts_->picture.scan_time_s;
}

template <class Estimator, class Steps>
double Tracker<Estimator, Steps>::latest_time_s() const noexcept {
  return parts_->picture.latest_time_s();
}

template <class Estimator, class Steps>
Gaussian<4> Tracker<Estimator, Steps>::kinematics_at(const Track& track,
                                                     double time_s) const noexcept {
  return reported(parts_->picture.belief_at(track, time_s), track.position_variance_m2(),
                  track.gain(), track.hits, track.errors_scale, track.stays_m2);
}

template <class Estimator, class Steps>
std::int64_t Tracker<Estimator, Steps>::designate(
    double time_s, double north_m, double east_m, double position_std_m,
    const std::optional<Gaussian<2>>& velocity) noexcept {
  Picture<Estimator, Steps>& picture = parts_->picture;
  if (!std::isfinite(time_s) || !picture.is_near_now(time_s)) return 0;
  const Gaussian<2> position{{north_m, east_m},
                             position_std_m * position_std_m * Mat<double, 2, 2>::Identity()};
  if (!in_range(position.mean) || !(position_std_m > 0.0) || !in_range(position_std_m)) return 0;
  if (velocity && !(in_range(velocity->mean) && in_range(std::sqrt(velocity->covariance.trace())) &&
                    Cholesky<2>(velocity->covariance).ok()))
    return 0;
  if (Track* known = picture.track_at(position, time_s)) {
    picture.confirm_designated(*known);
    return known->id;
  }
  const Gaussian<4> belief = kinematics_from<double>(
      position, velocity.value_or(picture.state().initiation.prior_velocity(picture.state().radar)),
      Mat<double, 2, 2>::Zero());
  picture.room.reset();
  if (!picture.room.has_room_for(picture.kSurelyExists, picture.tracks)) return 0;
  Track* track =
      picture.open({belief, time_s, picture.state().beam.angle_rad(), picture.kSurelyExists, {}});
  picture.tracks.close_gaps();
  if (track == nullptr) return 0;
  track->tentative_id = 0;
  track->scans = track->hits = 0;
  picture.confirm_designated(*track);
  return track->id;
}

template <class Estimator, class Steps>
bool Tracker<Estimator, Steps>::drop(std::int64_t id, bool hush) noexcept {
  TrackList& tracks = parts_->picture.tracks;
  Track* track = tracks.find(id);
  if (track == nullptr) return false;
  if (hush)
    track->hushed = true;
  else
    tracks.remove(track->slot);
  return true;
}

template <class Estimator, class Steps>
bool Tracker<Estimator, Steps>::merge(std::int64_t id, std::int64_t other_id) noexcept {
  Picture<Estimator, Steps>& picture = parts_->picture;
  TrackList& tracks = picture.tracks;
  Track* track = tracks.find(id);
  Track* other = tracks.find(other_id);
  if (track == nullptr || other == nullptr || track == other) return false;
  if (track->label().empty()) track->name = other->name;
  if (track->identity < 0 && other->identity >= 0) {
    track->identity = other->identity;
    picture.identities[other->identity].hand_over(*other, *track);
  }
  tracks.remove(other->slot);
  return true;
}

template <class Estimator, class Steps>
bool Tracker<Estimator, Steps>::rename(std::int64_t id, std::string_view name) noexcept {
  Track* track = parts_->picture.tracks.find(id);
  if (track == nullptr || !is_utf8(name)) return false;
  track->name.fill('\0');
  std::copy_n(name.begin(), whole_letters(name, track->name.size() - 1), track->name.begin());
  return true;
}

template <class Estimator, class Steps>
std::vector<std::byte> Tracker<Estimator, Steps>::save() const {
  return saved_state([this](Archive& fields) { parts_->picture.archive(fields); });
}

template <class Estimator, class Steps>
bool Tracker<Estimator, Steps>::restore(std::span<const std::byte> bytes) {
  const Picture<Estimator, Steps>& picture = parts_->picture;
  std::vector<Radar> radars;
  for (const RadarState& radar : picture.radars) radars.push_back(radar.radar);
  Tracker other(radars, picture.config, picture.prototype);
  Picture<Estimator, Steps>& restored = other.parts_->picture;
  for (std::size_t k = 0; k < radars.size(); ++k)
    restored.radars[k].in_use = picture.radars[k].in_use;
  if (!read_state(bytes, [&](Archive& fields) { restored.archive(fields); })) return false;
  *this = std::move(other);
  return true;
}

template <class Estimator, class Steps>
void Tracker<Estimator, Steps>::copy_state_from(const Tracker& other) noexcept {
  parts_->picture.copy_state_from(other.parts_->picture);
}

}  // namespace wakeline
