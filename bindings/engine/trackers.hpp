// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// What the bindings of trackers share. `AnyTracker` is one of several trackers, which `visit` calls
// a function with; a tracker is one of them.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "estimators.hpp"
#include "support/columns.hpp"
#include "wakeline/track/track.hpp"

namespace wakeline::python {

inline const char* status_name(TrackStatus status) {
  switch (status) {
    case TrackStatus::kTentative:
      return "tentative";
    case TrackStatus::kConfirmed:
      return "confirmed";
    case TrackStatus::kCoasting:
      return "coasting";
    case TrackStatus::kHeld:
      return "held";
  }
  return "";
}

/// The estimator of tracks behind a Python one.
inline const AnyEstimator& to_mixture(const py::handle& estimator) {
  if (!is_a<AnyMixture>(estimator))
    throw py::type_error("estimator must be one of several models (MultiModelEstimator), got " +
                         class_name(estimator));
  require_own_class(estimator);
  const auto& mixture = estimator.cast<const AnyMixture&>();
  for_each_custom(mixture, [](const PyMotion& motion) {
    if (!has_kinematics(motion.layout()))
      throw py::value_error(
          "estimator must have x, vx, y and vy among the states of each model, got " +
          names_of(rows_of(motion.layout())));
  });
  warn_of_steps(mixture, "the steps of a tracker, which are those of its scans and plots");
  return mixture;
}

/// Rejects a number that is not finite or beyond `kLargestInput`.
inline void require_in_range(const char* name, double value) {
  require(in_range(value), name, "finite and at most 1e9 in magnitude", value);
}

/// Copies of the tracks for which `is_wanted` holds, older ones first: at `time_s`, or each at the
/// time of its estimate.
template <class Track, class Tracker, class IsWanted>
std::vector<Track> tracks_at(const Tracker& tracker, const std::optional<double>& time_s,
                             const IsWanted& is_wanted) {
  if (time_s) require_finite("time_s", *time_s);
  std::vector<Track> tracks;
  tracker.for_each([&](const Track& track) {
    if (!is_wanted(track)) return;
    Track& copy = tracks.emplace_back(track);
    copy.time_s = time_s.value_or(track.time_s);
    copy.kinematics = tracker.kinematics_at(track, copy.time_s);
  });
  return tracks;
}

/// (n, K), what `of_modes(estimator)` gives for the K modes of each track.
template <class Tracker, class Track, class OfModes>
py::array_t<double> of_each_mode(const Tracker& tracker, const std::vector<Track>& tracks,
                                 const OfModes& of_modes) {
  const py::ssize_t modes = tracker.prototype().mode_probability().size();
  py::array_t<double> table({static_cast<py::ssize_t>(tracks.size()), modes});
  double* to = table.mutable_data();
  for (const Track& track : tracks) {
    const auto& numbers = of_modes(tracker.estimator_of(track));
    to = std::copy_n(numbers.data(), modes, to);
  }
  return table;
}

/// Adds save, restore, radar and config to the class of a tracker.
template <class AnyTracker>
void define_keeping(py::class_<AnyTracker>& type, const char* save_doc) {
  type.def(
          "save",
          [](const AnyTracker& tracker) {
            return to_bytes(tracker.visit([](const auto& one) { return one.save(); }));
          },
          save_doc)
      .def(
          "restore",
          [](AnyTracker& tracker, const py::bytes& state) {
            if (!tracker.visit([&](auto& one) { return one.restore(bytes_of(state)); }))
              throw py::value_error("state was not saved by a tracker with the same settings");
          },
          py::arg("state"), "Continue bit for bit from the saved tracker.")
      .def_property_readonly(
          "radar",
          [](const AnyTracker& tracker) {
            return tracker.visit([](const auto& one) { return Radar(one.radar()); });
          },
          "The radar it was made for, the first of several.")
      .def_property_readonly(
          "config",
          [](const AnyTracker& tracker) {
            return tracker.visit(
                [](const auto& one) { return std::decay_t<decltype(one.config())>(one.config()); });
          },
          "Its settings.");
}

}  // namespace wakeline::python
