// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <vector>

#include "wakeline/core/archive.hpp"
#include "wakeline/core/status.hpp"
#include "wakeline/core/types.hpp"
#include "wakeline/measurement/fix.hpp"
#include "wakeline/multimodel/mixture.hpp"
#include "wakeline/track/mode_positions.hpp"
#include "wakeline/track/track.hpp"

namespace wakeline {

/// What a track can be: an estimator of `double` with the face of `Imm` (an `Imm` of one model is a
/// single filter). It shows its modes by `for_each_mode(f(mode, belief))` and `mode_probability()`,
/// or compares a fix with them itself by `evidence(sensor, z)`.
template <class Estimator>
concept TrackEstimator = std::copyable<Estimator> &&
    requires(Estimator estimator, const Estimator& constant, std::span<double> share,
             std::span<const Alternative<Fix>> readings, Archive& fields) {
  { estimator.start(Gaussian<4>{}) } -> std::same_as<Status>;
  { estimator.predict(1.0) } -> std::same_as<Status>;
  { estimator.update(readings, 1.0, share) } -> std::same_as<double>;
  requires HasModePositions<Estimator>;
  constant.estimate();
  estimator.archive(fields);
};

/// The belief of a track at a time: before its estimate at constant velocity, after it by its
/// estimator; NaN where the time is not finite or so far ahead that the prediction fails.
template <class Track, class Estimator>
[[nodiscard]] Gaussian<4> kinematics_at(const Track& track, const Estimator& estimator,
                                        double time_s) noexcept {
  if (time_s <= track.time_s) return at_constant_velocity(track.kinematics, time_s - track.time_s);
  Estimator ahead = estimator;
  if (ahead.predict(time_s - track.time_s) == Status::kOk) return kinematics_of(ahead.estimate());
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  return {Vec<double, 4>::Constant(kNaN), Mat<double, 4, 4>::Constant(kNaN)};
}

/// Writes the states of an estimator after a slow start and after fast ones, two time steps and a
/// reading.
template <class Estimator>
void write_samples(const Estimator& prototype, Archive& fields) {
  const Alternative<Fix> reading{Fix{}, {101.0, 199.0}, 1.0};
  for (const double speed_mps : {5.0, 15.0, 40.0, 200.0}) {
    Estimator estimator = prototype;
    double share = 0.0;
    (void)estimator.start(
        Gaussian<4>{{100.0, speed_mps, 200.0, -3.0}, Mat<double, 4, 4>::Identity()});
    for (const double dt_s : {1.0, 2.5}) (void)estimator.predict(dt_s);
    (void)estimator.update(std::span(&reading, 1), 1.0, std::span(&share, 1));
    estimator.archive(fields);
  }
}

/// Distinguishes estimators of different models or chains, also of those that rest at first.
template <TrackEstimator Estimator>
[[nodiscard]] std::uint64_t fingerprint(const Estimator& prototype) {
  Archive fields;
  write_samples(prototype, fields);
  if constexpr (requires { prototype.all(); }) write_samples(prototype.all(), fields);
  return checksum(fields.bytes());
}

/// What `archive(fields)` writes as bytes, with their checksum.
template <class Function>
[[nodiscard]] std::vector<std::byte> saved_state(const Function& archive) {
  Archive fields;
  archive(fields);
  std::uint64_t sum = checksum(fields.bytes());
  fields(sum);
  return fields.bytes();
}

/// Reads such bytes by `archive(fields)`. False when they are damaged or those of something else.
template <class Function>
[[nodiscard]] bool read_state(std::span<const std::byte> bytes, const Function& archive) {
  std::uint64_t sum = 0;
  if (bytes.size() < sizeof(sum)) return false;
  const std::span<const std::byte> state = bytes.first(bytes.size() - sizeof(sum));
  std::memcpy(&sum, bytes.data() + state.size(), sizeof(sum));
  if (sum != checksum(state)) return false;
  Archive fields(state);
  archive(fields);
  return fields.ok() && fields.at_end();
}

}  // namespace wakeline
