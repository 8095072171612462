// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/track/strobe_tracker.hpp"

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "estimators.hpp"
#include "support/fields.hpp"
#include "support/thread_lock.hpp"
#include "support/types.hpp"
#include "support/video.hpp"
#include "trackers.hpp"

namespace wakeline::python {

void define_strobe_tracker(py::module_& track);

namespace {

using LockedStrobeTracker = LockedVariant<StrobeTracker<AnyEstimator, std::uint8_t>,
                                          StrobeTracker<AnyEstimator, std::uint16_t>>;

/// A strobe tracker with any estimator, on video of 8 or 16 bits.
class AnyStrobeTracker : public LockedStrobeTracker {
 public:
  AnyStrobeTracker(const Radar& radar, const StrobeTrackerConfig& config,
                   const AnyEstimator& estimator, const LandMask& land, int bits)
      : LockedStrobeTracker(bits == 8 ? Variant(StrobeTracker<AnyEstimator, std::uint8_t>(
                                            radar, config, estimator, land))
                                      : Variant(StrobeTracker<AnyEstimator, std::uint16_t>(
                                            radar, config, estimator, land))) {}

  template <class Amplitude>
  StrobeTracker<AnyEstimator, Amplitude>& of_amplitude() {
    if (auto* tracker = std::get_if<StrobeTracker<AnyEstimator, Amplitude>>(&object_))
      return *tracker;
    throw py::value_error(sizeof(Amplitude) == 1
                              ? "amplitude must be of uint16 as the tracker, got uint8"
                              : "amplitude must be of uint8 as the tracker, got uint16 (see bits)");
  }
};

/// What was found in strobes, as arrays.
struct PyReadings {
  py::array_t<std::int64_t> track_id, cells, echoes;
  py::array_t<double> time_s, predicted_m, radius_m, range_m, bearing_rad, covariance, position_m;
  std::vector<std::string> status;
  py::array_t<bool> touches_edge, fills, shared, cut;
  std::vector<Event> events;
  std::int64_t rejected_sweeps;
};

PyReadings to_table(const std::vector<StrobeReading>& readings, std::vector<Event> events,
                    std::int64_t rejected_sweeps) {
  using R = StrobeReading;
  std::vector<std::string> status;
  for (const R& reading : readings) status.emplace_back(to_string(reading.echo.status));
  const auto numbers = [&](const auto& value) { return column_of<double>(readings, value); };
  const auto counts = [&](const auto& value) { return column_of<std::int64_t>(readings, value); };
  const auto truths = [&](const auto& value) { return column_of<bool>(readings, value); };
  return {counts([](const R& r) { return r.track_id; }),
          counts([](const R& r) { return r.echo.cells; }),
          counts([](const R& r) { return r.echo.echoes; }),
          numbers([](const R& r) { return r.time_s; }),
          vectors_of<2>(readings, [](const R& r) { return r.predicted_m; }),
          numbers([](const R& r) { return r.radius_m; }),
          numbers([](const R& r) { return r.echo.range_m; }),
          numbers([](const R& r) { return r.echo.bearing_rad; }),
          matrices_of<2>(
              readings, [](const R& r) -> const auto& { return r.echo.covariance; }),
          vectors_of<2>(readings, [](const R& r) { return r.position_m.mean; }),
          std::move(status),
          truths([](const R& r) { return r.echo.touches_edge; }),
          truths([](const R& r) { return r.fills; }),
          truths([](const R& r) { return r.echo.shared; }),
          truths([](const R& r) { return r.echo.cut; }),
          std::move(events),
          rejected_sweeps};
}

/// Tracks with their next strobes, as arrays.
struct PyStrobeTracks {
  py::array_t<std::int64_t> track_id, hits, misses;
  std::vector<std::string> status;
  py::array_t<double> time_s, mean, covariance, mode_probability, nis, strobe_m, strobe_radius_m,
      strobe_time_s;
};

template <class Tracker>
PyStrobeTracks tracks(const Tracker& tracker, const std::optional<double>& time_s, bool tentative) {
  using T = StrobeTrack;
  const std::vector<StrobeTrack> wanted = tracks_at<StrobeTrack>(
      tracker, time_s, [&](const StrobeTrack& track) { return tentative || track.confirmed(); });
  const auto numbers = [&](const auto& value) { return column_of<double>(wanted, value); };
  const auto counts = [&](const auto& value) { return column_of<std::int64_t>(wanted, value); };
  std::vector<std::string> status;
  for (const StrobeTrack& track : wanted) status.emplace_back(status_name(track.status));
  return {counts([](const T& t) { return t.id; }),
          counts([](const T& t) { return t.hits; }),
          counts([](const T& t) { return t.misses; }),
          std::move(status),
          numbers([](const T& t) { return t.time_s; }),
          vectors_of<4>(wanted, [](const T& t) { return t.kinematics.mean; }),
          matrices_of<4>(
              wanted, [](const T& t) -> const auto& { return t.kinematics.covariance; }),
          of_each_mode(tracker, wanted, [](const auto& one) { return one.mode_probability(); }),
          numbers([](const T& t) { return t.nis; }),
          vectors_of<2>(wanted, [](const T& t) { return t.strobe.centre_m; }),
          numbers([](const T& t) { return t.strobe.radius_m; }),
          numbers([](const T& t) { return t.strobe.time_s; })};
}

/// Own ship at each of some times: given as one number or one for each.
struct OwnPositions {
  DoubleArray north_m, east_m;

  OwnPositions(const py::object& north, const py::object& east, py::ssize_t count)
      : north_m(column("own_north_m", north, count)), east_m(column("own_east_m", east, count)) {}

  /// Needs no Python.
  [[nodiscard]] OwnShip at(py::ssize_t k) const {
    return {.north_m = north_m.data()[k], .east_m = east_m.data()[k]};
  }
};

PyReadings process_sweeps(AnyStrobeTracker& tracker, const py::object& video,
                          const py::object& north_m, const py::object& east_m) {
  return with_video(video, [&]<class Amplitude>(const Video<Amplitude>& sweeps) {
    const OwnPositions own(north_m, east_m, sweeps.size());
    const auto hold = tracker.lock();
    auto& one = tracker.of_amplitude<Amplitude>();
    std::vector<StrobeReading> readings;
    std::vector<Event> events;
    std::int64_t rejected_sweeps = 0;
    {
      const py::ssize_t count = sweeps.size();
      const py::gil_scoped_release release;
      for (py::ssize_t k = 0; k < count; ++k) {
        const StrobeReport report = one.process(sweeps.sweep(k), own.at(k));
        rejected_sweeps += rejected(report.status);
        readings.insert(readings.end(), report.readings.begin(), report.readings.end());
        events.insert(events.end(), report.events.begin(), report.events.end());
      }
    }
    return to_table(readings, std::move(events), rejected_sweeps);
  });
}

int acquire(AnyStrobeTracker& tracker, const py::object& plots, const py::object& north_m,
            const py::object& east_m) {
  const auto number = [&](const char* name) { return plots.attr(name).cast<DoubleArray>(); };
  const DoubleArray time_s = number("time_s"), range_m = number("range_m"),
                    bearing_rad = number("bearing_rad");
  const py::ssize_t count = time_s.size();
  const OwnPositions own(north_m, east_m, count);
  int started = 0;
  for (py::ssize_t k = 0; k < count; ++k) {
    const VideoPlot plot{
        .time_s = time_s.at(k), .range_m = range_m.at(k), .bearing_rad = bearing_rad.at(k)};
    started += tracker.visit([&](auto& one) { return one.acquire({&plot, 1}, own.at(k)); });
  }
  return started;
}

void define_tables(py::module_& m) {
  py::class_<PyReadings> readings(m, "StrobeReadings",
                                  "What was found in the strobes that the beam has passed.");
  define_pickle(readings, &PyReadings::track_id, &PyReadings::cells, &PyReadings::echoes,
                &PyReadings::time_s, &PyReadings::predicted_m, &PyReadings::radius_m,
                &PyReadings::range_m, &PyReadings::bearing_rad, &PyReadings::covariance,
                &PyReadings::position_m, &PyReadings::status, &PyReadings::touches_edge,
                &PyReadings::fills, &PyReadings::shared, &PyReadings::cut, &PyReadings::events,
                &PyReadings::rejected_sweeps);
  readings
      .def_readonly("track_id", &PyReadings::track_id,
                    "(n,) negative of a tentative track, positive from its confirmation on")
      .def_readonly("time_s", &PyReadings::time_s,
                    "(n,) when the beam passed the echo, or the center without one")
      .def_readonly("predicted_m", &PyReadings::predicted_m,
                    "(n, 2) center of the strobe, north and east")
      .def_readonly("radius_m", &PyReadings::radius_m, "(n,) of the strobe")
      .def_readonly("status", &PyReadings::status, "of the echo, as of `StrobeEcho`")
      .def_readonly("range_m", &PyReadings::range_m,
                    "(n,) of the centroid, as the radar measures it; NaN without an echo")
      .def_readonly("bearing_rad", &PyReadings::bearing_rad, "(n,) the same")
      .def_readonly("covariance", &PyReadings::covariance, "(n, 2, 2) of range and bearing")
      .def_readonly("position_m", &PyReadings::position_m,
                    "(n, 2) of the centroid, north and east; NaN without an echo")
      .def_readonly("cells", &PyReadings::cells, "(n,) measured")
      .def_readonly("echoes", &PyReadings::echoes,
                    "(n,) separate echoes in the strobe, without those of other strobes")
      .def_readonly("touches_edge", &PyReadings::touches_edge,
                    "(n,) the echo extends beyond the strobe")
      .def_readonly("fills", &PyReadings::fills, "(n,) the echo fills the strobe")
      .def_readonly("shared", &PyReadings::shared,
                    "(n,) a part of the echo belongs to the strobe of another track")
      .def_readonly("cut", &PyReadings::cut, "(n,) part of the strobe is outside the picture")
      .def_readonly("events", &PyReadings::events, "list of Event")
      .def_readonly("rejected_sweeps", &PyReadings::rejected_sweeps,
                    "sweeps that are invalid, too long, repeated or before the last one")
      .def("__len__", [](const PyReadings& r) { return r.track_id.size(); })
      .def("__repr__", [](const PyReadings& r) {
        return "<StrobeReadings: " + many(r.track_id.size(), "strobe") + ", " +
               many(static_cast<py::ssize_t>(r.events.size()), "event") + ">";
      });

  py::class_<PyStrobeTracks> table(m, "StrobeTrackTable",
                                   "Tracks with their next strobes, older ones first.");
  define_pickle(table, &PyStrobeTracks::track_id, &PyStrobeTracks::hits, &PyStrobeTracks::misses,
                &PyStrobeTracks::status, &PyStrobeTracks::time_s, &PyStrobeTracks::mean,
                &PyStrobeTracks::covariance, &PyStrobeTracks::mode_probability,
                &PyStrobeTracks::nis, &PyStrobeTracks::strobe_m, &PyStrobeTracks::strobe_radius_m,
                &PyStrobeTracks::strobe_time_s);
  table.def_readonly("track_id", &PyStrobeTracks::track_id, "(k,)")
      .def_readonly("status", &PyStrobeTracks::status, "tentative, confirmed or coasting")
      .def_readonly("time_s", &PyStrobeTracks::time_s, "(k,) of the belief")
      .def_readonly("mean", &PyStrobeTracks::mean, "(k, 4) [x, vx, y, vy]")
      .def_readonly("covariance", &PyStrobeTracks::covariance, "(k, 4, 4)")
      .def_readonly("mode_probability", &PyStrobeTracks::mode_probability, "(k, K)")
      .def_readonly("nis", &PyStrobeTracks::nis, "(k,) of the echo; NaN without one")
      .def_readonly("hits", &PyStrobeTracks::hits, "(k,) turns with an echo")
      .def_readonly("misses", &PyStrobeTracks::misses, "(k,) consecutive turns without an echo")
      .def_readonly("strobe_m", &PyStrobeTracks::strobe_m,
                    "(k, 2) center of the next strobe, north and east")
      .def_readonly("strobe_radius_m", &PyStrobeTracks::strobe_radius_m, "(k,)")
      .def_readonly("strobe_time_s", &PyStrobeTracks::strobe_time_s,
                    "(k,) when the beam will pass its center")
      .def("__len__", [](const PyStrobeTracks& t) { return t.track_id.size(); })
      .def("__repr__", [](const PyStrobeTracks& t) {
        return "<StrobeTrackTable: " + many(t.track_id.size(), "track") + ">";
      });
}

}  // namespace

void define_strobe_tracker(py::module_& m) {
  define_struct<StrobeTrackerConfig>(m, "StrobeTrackerConfig",
                                     "The rules by which the tracks of a StrobeTracker live.",
                                     {.writable = true})
      .def("next_radius_m", &StrobeTrackerConfig::next_radius_m, py::arg("radius_m"),
           py::arg("seen"),
           "Radius in metres of the next strobe after one with an echo, or without.");
  define_tables(m);

  py::class_<AnyStrobeTracker> tracker(m, "StrobeTracker",
                                       R"(Tracks vessels on radar video, each by a strobe.

A vessel is acquired by the operator (`designate`) or from extracted plots (`acquire`). In each turn
a strobe is laid on the picture around the predicted position; as soon as the beam has passed it, the
centroid of the amplitudes inside updates the estimator. `lost_after` turns in a row without an echo
end the track.

The strobe is a circle of `radius_m`. It grows by `growth` after a turn without an echo, up to
`max_radius_m`, and shrinks by `shrinkage` after one with an echo. The first strobe of a track is
larger by the distance at the speed limit until the beam comes. Where strobes overlap, a cell belongs
to the nearest center: an echo of which a strobe has less than `least_share` of the weight belongs to
the other strobe, and one of which both have more is shared. A tentative track claims nothing from a
confirmed one.

Parameters
----------
radar : Radar
config : StrobeTrackerConfig, optional
estimator : Imm, AdaptiveGridImm, SwitchingGridImm, LikelyModelSetImm, ModeHistory, FuzzyAlphaBeta or BayesianAlphaBeta, optional
    Default: BayesianAlphaBeta.
land : LandMask, optional
    Areas whose cells are empty.
bits : {8, 16}
    Of the amplitudes.

Raises
------
ValueError
    When a setting is invalid.

References
----------
Grinyak, Trofimov, "Multi-model tracking of moving vessels with a fuzzy criterion of maneuver
detection". Arbitration, radii and acquisition are ours.)");
  tracker
      .def(py::init([](const Radar& radar, const StrobeTrackerConfig& config,
                       const py::object& estimator, const std::optional<LandMask>& land, int bits) {
             if (bits != 8 && bits != 16)
               throw py::value_error("bits must be 8 or 16, got " + std::to_string(bits));
             const AnyEstimator any =
                 estimator.is_none() ? AnyEstimator(BayesianAlphaBeta<>{}) : to_mixture(estimator);
             return AnyStrobeTracker(radar, config, any, land.value_or(LandMask()), bits);
           }),
           py::arg("radar"), py::arg_v("config", StrobeTrackerConfig{}, "StrobeTrackerConfig()"),
           py::arg("estimator") = py::none(), py::kw_only(), py::arg("land") = py::none(),
           py::arg("bits") = 8)
      .def("process", &process_sweeps, py::arg("video"), py::kw_only(),
           py::arg("own_north_m") = 0.0, py::arg("own_east_m") = 0.0,
           R"(Process the sweeps of a video, which continue the previous ones.

Parameters
----------
video : RadarVideo
    Any number of sweeps; the antenna turns clockwise.
own_north_m, own_east_m : float or (N,) arrays
    Position of the radar at each sweep.

Returns
-------
StrobeReadings
    The strobes that the beam has passed, in the order of time.

Raises
------
ValueError
    When the amplitudes have other bits than the tracker, or a shape does not fit.)")
      .def("acquire", &acquire, py::arg("plots"), py::kw_only(), py::arg("own_north_m") = 0.0,
           py::arg("own_east_m") = 0.0,
           R"(Start tentative tracks at plots that are neither in a strobe nor in an excluded area.

Parameters
----------
plots : VideoPlots
    Of the sweeps just processed: anything with `time_s`, `range_m` and `bearing_rad`.
own_north_m, own_east_m : float or (n,) arrays
    Position of the radar at each plot.

Returns
-------
int
    Number of tracks started.)")
      .def(
          "designate",
          [](AnyStrobeTracker& tracker, double time_s, double north_m, double east_m,
             double position_std_m, double own_north_m, double own_east_m) {
            require_finite("time_s", time_s);
            require_in_range("north_m", north_m);
            require_in_range("east_m", east_m);
            require_positive("position_std_m", position_std_m);
            require_in_range("position_std_m", position_std_m);
            require_in_range("own_north_m", own_north_m);
            require_in_range("own_east_m", own_east_m);
            const OwnShip own{.north_m = own_north_m, .east_m = own_east_m};
            return tracker.visit([&](auto& one) {
              return one.designate(time_s, north_m, east_m, position_std_m, own);
            });
          },
          py::arg("time_s"), py::arg("north_m"), py::arg("east_m"),
          py::arg("position_std_m") = 20.0, py::kw_only(), py::arg("own_north_m") = 0.0,
          py::arg("own_east_m") = 0.0,
          R"(Start a confirmed track on an operator's designation.

Parameters
----------
time_s : float
    At most a period after the last sweep.
north_m, east_m, position_std_m : float
own_north_m, own_east_m : float
    Position of the radar.

Returns
-------
int
    The track's number, or 0 if there is no room or the time is too late.

Raises
------
ValueError
    When a number is not finite or beyond 1e9, or the standard deviation not positive.)")
      .def(
          "tracks",
          [](const AnyStrobeTracker& tracker, const std::optional<double>& time_s, bool tentative) {
            return tracker.visit([&](const auto& one) { return tracks(one, time_s, tentative); });
          },
          py::arg("time_s") = py::none(), py::arg("tentative") = false,
          "The confirmed and coasting tracks (with `tentative` all), a StrobeTrackTable: each as "
          "of "
          "when the beam passed it, or at `time_s`: predicted to it, or moved back to it at "
          "constant velocity.")
      .def(
          "drop",
          [](AnyStrobeTracker& tracker, std::int64_t id) {
            return tracker.visit([&](auto& one) { return one.drop(id); });
          },
          py::arg("track_id"), "End a track; False if no track has that number.")
      .def(
          "set_land",
          [](AnyStrobeTracker& tracker, const LandMask& land) {
            tracker.visit([&](auto& one) { one.set_land(land); });
          },
          py::arg("land"), "Replace the excluded areas, from the next sweep on.")
      .def("__len__",
           [](const AnyStrobeTracker& tracker) {
             return tracker.visit([](const auto& one) { return one.size(); });
           })
      .def("__repr__", [](const AnyStrobeTracker& tracker) {
        return "<StrobeTracker: " +
               many(tracker.visit([](const auto& one) { return one.size(); }), "track") + ">";
      });
  define_keeping(tracker,
                 "The complete state without the excluded areas as bytes, for a tracker with the "
                 "same settings on the same kind of machine.");
}

}  // namespace wakeline::python
