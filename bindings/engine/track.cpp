// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>
#include <optional>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "any_tracker.hpp"
#include "estimators.hpp"
#include "support/fields.hpp"
#include "support/types.hpp"
#include "trackers.hpp"
#include "wakeline/eval/consistency.hpp"

namespace wakeline::python {

void define_calibration(py::module_& track);     // calibration.cpp
void define_late_window(py::module_& track);     // late_window.cpp
void define_strobe_tracker(py::module_& track);  // strobe_tracker.cpp

namespace {

template <std::size_t Index>
using VesselFilter = std::decay_t<decltype(std::declval<const VesselImm::All&>().filter<Index>())>;
using VesselModes = std::make_index_sequence<VesselImm::kModels>;

/// The same over filters composed at run time.
PyEstimator<AnyImm> as_any_imm(const VesselImm& vessel) {
  const VesselImm::All& imm = vessel.all();
  const auto filters = [&]<std::size_t... Index>(std::index_sequence<Index...>) {
    return std::vector{AnyFilter(imm.filter<Index>())...};
  };
  AnyImm any(ModeChain<kRuntimeModes>(imm.chain()), AnyFilterBank(filters(VesselModes{})));
  any.set_initial_mode_probability(
      ModeVector<double, kRuntimeModes>(imm.initial_mode_probability()));
  return any;
}

PyEstimator<AnyImm> any_vessel_imm(const Radar& radar, const VesselModels& models) {
  return as_any_imm(vessel_imm(radar, models));
}

/// The reverse, of an estimator that is made like it.
std::optional<VesselImm> as_vessel_imm(const AnyImm& any) {
  if (any.bank().size() != VesselImm::kModels || !any.chain().continuous()) return std::nullopt;
  return [&]<std::size_t... Index>(std::index_sequence<Index...>)->std::optional<VesselImm> {
    const std::tuple filters(
        std::get_if<VesselFilter<Index>>(&any.bank().filter(int(Index)).variant())...);
    if (((std::get<Index>(filters) == nullptr) || ...)) return std::nullopt;
    VesselImm::All imm(ModeChain<VesselImm::kModels>(any.chain()),
                       VesselFilter<Index>(std::get<Index>(filters)->motion())...);
    imm.set_initial_mode_probability(any.initial_mode_probability());
    return VesselImm(imm);
  }
  (VesselModes{});
}

/// A tracker with an estimator given by hand.
AnyTracker tracker_with(std::span<const Radar> radars, const TrackerConfig& config,
                        const py::object& estimator, const LateWindowConfig* window) {
  const AnyEstimator& any = to_mixture(estimator);
  if (const auto* imm = std::get_if<AnyImm>(&any.variant()))
    if (const auto vessel = as_vessel_imm(*imm)) return AnyTracker(radars, config, *vessel, window);
  return AnyTracker(radars, config, any, window);
}

py::object python_estimator(const VesselImm& imm) { return py::cast(as_any_imm(imm)); }
py::object python_estimator(const AnyEstimator& estimator) { return to_python(estimator); }

template <class Tracker>
Radars radars_of(const Tracker& tracker) {
  if (tracker.radar_numbers() == 1) return tracker.radar();
  std::vector<std::optional<Radar>> radars;
  for (int number = 0; number < tracker.radar_numbers(); ++number)
    radars.push_back(tracker.has_radar(number) ? std::optional(tracker.radar(number))
                                               : std::nullopt);
  return radars;
}

}  // namespace

Arguments tracker_arguments(const AnyTracker& any) {
  return any.visit([](const auto& tracker) {
    return Arguments()
        .with("radar", radars_of(tracker))
        .with("config", TrackerConfig(tracker.config()))
        .with("estimator", python_estimator(tracker.prototype()));
  });
}

AnyTracker make_tracker(const Radars& radars, const TrackerConfig& config,
                        const VesselModels& models, const py::object& estimator,
                        const LateWindowConfig* window) {
  if (const auto* one = std::get_if<Radar>(&radars))
    return make_tracker(std::vector<std::optional<Radar>>{*one}, config, models, estimator, window);
  const auto& wanted = std::get<std::vector<std::optional<Radar>>>(radars);
  std::vector<Radar> list;
  const auto known = std::find_if(wanted.begin(), wanted.end(),
                                  [](const auto& radar) { return radar.has_value(); });
  require(known != wanted.end(), "radar", "one Radar at least", static_cast<int>(wanted.size()));
  for (const auto& radar : wanted) list.push_back(radar.value_or(**known));
  AnyTracker tracker = estimator.is_none()
                           ? AnyTracker(list, config, vessel_imm(list.front(), models), window)
                           : tracker_with(list, config, estimator, window);
  for (std::size_t k = 0; k < wanted.size(); ++k)
    if (!wanted[k]) tracker.visit([&](auto& one) { (void)one.remove_radar(static_cast<int>(k)); });
  return tracker;
}

namespace {

/// Raises ValueError unless the tracker has a radar of that number.
void require_radar(const AnyTracker& tracker, int radar) {
  require(tracker.visit([&](const auto& one) { return one.has_radar(radar); }), "radar",
          "the number of a radar of this tracker", radar);
}

/// Raises FilterError where a scan of that time is rejected as too far ahead.
void require_time(const AnyTracker& tracker, const char* what, double time_s, int radar = 0) {
  const double latest_s = tracker.visit([](const auto& one) { return one.latest_time_s(); });
  const double true_s =
      tracker.visit([&](const auto& one) { return one.radar(radar).true_time_s(time_s); });
  if (std::isfinite(time_s) && true_s > latest_s)
    throw FilterError(std::string(what) + ": time_s must be at most " + std::to_string(latest_s) +
                      ", an hour after the last scan, got " + std::to_string(time_s));
}

/// Plots from columns; `own(k)` is own ship of each.
template <class Own>
std::vector<Plot> plots_of(double time_s, const DoubleArray& range_m,
                           const DoubleArray& bearing_rad, const py::object& plot_time_s,
                           const std::optional<DoubleArray>& covariance, const Own& own) {
  require_shape(range_m.ndim() == 1, "range_m", "(n,)", range_m);
  const py::ssize_t count = range_m.shape(0);
  const DoubleArray bearing = column("bearing_rad", bearing_rad, count);
  const DoubleArray time = column(
      "plot_time_s", plot_time_s.is_none() ? py::object(py::float_(time_s)) : plot_time_s, count);
  if (covariance)
    require_shape(covariance->ndim() == 3 && covariance->shape(0) == count &&
                      covariance->shape(1) == 2 && covariance->shape(2) == 2,
                  "covariance", shape_text({count, 2, 2}), *covariance);
  std::vector<Plot> plots(static_cast<std::size_t>(count));
  for (std::size_t k = 0; k < plots.size(); ++k) {
    plots[k] = {time.data()[k], range_m.data()[k], bearing.data()[k], own(k)};
    if (covariance)
      plots[k].covariance = Eigen::Map<const Eigen::Matrix<double, 2, 2, Eigen::RowMajor>>(
          covariance->data() + 4 * k);
  }
  return plots;
}

/// The report of `process` over so many plots.
template <class Process>
PyReport reported(const AnyTracker& tracker, std::size_t plots, const char* what,
                  const Process& process) {
  ScanReport report;
  {
    const py::gil_scoped_release release;
    report = process();
  }
  if (report.status != Status::kNegativeTimeStep)
    require_ok(report.status, what);
  else if (!tracker.has_window())  // which counts what is too late
    throw FilterError(std::string(what) +
                      ": a step backwards: time_s must be at least that of the last scan of this "
                      "radar, at most a period before that of another one, and sectors clockwise");
  PyReport result{py::array_t<std::int64_t>(static_cast<py::ssize_t>(plots)),
                  {report.events.begin(), report.events.end()},
                  report.rejected_plots};
  std::fill_n(result.plot_track_id.mutable_data(), plots, 0);
  std::copy(report.plot_track_id.begin(), report.plot_track_id.end(),
            result.plot_track_id.mutable_data());
  return result;
}

PyReport process(AnyTracker& tracker, double time_s, const DoubleArray& range_m,
                 const DoubleArray& bearing_rad, const py::object& plot_time_s,
                 const py::object& own_north_m, const py::object& own_east_m,
                 double heading_std_rad, double own_position_std_m,
                 const std::optional<DoubleArray>& covariance) {
  require_shape(range_m.ndim() == 1, "range_m", "(n,)", range_m);
  require_not_negative("heading_std_rad", heading_std_rad);
  require_not_negative("own_position_std_m", own_position_std_m);
  const DoubleArray north = column("own_north_m", own_north_m, range_m.shape(0));
  const DoubleArray east = column("own_east_m", own_east_m, range_m.shape(0));
  const std::vector<Plot> plots =
      plots_of(time_s, range_m, bearing_rad, plot_time_s, covariance, [&](std::size_t k) {
        return OwnShip{.north_m = north.data()[k],
                       .east_m = east.data()[k],
                       .position_std_m = own_position_std_m,
                       .heading_std_rad = heading_std_rad};
      });
  const auto hold = tracker.lock();  // the report is the tracker's memory
  require_radar(tracker, 0);
  require_time(tracker, "process", time_s);
  return reported(tracker, plots.size(), "process", [&] {
    return tracker.visit([&](auto& one) { return one.process(time_s, plots); });
  });
}

PyReport sector(AnyTracker& tracker, int radar, double from_rad, double to_rad, double time_s,
                const DoubleArray& range_m, const DoubleArray& bearing_rad,
                const py::object& plot_time_s, const OwnShip& own,
                const std::optional<DoubleArray>& covariance) {
  require_finite("from_rad", from_rad);
  require_finite("to_rad", to_rad);
  require(!std::isnan(Beam::width_rad(from_rad, to_rad)), "to_rad",
          "from nothing to a turn after from_rad, clockwise", to_rad);
  own.validate();
  std::vector<Plot> plots = plots_of(time_s, range_m, bearing_rad, plot_time_s, covariance,
                                     [&](std::size_t) { return own; });
  for (Plot& plot : plots) {  // each as of its own time; a later one counts as of the sector's
    const double ahead_s = std::min(plot.time_s - time_s, 0.0);
    plot.own.north_m += ahead_s * own.vnorth_mps;
    plot.own.east_m += ahead_s * own.veast_mps;
  }
  const auto hold = tracker.lock();  // the report is the tracker's memory
  require_radar(tracker, radar);
  require_time(tracker, "sector", time_s, radar);
  const Sector part{radar, from_rad, to_rad, time_s, plots, own};
  return reported(tracker, plots.size(), "sector",
                  [&] { return tracker.visit([&](auto& one) { return one.sector(part); }); });
}

/// A velocity of which both components are given, or none.
std::optional<Vec<double, 2>> velocity_of(const std::optional<double>& vnorth_mps,
                                          const std::optional<double>& veast_mps,
                                          double velocity_std_mps) {
  if (vnorth_mps.has_value() != veast_mps.has_value())
    throw py::value_error("vnorth_mps and veast_mps must be given together");
  if (!vnorth_mps) return std::nullopt;
  require_in_range("vnorth_mps", *vnorth_mps);
  require_in_range("veast_mps", *veast_mps);
  require_positive("velocity_std_mps", velocity_std_mps);
  return Vec<double, 2>(*vnorth_mps, *veast_mps);
}

PyReportResult take_report(AnyTracker& tracker, double time_s, std::string_view identity,
                           double north_m, double east_m, double position_std_m,
                           const std::optional<double>& vnorth_mps,
                           const std::optional<double>& veast_mps, double velocity_std_mps,
                           std::string_view source) {
  const auto require_text = [](const char* name, std::string_view text, std::size_t most) {
    if (text.empty() || text.size() > most || !is_utf8(text))
      throw py::value_error(std::string(name) + " must be 1 to " + std::to_string(most) +
                            " bytes of UTF-8, got " + std::to_string(text.size()));
  };
  require_text("identity", identity, PositionReport::kMostIdentity);
  require_text("source", source, PositionReport::kMostSource);
  require_finite("time_s", time_s);
  require_in_range("north_m", north_m);
  require_in_range("east_m", east_m);
  require_positive("position_std_m", position_std_m);
  PositionReport one{.source = source,
                     .identity = identity,
                     .time_s = time_s,
                     .position_m = {north_m, east_m},
                     .position_std_m = position_std_m};
  if (const auto velocity_mps = velocity_of(vnorth_mps, veast_mps, velocity_std_mps)) {
    one.velocity_mps = *velocity_mps;
    one.velocity_std_mps = velocity_std_mps;
  }
  const auto hold = tracker.lock();  // the events are the tracker's memory
  const ReportResult result = tracker.visit([&](auto& any) { return any.report(one); });
  return {result.status, result.track_id, {result.events.begin(), result.events.end()}};
}

PyReport partial(AnyTracker& tracker, const char* what, PositionPart part, int sensor,
                 double time_s, const char* name, const DoubleArray& values, double std,
                 double false_per_unit, const OwnShip& own) {
  require_shape(values.ndim() == 1, name, "(n,)", values);
  require(sensor >= 0 && sensor < int(kMostPartialSensors), "sensor",
          ("from 0 to " + std::to_string(kMostPartialSensors - 1)).c_str(), sensor);
  require_finite("time_s", time_s);
  own.validate();
  const PartialScan scan{
      part, sensor,         time_s, {values.data(), static_cast<std::size_t>(values.shape(0))},
      std,  false_per_unit, own};
  const auto hold = tracker.lock();  // the report is the tracker's memory
  const double last_s = std::as_const(tracker).visit([](const auto& one) { return one.time_s(); });
  return reported(tracker, scan.values.size(), what, [&] {
    const ScanReport report = tracker.visit([&](auto& one) { return one.partial(scan); });
    if (report.status == Status::kNotFinite)
      throw FilterError(std::string(what) +
                        ": time_s must be at most 120 s after the last scan, at " +
                        std::to_string(last_s) + ", got " + std::to_string(time_s));
    return report;
  });
}

/// What a mean NIS and a whiteness of so many plots are within with a probability of 0.95.
struct Bounds {
  ConsistencyBounds mean_nis;
  double whiteness;
};

/// Of a number of plots, from 0; more than the last change nothing that could be seen.
const std::vector<Bounds>& bounds_by_plots() {
  constexpr double kConfidence = 0.95;
  constexpr int kMost = 100, kDof = InnovationConsistency::kMeasurements;
  static const std::vector<Bounds> all = [] {
    std::vector<Bounds> bounds;
    for (int plots = 0; plots <= kMost; ++plots) {
      const double pairs = InnovationConsistency::samples(plots - 1);
      bounds.push_back(
          {consistency_bounds(kConfidence, kDof, InnovationConsistency::samples(plots)),
           plots < 2 ? std::numeric_limits<double>::quiet_NaN()
                     : std::sqrt(chi_square_quantile(kConfidence, 1.0) / (kDof * pairs))});
    }
    return bounds;
  }();
  return all;
}

const Bounds& bounds_of(const Track& track) {
  const std::vector<Bounds>& all = bounds_by_plots();
  return all[std::min(static_cast<std::size_t>(track.consistency.plots()), all.size() - 1)];
}

template <class Estimator, class Steps>
PyTracks tracks(const Tracker<Estimator, Steps>& tracker, const std::optional<double>& time_s,
                bool tentative, bool predicted) {
  using T = Track;
  const std::vector<Track> wanted = tracks_at<Track>(
      tracker, time_s || !tracker.started() || !predicted ? time_s : tracker.time_s(),
      [&](const Track& track) { return !track.hushed && (tentative || track.active()); });
  const auto numbers = [&](const auto& value) { return column_of<double>(wanted, value); };
  const auto counts = [&](const auto& value) { return column_of<std::int64_t>(wanted, value); };
  PyTracks table{
      counts([](const T& t) { return t.id; }),
      {},
      numbers([](const T& t) { return t.time_s; }),
      vectors_of<4>(wanted, [](const T& t) { return t.kinematics.mean; }),
      matrices_of<4>(
          wanted, [](const T& t) -> const auto& { return t.kinematics.covariance; }),
      of_each_mode(tracker, wanted, [](const auto& one) { return one.mode_probability(); }),
      numbers([](const T& t) { return t.nis; }),
      numbers([](const T& t) { return t.existence; }),
      numbers([&](const T& t) { return tracker.visibility(t); }),
      py::none(),
      counts([](const T& t) { return t.hits; }),
      counts([](const T& t) { return t.misses; }),
      {},
      {},
      numbers([&](const T& t) { return tracker.identity_probability(t); }),
      numbers([&](const T& t) {
        const Identity* identity = tracker.identity_of(t);
        return identity == nullptr ? std::numeric_limits<double>::quiet_NaN() : identity->time_s;
      }),
      numbers([](const T& t) { return t.consistency.mean_nis(); }),
      vectors_of<2>(wanted,
                    [](const T& t) {
                      const ConsistencyBounds& bounds = bounds_of(t).mean_nis;
                      return Vec<double, 2>(bounds.lower, bounds.upper);
                    }),
      numbers([](const T& t) { return t.consistency.whiteness(); }),
      numbers([](const T& t) { return bounds_of(t).whiteness; })};
  for (const Track& track : wanted) {
    table.status.emplace_back(status_name(track.status));
    table.name.emplace_back(track.label());
    const Identity* identity = tracker.identity_of(track);
    table.identity.emplace_back(identity == nullptr ? "" : identity->name.data());
  }
  if constexpr (kHasTurnRates<Estimator>)
    if (tracker.prototype().turn_rates_rad_s().size() > 0)
      table.turn_rate_rad_s =
          of_each_mode(tracker, wanted, [](const auto& one) { return one.turn_rates_rad_s(); });
  return table;
}

}  // namespace

PyTracks tracks_of(const AnyTracker& any, const std::optional<double>& time_s, bool tentative,
                   bool predicted) {
  return any.visit(
      [&](const auto& tracker) { return tracks(tracker, time_s, tentative, predicted); });
}

void define_track(py::module_& parent) {
  py::module_ m = parent.def_submodule("track", "The life of tracks.");

  define_struct<Radar>(m, "Radar",
                       "What a console knows of its radar and of the vessels it looks at.",
                       {.writable = true})
      .def(
          "position",
          [](const Radar& r, double range_m, double bearing_rad, const OwnShip& own) {
            return PyGaussian::from(r.position(range_m, bearing_rad, own));
          },
          py::arg("range_m"), py::arg("bearing_rad"), py::arg_v("own", OwnShip{}, "OwnShip()"),
          "A plot from own ship as a position [north, east] with its covariance.");
  define_struct<TrackerConfig>(
      m, "TrackerConfig", "The rules by which tracks live; one set of defaults for all radars.",
      {.writable = true});
  define_struct<VesselModels>(
      m, "VesselModels", "The motion models of a tracker: of ships, of craft, and of agile craft.",
      {.writable = true})
      .def_static("ships", &VesselModels::ships, "Models of merchant ships under way.");

  m.def("vessel_imm", &any_vessel_imm, py::arg("radar"),
        py::arg_v("models", VesselModels{}, "VesselModels()"),
        "The default estimator of a tracker, where its last three models rest while they are "
        "unlikely.");

  py::class_<Event>(m, "Event", "A change of a track's status in a scan.")
      .def(py::pickle(
          [](const Event& event) {
            return py::make_tuple(int(event.kind), event.track_id, event.tentative_id, event.time_s,
                                  int(event.reason), std::string(event.identity.data()));
          },
          [](const py::tuple& fields) {
            const auto kind = fields[0].cast<int>();
            const auto reason = fields[4].cast<int>();
            if (kind < int(TrackEvent::kStarted) || kind > int(TrackEvent::kIdentityShared) ||
                reason < int(LossReason::kNone) || reason > int(LossReason::kCorrected))
              throw py::value_error("state is not that of an event");
            Event event{TrackEvent(kind), fields[1].cast<std::int64_t>(),
                        fields[2].cast<std::int64_t>(), fields[3].cast<double>(),
                        LossReason(reason)};
            const auto identity = fields[5].cast<std::string>();
            std::copy_n(identity.begin(), std::min(identity.size(), event.identity.size() - 1),
                        event.identity.begin());
            return event;
          }))
      .def_property_readonly(
          "kind", [](const Event& event) { return to_string(event.kind); },
          "started, confirmed, coasting or lost; full where max_tracks is reached, again only when "
          "there has been room in between; identified or identity_lost where a track is believed "
          "to "
          "be of a vessel that reports, or no longer; identity_disagrees where a report of it is "
          "far from its track, of another velocity or contradicts those before, identity_jumps "
          "where it is farther from the one before than a "
          "vessel "
          "runs, identity_shared where two vessels report from one track")
      .def_property_readonly(
          "identity", [](const Event& event) { return std::string(event.identity.data()); },
          "of the vessel that reports, in the events of one; else empty")
      .def_property_readonly(
          "reason", [](const Event& event) { return to_string(event.reason); },
          "why a track was lost: missed (without a plot for too long), doubtful (a tentative track "
          "whose target hardly exists), too_fast (above the speed limit), uncertain (its position "
          "is not known well enough), duplicate (a senior track follows the same target), "
          "displaced (a tentative track that made room), failed (the estimator cannot follow the "
          "measurements) or corrected (with late data there is no such track); empty for other "
          "events")
      .def_readonly("track_id", &Event::track_id, "0 of full")
      .def_readonly("tentative_id", &Event::tentative_id,
                    "the negative number before confirmation; 0 for a designated track")
      .def_readonly("time_s", &Event::time_s, "of the scan")
      .def("__repr__", [](const Event& event) {
        const std::string reason = to_string(event.reason);
        return "Event(kind=" + std::string(to_string(event.kind)) +
               ", track_id=" + std::to_string(event.track_id) +
               (reason.empty() ? ")" : ", reason=" + reason + ")");
      });
  py::class_<PyReport> report(m, "ScanReport", "Result of processing a scan.");
  define_pickle(report, &PyReport::plot_track_id, &PyReport::events, &PyReport::rejected_plots);
  report
      .def_readonly(
          "plot_track_id", &PyReport::plot_track_id,
          "(n,) the track that each plot most likely belongs to; negative for a tentative "
          "one, 0 for none")
      .def_readonly("events", &PyReport::events, "of this scan, each an Event")
      .def_readonly("rejected_plots", &PyReport::rejected_plots,
                    "plots that are not finite or out of range, have a negative range, a bearing "
                    "too large to be an angle "
                    "or a time far from the scan's, or exceed max_plots")
      .def("__repr__", [](const PyReport& r) {
        return "<ScanReport: " + many(r.plot_track_id.size(), "plot") + ", " +
               std::to_string(r.rejected_plots) + " rejected, " +
               many(static_cast<py::ssize_t>(r.events.size()), "event") + ">";
      });
  py::class_<PyReportResult> report_result(m, "ReportResult", "Result of a vessel's report.");
  define_pickle(report_result, &PyReportResult::status, &PyReportResult::track_id,
                &PyReportResult::events);
  report_result
      .def_readonly("status", &PyReportResult::status,
                    "ok where it has updated or started a track; gated where it has not; "
                    "negative_time_step or not_finite where its time is not of now")
      .def_readonly("track_id", &PyReportResult::track_id,
                    "of the track that its vessel is believed to be; 0 without one")
      .def_readonly("events", &PyReportResult::events, "of this report, each an Event")
      .def("__repr__", [](const PyReportResult& r) {
        return "<ReportResult: " + std::string(to_string(r.status)) + ", track " +
               std::to_string(r.track_id) + ">";
      });
  py::class_<PyTracks> table(m, "TrackTable", "Tracks as arrays, older ones first.");
  define_pickle(table, &PyTracks::track_id, &PyTracks::status, &PyTracks::time_s, &PyTracks::mean,
                &PyTracks::covariance, &PyTracks::mode_probability, &PyTracks::nis,
                &PyTracks::existence, &PyTracks::visibility, &PyTracks::turn_rate_rad_s,
                &PyTracks::hits, &PyTracks::misses, &PyTracks::name, &PyTracks::identity,
                &PyTracks::identity_probability, &PyTracks::identity_time_s, &PyTracks::mean_nis,
                &PyTracks::mean_nis_bounds, &PyTracks::whiteness, &PyTracks::whiteness_bound);
  table.def_readonly("track_id", &PyTracks::track_id, "(k,)")
      .def_readonly("status", &PyTracks::status, "tentative, confirmed, coasting or held")
      .def_readonly("time_s", &PyTracks::time_s, "(k,) of the belief")
      .def_readonly("mean", &PyTracks::mean, "(k, 4) [x, vx, y, vy]")
      .def_readonly("covariance", &PyTracks::covariance, "(k, 4, 4)")
      .def_readonly("mode_probability", &PyTracks::mode_probability,
                    "(k, K), 0 of models that rest")
      .def_readonly("turn_rate_rad_s", &PyTracks::turn_rate_rad_s,
                    "(k, K) of each model, positive to starboard, NaN for an inactive one; None if "
                    "models do not change theirs")
      .def_readonly("nis", &PyTracks::nis, "(k,) of the likeliest plot; NaN without one")
      .def_readonly("existence", &PyTracks::existence, "(k,)")
      .def_readonly("visibility", &PyTracks::visibility, "(k,)")
      .def_readonly("hits", &PyTracks::hits, "(k,)")
      .def_readonly("misses", &PyTracks::misses, "(k,) consecutive scans without a plot")
      .def_readonly("name", &PyTracks::name, "given by the operator")
      .def_readonly("identity", &PyTracks::identity,
                    "of the vessel that reports and that the track is believed to be; else empty")
      .def_readonly("identity_probability", &PyTracks::identity_probability,
                    "(k,) how probable that is; 0 without an identity")
      .def_readonly("identity_time_s", &PyTracks::identity_time_s,
                    "(k,) of the vessel's last report; NaN without an identity")
      .def_readonly(
          "mean_nis", &PyTracks::mean_nis,
          "(k,) mean of the NIS of the plots of a track, 2 if its errors are as stated: of "
          "those that were its plot with a probability above 0.5, each counting a tenth "
          "less than the next; NaN before the first")
      .def_readonly("mean_nis_bounds", &PyTracks::mean_nis_bounds,
                    "(k, 2) between which it is with a probability of 0.95 if they are")
      .def_readonly(
          "whiteness", &PyTracks::whiteness,
          "(k,) autocorrelation of the innovations of these plots, -1 to 1: positive where "
          "the estimate lags; NaN before the second")
      .def_readonly("whiteness_bound", &PyTracks::whiteness_bound,
                    "(k,) below which its amount is with a probability of 0.95 if they are white")
      .def("__len__", [](const PyTracks& table) { return table.track_id.size(); })
      .def("__repr__", [](const PyTracks& table) {
        return "<TrackTable: " + many(table.track_id.size(), "track") + ">";
      });
  define_track_lines(table);

  py::class_<AnyTracker> tracker(
      m, "Tracker",
      R"(Tracks all vessels in the plots of one or several radars, turn by turn or sector by sector.

Calls from several threads are made one after the other; trackers share nothing.

Parameters
----------
radar : Radar or list of Radar
    The radars, numbered from 0; None in the list: a number without a radar. A track is updated by
    every radar that covers it, and a miss counts only where no other radar has seen it.
config : TrackerConfig, optional
models : VesselModels, optional
    Motion models of the estimator.
estimator : Imm, AdaptiveGridImm, SwitchingGridImm, LikelyModelSetImm, ModeHistory, FuzzyAlphaBeta or BayesianAlphaBeta, optional
    Estimator to use instead of the one made from `models`.

Raises
------
ValueError
    When a setting is invalid.)");
  define_arguments(tracker);
  tracker
      .def(py::init([](const Radars& radars, const TrackerConfig& config,
                       const VesselModels& models, const py::object& estimator) {
             return make_tracker(radars, config, models, estimator);
           }),
           py::arg("radar"), py::arg_v("config", TrackerConfig{}, "TrackerConfig()"),
           py::arg_v("models", VesselModels{}, "VesselModels()"), py::arg("estimator") = py::none())
      .def("process", &process, py::arg("time_s"), py::kw_only(), py::arg("range_m"),
           py::arg("bearing_rad"), py::arg("plot_time_s") = py::none(),
           py::arg("own_north_m") = 0.0, py::arg("own_east_m") = 0.0,
           py::arg("heading_std_rad") = 0.0, py::arg("own_position_std_m") = 0.0,
           py::arg("covariance") = py::none(),
           R"(Process the plots of one scan, a whole turn of the antenna of radar 0.

Parameters
----------
time_s : float
    Time of the scan; not before the last one nor after `latest_time_s`.
range_m, bearing_rad : (n,) arrays
plot_time_s, own_north_m, own_east_m : float or (n,) arrays
    Time of each plot, and own ship's position at that time.
heading_std_rad : float
    Standard deviation of own ship's heading.
own_position_std_m : float
    Standard deviation of own ship's position, per axis.
covariance : (n, 2, 2) array, optional
    Of range and bearing of each plot, such as that of `VideoPlots`, in place of the radar's errors;
    zero: the radar's.

Returns
-------
ScanReport

Raises
------
ValueError
    When a shape does not fit or a standard deviation is negative.
FilterError
    When the time is not finite, before the last scan or after `latest_time_s`; the tracker is
    unchanged.)")
      .def("sector", &sector, py::kw_only(), py::arg("radar") = 0, py::arg("from_rad"),
           py::arg("to_rad"), py::arg("time_s"), py::arg("range_m"), py::arg("bearing_rad"),
           py::arg("plot_time_s") = py::none(), py::arg_v("own", OwnShip{}, "OwnShip()"),
           py::arg("covariance") = py::none(),
           R"(Process a part of the antenna's turn.

Tracks whose gate the beam has passed are updated or have missed, once a turn; others, and plots that
may be theirs, wait for the next sector. Where sectors leave a gap, tracks are neither updated nor
miss; a track that the beam has not passed for two periods coasts by time, a miss a period. Where
sectors overlap the beam does not go back.

Parameters
----------
radar : int
    Number of the radar.
from_rad, to_rad : float
    The beam went clockwise from one bearing, as the radar measures it, to the other; a turn apart:
    a whole turn, as `process` takes it. Equal: time passes.
time_s : float
    At the end of the sector; not before the last one of this radar, nor more than a period before
    that of another one, nor after `latest_time_s`.
range_m, bearing_rad : (n,) arrays
plot_time_s : float or (n,) array
    Time of each plot.
own : OwnShip
    At the end of the sector; at the time of each plot it was where its velocity has it.
covariance : (n, 2, 2) array, optional
    Of range and bearing of each plot, as in `process`.

Returns
-------
ScanReport
    The track of a plot that waits is 0.

Raises
------
ValueError
    When the radar is not known, the angles are no sector, a shape does not fit or own ship is invalid.
FilterError
    When the time is not finite, before the last sector or after `latest_time_s`; the tracker is
    unchanged.)")
      .def("report", &take_report, py::kw_only(), py::arg("time_s"), py::arg("identity"),
           py::arg("north_m"), py::arg("east_m"), py::arg("position_std_m") = 10.0,
           py::arg("vnorth_mps") = py::none(), py::arg("veast_mps") = py::none(),
           py::arg("velocity_std_mps") = 0.5, py::arg("source") = "ais",
           R"(Take the position that a vessel reports of itself, such as by AIS.

It is of the track that its identity is believed to be, which is decided by where the reports of the
identity are, one after the other, and of a new track where there is none near and the vessel has
reported before. It updates the track only while they agree, and where its velocity is that at which
its positions move; events say where not. An error below four standard deviations that does not
change is taken for right. A track that reports is kept while its vessel
can be silent. A report older than 120 s before the last scan, or not newer than the last one of its
identity, and one more than 120 s ahead, changes nothing. Estimators other than `Imm` do not take
the velocity.

Parameters
----------
time_s : float
    Of the position, true time.
identity : str
    Such as the MMSI; at most 31 bytes of UTF-8.
north_m, east_m, position_std_m : float
vnorth_mps, veast_mps : float, optional
velocity_std_mps : float
    Of the velocity, per axis.
source : str
    The same identity of two sources is two; at most 15 bytes.

Returns
-------
ReportResult

Raises
------
ValueError
    When a number is not finite or out of range, or a text empty or too long.)")
      .def(
          "bearings",
          [](AnyTracker& tracker, double time_s, const DoubleArray& bearing_rad,
             double bearing_std_rad, int sensor, double false_per_rad, const OwnShip& own) {
            require_positive("bearing_std_rad", bearing_std_rad);
            require_positive("false_per_rad", false_per_rad);
            return partial(tracker, "bearings", PositionPart::kBearing, sensor, time_s,
                           "bearing_rad", bearing_rad, bearing_std_rad, false_per_rad, own);
          },
          py::kw_only(), py::arg("time_s"), py::arg("bearing_rad"), py::arg("bearing_std_rad"),
          py::arg("sensor") = 0, py::arg("false_per_rad") = 1.0,
          py::arg_v("own", OwnShip{}, "OwnShip()"),
          R"(Take bearings of targets without their ranges, as of a camera.

They update the confirmed tracks, start none, and count no misses. Bearings between several tracks
are shared by their likelihoods, and which tracks the sensor sees is learned. Errors of such a sensor
stay for a while: bearings that come faster than the antenna turns count as much as one a turn.

Parameters
----------
time_s : float
    Of all bearings, at most 120 s from the last scan.
bearing_rad : (n,) array
    From north, of targets in any order, with false ones among them.
bearing_std_rad : float
sensor : int
    Number of the sensor, from 0 to 3.
false_per_rad : float
    Mean of the false bearings in a radian.
own : OwnShip
    Of the sensor.

Returns
-------
ScanReport
    The track that each most probably belongs to.

Raises
------
ValueError
    When a shape does not fit, or a number is out of range.
FilterError
    When the time is farther from the last scan; the tracker is unchanged.)")
      .def(
          "ranges",
          [](AnyTracker& tracker, double time_s, const DoubleArray& range_m, double range_std_m,
             int sensor, double false_per_m, const OwnShip& own) {
            require_positive("range_std_m", range_std_m);
            require_positive("false_per_m", false_per_m);
            return partial(tracker, "ranges", PositionPart::kRange, sensor, time_s, "range_m",
                           range_m, range_std_m, false_per_m, own);
          },
          py::kw_only(), py::arg("time_s"), py::arg("range_m"), py::arg("range_std_m"),
          py::arg("sensor") = 0, py::arg("false_per_m") = 1e-3,
          py::arg_v("own", OwnShip{}, "OwnShip()"),
          R"(Take ranges of targets without their bearings; as `bearings`.

Parameters
----------
time_s : float
range_m : (n,) array
range_std_m : float
sensor : int
false_per_m : float
    Mean of the false ranges in a metre.
own : OwnShip

Returns
-------
ScanReport

Raises
------
ValueError, FilterError
    As `bearings`.)")
      .def(
          "find",
          [](const AnyTracker& tracker, std::string_view identity, std::string_view source) {
            return tracker.visit([&](const auto& one) {
              const Track* track = one.find(source, identity);
              return track == nullptr ? std::int64_t{0} : track->id;
            });
          },
          py::arg("identity"), py::kw_only(), py::arg("source") = "ais",
          "The number of the track that a vessel which reports is believed to be; 0 without one.")
      .def(
          "add_radar",
          [](AnyTracker& tracker, const Radar& radar) {
            return tracker.visit([&](auto& one) { return one.add_radar(radar); });
          },
          py::arg("radar"), "Add a radar and return its number, the least that is free.")
      .def(
          "remove_radar",
          [](AnyTracker& tracker, int radar) {
            return tracker.visit([&](auto& one) { return one.remove_radar(radar); });
          },
          py::arg("radar"),
          R"(Remove a radar and what was learned of it; tracks go on by the others.

False when there is none of that number or it is the last one.)")
      .def(
          "set_radar",
          [](AnyTracker& tracker, int number, const Radar& radar) {
            tracker.visit([&](auto& one) { one.set_radar(number, radar); });
          },
          py::arg("number"), py::arg("radar"),
          R"(Change the settings of a radar, such as the errors and the period of another range scale.

All tracks are kept.

Raises
------
ValueError
    When there is no radar of that number.)")
      .def("tracks", &tracks_of, py::arg("time_s") = py::none(), py::arg("tentative") = false,
           py::arg("predicted") = true,
           R"(The confirmed and coasting tracks (with `tentative` all), at one time.

Parameters
----------
time_s : float, optional
    Default: the time of the last scan; before the first one each track has the time for which it
    was designated. A track is predicted to it, or moved back at constant velocity where its plot
    was later. NaN where it is so far ahead that a prediction fails.
tentative : bool
    Whether tentative and held tracks are included.
predicted : bool
    Whether tracks are predicted to the default time; False: each as of its last update.

Returns
-------
TrackTable

Raises
------
ValueError
    When the time is not finite.)")
      .def(
          "designate",
          [](AnyTracker& tracker, double time_s, double north_m, double east_m,
             double position_std_m, const std::optional<double>& vnorth_mps,
             const std::optional<double>& veast_mps, double velocity_std_mps) {
            require_finite("time_s", time_s);
            const auto [last_s, latest_s] = std::as_const(tracker).visit(
                [](const auto& one) { return std::pair(one.time_s(), one.latest_time_s()); });
            require(!(std::abs(time_s - last_s) > latest_s - last_s), "time_s",
                    ("within an hour of the last scan, at " + std::to_string(last_s)).c_str(),
                    time_s);
            require_in_range("north_m", north_m);
            require_in_range("east_m", east_m);
            require_positive("position_std_m", position_std_m);
            require_in_range("position_std_m", position_std_m);
            std::optional<Gaussian<2>> velocity;
            if (const auto mean_mps = velocity_of(vnorth_mps, veast_mps, velocity_std_mps)) {
              require_in_range("velocity_std_mps", velocity_std_mps);
              velocity = {*mean_mps,
                          velocity_std_mps * velocity_std_mps * Mat<double, 2, 2>::Identity()};
            }
            return tracker.visit([&](auto& one) {
              return one.designate(time_s, north_m, east_m, position_std_m, velocity);
            });
          },
          py::arg("time_s"), py::arg("north_m"), py::arg("east_m"),
          py::arg("position_std_m") = 50.0, py::kw_only(), py::arg("vnorth_mps") = py::none(),
          py::arg("veast_mps") = py::none(), py::arg("velocity_std_mps") = 2.0,
          R"(Confirm the track at a position, or start a confirmed one, on an operator's designation.

Of several tracks whose gate the position is in, the nearest is confirmed, in standard deviations; a
hushed one is shown again. It keeps its velocity. A new track begins at rest, or with the velocity
given.

Parameters
----------
time_s : float
    Within an hour of the last scan.
north_m, east_m, position_std_m : float
vnorth_mps, veast_mps, velocity_std_mps : float, optional
    Both components of the velocity, and their standard deviation, per axis.

Returns
-------
int
    The track's number, or 0 if there is no room.

Raises
------
ValueError
    When the time is farther from the last scan, a number is not finite or beyond 1e9, or the
    standard deviation not positive.)")
      .def(
          "merge",
          [](AnyTracker& tracker, std::int64_t id, std::int64_t other_id) {
            return tracker.visit([&](auto& one) { return one.merge(id, other_id); });
          },
          py::arg("track_id"), py::arg("other_id"),
          R"(Say that two tracks are of one vessel; False if there are no two of these numbers.

The second is ended, and the first takes its name and its identity if it has none. Where the vessel
has two echoes, the second starts a track again: `drop` with `hush` follows it in silence.)")
      .def(
          "rename",
          [](AnyTracker& tracker, std::int64_t id, std::string_view name) {
            if (!is_utf8(name)) throw py::value_error("name must be UTF-8 text, got other bytes");
            return tracker.visit([&](auto& one) { return one.rename(id, name); });
          },
          py::arg("track_id"), py::arg("name"),
          "Name a track (at most 31 bytes of UTF-8 are kept); False if no track has that number.")
      .def(
          "drop",
          [](AnyTracker& tracker, std::int64_t id, bool hush) {
            return tracker.visit([&](auto& one) { return one.drop(id, hush); });
          },
          py::arg("track_id"), py::kw_only(), py::arg("hush") = false,
          R"(End a track; False if no track has that number.

With `hush` its vessel is followed in silence, so that it does not start again under another number:
the track is not in `tracks`, has no events and no plots reported, until its vessel is lost, it is
designated or dropped again.)")
      .def_property_readonly(
          "time_s",
          [](const AnyTracker& tracker) {
            return tracker.visit([](const auto& one) { return one.time_s(); });
          },
          "Time of the last scan; 0 before the first.")
      .def_property_readonly(
          "latest_time_s",
          [](const AnyTracker& tracker) {
            return tracker.visit([](const auto& one) { return one.latest_time_s(); });
          },
          "Until when a scan is processed and a target can be designated: an hour after the last "
          "scan, or ever before the first one. After a longer silence of the radar a scan "
          "without plots is needed an hour after the last one.")
      .def("_arguments", &tracker_arguments);
  define_keeping(
      tracker,
      "The complete state as bytes, for a tracker with the same settings on the same kind "
      "of machine.");

  define_late_window(m);
  define_strobe_tracker(m);
  define_calibration(m);
}

}  // namespace wakeline::python
