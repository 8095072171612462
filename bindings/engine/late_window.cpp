// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/track/late_window.hpp"

#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "any_tracker.hpp"
#include "wakeline/core/utf8.hpp"

namespace wakeline::python {

void define_late_window(py::module_& track);

namespace {

/// A tracker behind a window.
struct PyLateWindow : AnyTracker {
  explicit PyLateWindow(AnyTracker&& tracker) : AnyTracker(std::move(tracker)) {}

  std::vector<Event> correct() {
    const auto hold = lock();  // the events are the window's memory
    const py::gil_scoped_release release;
    return visit_window([](auto& window) {
      const auto events = window.correct();
      return std::vector<Event>(events.begin(), events.end());
    });
  }
};

/// A time given, or now.
double time_or_now(const std::optional<double>& time_s) {
  if (time_s) require_finite("time_s", *time_s);
  return time_s.value_or(std::numeric_limits<double>::quiet_NaN());
}

/// What a window has, as a property.
template <class Of>
auto property(const Of& of) {
  return [of](PyLateWindow& late) { return late.visit_window(of); };
}

}  // namespace

void define_late_window(py::module_& m) {
  const LateWindowConfig usual;
  py::class_<PyLateWindow, AnyTracker> late(
      m, "LateWindow",
      R"(A tracker whose data may come late: the tracks are, bit for bit, as if all had come in time.

Scans, sectors and what the operator does are put in their place by time: of one time in the order of
radar and angles, so that the order in which they come does not matter. The calls are those of
`Tracker`. What comes in time is processed at once. For what comes late the tracker goes back and
processes again what came since, as soon as the work that came in pays for it: all corrections
together cost at most 1.75 times what processing in order does. `tracks()` and `correct()` correct the
picture at once. The events of a correction are the numbers that there are now (confirmed), or are no
more (lost, for the reason corrected). A number that a track got within the window may become that of
another one by a correction; older ones stay.

Data from before the window are not processed: all their plots are `rejected_plots` of the report, and
`too_late_inputs` counts them. All memory is taken by the constructor.

Parameters
----------
radar, config, models, estimator
    As of `Tracker`.
window_s : float
    What is at most so much older than the newest data is put in its place; 0: two turns of the
    antenna.
max_inputs, max_plots : int
    Room for the sectors and other inputs of a window, and for their plots; with more in a window the
    window is shorter.

Raises
------
ValueError
    When a setting is invalid.)");
  define_arguments(late);
  late.def(
          py::init([](const Radars& radar, const TrackerConfig& config, const VesselModels& models,
                      const py::object& estimator, double window_s, int max_inputs, int max_plots) {
            const LateWindowConfig window{window_s, max_inputs, max_plots};
            return PyLateWindow(make_tracker(radar, config, models, estimator, &window));
          }),
          py::arg("radar"), py::arg_v("config", TrackerConfig{}, "TrackerConfig()"),
          py::arg_v("models", VesselModels{}, "VesselModels()"), py::arg("estimator") = py::none(),
          py::kw_only(), py::arg("window_s") = usual.window_s,
          py::arg("max_inputs") = usual.max_inputs, py::arg("max_plots") = usual.max_plots)
      .def(
          "tracks",
          [](PyLateWindow& window, const std::optional<double>& time_s, bool tentative,
             bool predicted, bool correct) {
            const auto hold = window.lock();
            if (correct) (void)window.correct();
            return tracks_of(window, time_s, tentative, predicted);
          },
          py::arg("time_s") = py::none(), py::arg("tentative") = false, py::arg("predicted") = true,
          py::arg("correct") = true,
          R"(The tracks, as `Tracker.tracks` gives them.

Parameters
----------
time_s : float, optional
tentative, predicted : bool
correct : bool
    Whether all late data are put in first, at the cost of up to a window of data processed again;
    False: the picture as it is, at no cost.

Returns
-------
TrackTable

Raises
------
ValueError
    When the time is not finite.)")
      .def("correct", &PyLateWindow::correct,
           "Put all late data in the picture. Returns the events of the correction.")
      .def(
          "merge",
          [](PyLateWindow& late, std::int64_t id, std::int64_t other_id,
             const std::optional<double>& time_s) {
            const double at_s = time_or_now(time_s);
            return late.visit_window(
                [&](auto& window) { return window.merge(id, other_id, at_s); });
          },
          py::arg("track_id"), py::arg("other_id"), py::kw_only(), py::arg("time_s") = py::none(),
          "As `Tracker.merge`, at a time; default: now.")
      .def(
          "rename",
          [](PyLateWindow& late, std::int64_t id, std::string_view name,
             const std::optional<double>& time_s) {
            if (!is_utf8(name)) throw py::value_error("name must be UTF-8 text, got other bytes");
            const double at_s = time_or_now(time_s);
            return late.visit_window([&](auto& window) { return window.rename(id, name, at_s); });
          },
          py::arg("track_id"), py::arg("name"), py::kw_only(), py::arg("time_s") = py::none(),
          "As `Tracker.rename`, at a time; default: now.")
      .def(
          "drop",
          [](PyLateWindow& late, std::int64_t id, bool hush, const std::optional<double>& time_s) {
            const double at_s = time_or_now(time_s);
            return late.visit_window([&](auto& window) { return window.drop(id, hush, at_s); });
          },
          py::arg("track_id"), py::kw_only(), py::arg("hush") = false,
          py::arg("time_s") = py::none(), "As `Tracker.drop`, at a time; default: now.")
      .def(
          "set_radar",
          [](PyLateWindow& late, int number, const Radar& radar,
             const std::optional<double>& time_s) {
            const double at_s = time_or_now(time_s);
            late.visit_window([&](auto& window) { window.set_radar(number, radar, at_s); });
          },
          py::arg("number"), py::arg("radar"), py::kw_only(), py::arg("time_s") = py::none(),
          "As `Tracker.set_radar`, at a time; default: now.")
      .def(
          "save",
          [](PyLateWindow& late) {
            return to_bytes(late.visit_window([](auto& window) { return window.save(); }));
          },
          "The complete state as bytes, with the data of the window; the picture is corrected.")
      .def_property_readonly("window_s", property([](auto& w) { return w.config().window_s; }))
      .def_property_readonly("earliest_time_s",
                             property([](auto& w) { return w.earliest_time_s(); }),
                             "Data from before are too late.")
      .def_property_readonly("is_correct", property([](auto& w) { return w.is_correct(); }),
                             "Whether all late data are in the picture.")
      .def_property_readonly("late_inputs", property([](auto& w) { return w.counts().late; }),
                             "How many came late and were put in their place.")
      .def_property_readonly("too_late_inputs",
                             property([](auto& w) { return w.counts().too_late; }),
                             "How many came too late, and were not processed.")
      .def_property_readonly("corrections",
                             property([](auto& w) { return w.counts().corrections; }),
                             "How often the picture was corrected.")
      .def("_arguments", [](PyLateWindow& late) {
        Arguments arguments = tracker_arguments(late);
        late.visit_window([&](auto& window) {
          arguments.with("window_s", window.config().window_s)
              .with("max_inputs", window.config().max_inputs)
              .with("max_plots", window.config().max_plots);
        });
        return arguments;
      });
}

}  // namespace wakeline::python
