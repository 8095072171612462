// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/navigation/encounter_watch.hpp"

#include <algorithm>
#include <string>
#include <type_traits>
#include <vector>

#include "support/fields.hpp"
#include "support/thread_lock.hpp"
#include "support/types.hpp"

namespace wakeline::python {

void define_encounter_watch(py::module_& navigation);

namespace {

/// Rows as arrays, one for each quantity.
template <class Row>
struct Table {
  std::vector<Row> rows;

  [[nodiscard]] py::ssize_t size() const { return std::ssize(rows); }

  /// An array (n, tail...) of what `fill(row, to)` writes for each row.
  template <class Value, class Fill>
  [[nodiscard]] py::array_t<Value> each(std::vector<py::ssize_t> tail, Fill fill) const {
    py::ssize_t width = 1;
    for (const py::ssize_t side : tail) width *= side;
    tail.insert(tail.begin(), size());
    py::array_t<Value> values(tail);
    for (std::size_t k = 0; k < rows.size(); ++k)
      fill(rows[k], values.mutable_data() + width * static_cast<py::ssize_t>(k));
    return values;
  }

  py::bytes state() const {
    Archive fields;
    auto count = rows.size();
    fields(count);
    for (Row row : rows) row.archive(fields);
    return to_bytes(fields.bytes());
  }

  static Table of_state(const py::bytes& state) {
    Archive fields(bytes_of(state));
    Table table;
    std::size_t count = 0;
    fields(count);
    for (std::size_t k = 0; k < count && fields.ok(); ++k)
      table.rows.emplace_back().archive(fields);
    if (!fields.ok() || !fields.at_end())
      throw py::value_error("state is not that of such a table");
    return table;
  }
};
using Approaches = Table<Approach>;
using Encounters = Table<Encounter>;

struct PyEncounterReport {
  Encounters began, ended;
  Approaches approaches;
  int unwatched_vessels = 0, left_out = 0;
};

const Approach& approach_of(const Approach& one) { return one; }
const Approach& approach_of(const Encounter& one) { return one.approach; }

/// An array (n,) of what a function gives for each row, or for its approach.
template <class Value, class Row, class Of>
void column(py::class_<Table<Row>>& type, const char* name, Value (*f)(const Of&),
            const char* doc) {
  type.def_property_readonly(
      name,
      [f](const Table<Row>& table) {
        return table.template each<Value>({}, [f](const Row& row, Value* to) {
          if constexpr (std::is_same_v<Of, Row>)
            *to = f(row);
          else
            *to = f(approach_of(row));
        });
      },
      doc);
}

/// An array (n, 2) of positions.
template <class Row>
void place(py::class_<Table<Row>>& type, const char* name, Vec<double, 2> Approach::*member,
           const char* doc) {
  type.def_property_readonly(
      name,
      [member](const Table<Row>& table) {
        return table.template each<double>({2}, [member](const Row& row, double* to) {
          std::copy_n((approach_of(row).*member).data(), 2, to);
        });
      },
      doc);
}

/// What both tables have.
template <class Row>
py::class_<Table<Row>> define_table(py::module_& m, const char* name, const char* doc) {
  py::class_<Table<Row>> type(m, name, doc);
  type.def("__len__", &Table<Row>::size)
      .def("__repr__",
           [name](const Table<Row>& table) {
             return "<" + std::string(name) + ": " + many(table.size(), "row") + ">";
           })
      .def(
          py::pickle([](const Table<Row>& table) { return table.state(); }, &Table<Row>::of_state));
  using A = Approach;
  using Number = std::int64_t;
  column(
      type, "first", +[](const A& a) { return a.first; }, "(n,) a vessel; 0 is own ship");
  column(
      type, "second", +[](const A& a) { return a.second; }, "(n,) the other, of a larger number");
  column(
      type, "zone", +[](const A& a) { return Number{a.zone}; },
      "(n,) index of the zone whose limits apply, -1 for the general ones");
  column(
      type, "range_m", +[](const A& a) { return a.range_m; }, "(n,) distance");
  column(
      type, "cpa_m", +[](const A& a) { return a.cpa_m(); }, "(n,) distance at the closest point");
  column(
      type, "signed_cpa_m", +[](const A& a) { return a.signed_cpa_m; },
      "(n,) the same, positive where the vessels pass port to port");
  column(
      type, "tcpa_s", +[](const A& a) { return a.tcpa_s; },
      "(n,) time until the closest point; negative in the past");
  column(
      type, "probability", +[](const A& a) { return a.probability; },
      "(n,) probability to come closer than the limit within the time limit");
  type.def_property_readonly(
      "covariance",
      [](const Table<Row>& table) {
        return table.template each<double>({2, 2}, [](const Row& row, double* to) {
          std::copy_n(approach_of(row).covariance.data(), 4, to);  // symmetric
        });
      },
      "(n, 2, 2) of [signed_cpa_m, tcpa_s], of first order");
  place(type, "first_at_cpa_m", &A::first_at_cpa_m,
        "(n, 2) [north, east] of the first vessel at the closest point");
  place(type, "second_at_cpa_m", &A::second_at_cpa_m, "(n, 2) of the second one");
  return type;
}

std::vector<Vec<double, 2>> corners_of(const DoubleArray& outline_m) {
  require_shape(outline_m.ndim() == 2 && outline_m.shape(1) == 2, "outline_m", "(n, 2)", outline_m);
  std::vector<Vec<double, 2>> corners;
  for (py::ssize_t k = 0; k < outline_m.shape(0); ++k)
    corners.emplace_back(outline_m.at(k, 0), outline_m.at(k, 1));
  return corners;
}

py::array_t<double> outline_of(const DangerZone& zone) {
  py::array_t<double> outline({std::ssize(zone.outline_m), py::ssize_t{2}});
  for (std::size_t k = 0; k < zone.outline_m.size(); ++k)
    std::copy_n(zone.outline_m[k].data(), 2, outline.mutable_data() + 2 * k);
  return outline;
}

/// A watch that several threads may use.
struct PyWatch : EncounterWatch, ThreadLock {
  using EncounterWatch::EncounterWatch;
};

PyEncounterReport update(PyWatch& watch, double time_s,
                         const py::array_t<std::int64_t, py::array::c_style>& id,
                         const DoubleArray& mean, const DoubleArray& covariance) {
  require_shape(id.ndim() == 1, "vessel_id", "(n,)", id);
  const py::ssize_t count = id.size();
  require_shape(shape_of(mean) == std::vector{count, py::ssize_t{4}}, "mean",
                shape_text({count, 4}), mean);
  require_shape(shape_of(covariance) == std::vector{count, py::ssize_t{4}, py::ssize_t{4}},
                "covariance", shape_text({count, 4, 4}), covariance);
  std::vector<WatchedVessel> vessels(static_cast<std::size_t>(count));
  for (std::size_t k = 0; k < vessels.size(); ++k) {
    vessels[k].id = id.data()[k];
    vessels[k].kinematics.mean = Eigen::Map<const Vec<double, 4>>(mean.data() + 4 * k);
    vessels[k].kinematics.covariance =
        Eigen::Map<const Mat<double, 4, 4>>(covariance.data() + 16 * k);
  }
  std::vector<std::int64_t> numbers(id.data(), id.data() + count);
  std::sort(numbers.begin(), numbers.end());
  if (const auto twice = std::adjacent_find(numbers.begin(), numbers.end()); twice != numbers.end())
    throw py::value_error("vessel_id must be different for each vessel, got " +
                          std::to_string(*twice) + " twice");
  PyEncounterReport result;
  const auto hold = watch.hold();  // the report is the watch's memory
  EncounterReport report;
  {
    const py::gil_scoped_release release;
    report = watch.update(time_s, vessels);
  }
  require_ok(report.status, "update");
  for (const EncounterEvent& event : report.events)
    (event.change == EncounterChange::kBegan ? result.began : result.ended)
        .rows.push_back(event.encounter);
  result.approaches.rows.assign(report.approaches.begin(), report.approaches.end());
  result.unwatched_vessels = report.unwatched_vessels;
  result.left_out = report.left_out;
  return result;
}

}  // namespace

void define_encounter_watch(py::module_& m) {
  define_struct<DangerLimits>(m, "DangerLimits", R"(Limits of a dangerous approach of two vessels.

An encounter begins when two vessels will be closer than `cpa_limit_m` within `tcpa_limit_s` with
at least `alarm_probability`, their closest approach within that time, too. It ends when the danger
is over for `clear_hold_s`: the probability below `clear_probability`, or the closest approach past,
or no motion relative to each other, or both vessels at rest. The hold time keeps one alarm per
encounter while the estimate of a distant vessel varies.)");

  py::class_<DangerZone> zone(m, "DangerZone", R"(An area with separate limits, such as a harbor.

Parameters
----------
name : str
outline_m : (n, 2) array_like
    Corners [north, east] of a polygon, n at least 3.
limits : DangerLimits, optional

Raises
------
ValueError
    When there are fewer than three corners or one is not finite.)");
  define_arguments(zone);
  zone.def(py::init([](std::string name, const DoubleArray& outline_m, const DangerLimits& limits) {
             DangerZone made{std::move(name), corners_of(outline_m), limits};
             made.validate();
             return made;
           }),
           py::arg("name"), py::arg("outline_m"),
           py::arg_v("limits", DangerLimits{}, "DangerLimits()"))
      .def_readonly("name", &DangerZone::name)
      .def_property_readonly("outline_m", &outline_of, "(n, 2) corners [north, east]")
      .def_property_readonly("limits", [](const DangerZone& one) { return one.limits; })
      .def(
          "contains",
          [](const DangerZone& one, double north_m, double east_m) {
            return one.contains({north_m, east_m});
          },
          py::arg("north_m"), py::arg("east_m"), "Whether a place is inside.")
      .def("__eq__",
           [](const DangerZone& a, const DangerZone& b) {
             return a.name == b.name && a.outline_m == b.outline_m && a.limits == b.limits;
           })
      .def("_arguments", [](const DangerZone& one) {
        return Arguments()
            .with("name", one.name)
            .with("outline_m", outline_of(one))
            .with("limits", one.limits);
      });

  define_table<Approach>(m, "ApproachTable", "Closest approaches of pairs of vessels, as arrays.");
  py::class_<Encounters> encounters = define_table<Encounter>(
      m, "EncounterTable", "Dangerous encounters as arrays; what changes is of `time_s`.");
  column(
      encounters, "encounter_id", +[](const Encounter& one) { return one.id; },
      "(n,) positive, never used again");
  column(
      encounters, "acknowledged", +[](const Encounter& one) { return one.acknowledged; },
      "(n,) whether the operator knows it");
  column(
      encounters, "dangerous", +[](const Encounter& one) { return one.dangerous(); },
      "(n,) whether the danger continues; False in the hold time");
  column(
      encounters, "begin_s", +[](const Encounter& one) { return one.begin_s; },
      "(n,) first update with danger");
  column(
      encounters, "last_s", +[](const Encounter& one) { return one.last_s; },
      "(n,) last update with danger");
  column(
      encounters, "time_s", +[](const Encounter& one) { return one.time_s; },
      "(n,) last update that had both vessels");
  column(
      encounters, "least_range_m", +[](const Encounter& one) { return one.least_range_m; },
      "(n,) smallest distance of all updates so far");
  column(
      encounters, "least_range_s", +[](const Encounter& one) { return one.least_range_s; },
      "(n,) its time");

  py::class_<PyEncounterReport> report(m, "EncounterReport", "Result of an update.");
  define_pickle(report, &PyEncounterReport::began, &PyEncounterReport::ended,
                &PyEncounterReport::approaches, &PyEncounterReport::unwatched_vessels,
                &PyEncounterReport::left_out);
  report.def_readonly("began", &PyEncounterReport::began, "EncounterTable of new encounters")
      .def_readonly("ended", &PyEncounterReport::ended,
                    "EncounterTable of encounters whose danger is over")
      .def_readonly("approaches", &PyEncounterReport::approaches,
                    "ApproachTable of all approaches that can matter, dangerous or not")
      .def_readonly("unwatched_vessels", &PyEncounterReport::unwatched_vessels,
                    "vessels that are not finite, or beyond max_vessels")
      .def_readonly("left_out", &PyEncounterReport::left_out,
                    "approaches and encounters without room")
      .def("__repr__", [](const PyEncounterReport& r) {
        return "<EncounterReport: " + std::to_string(r.began.size()) + " began, " +
               std::to_string(r.ended.size()) + " ended, " +
               many(r.approaches.size(), "approach that matters") + ">";
      });

  py::class_<PyWatch> watch(m, "EncounterWatch",
                            R"(Finds the vessels that come dangerously close to each other.

An approach can matter when its closest point is ahead within the time limit, the probability of
coming closer than the limit is at least 0.01, the vessels move relative to each other by three
standard deviations, one of them is faster than `rest_speed_mps` by two, and neither is own ship with the
other closer than `own_length_m`. An encounter begins when such an approach has `alarm_probability`
and ends when the danger is over (`DangerLimits`). Limits are those of the first zone that contains
the middle between the vessels at their closest point, else the general ones; an encounter keeps its
limits. A pair is left out without a probability only if that is below 0.01.

Parameters
----------
limits : DangerLimits, optional
zones : sequence of DangerZone, optional
max_vessels : int, optional

Raises
------
ValueError
    When a limit is out of range.)");
  define_arguments(watch);
  watch
      .def(py::init([](const DangerLimits& limits, std::vector<DangerZone> zones, int max_vessels) {
             return PyWatch(limits, std::move(zones), max_vessels);
           }),
           py::arg_v("limits", DangerLimits{}, "DangerLimits()"),
           py::arg_v("zones", std::vector<DangerZone>{}, "()"), py::arg("max_vessels") = 1000)
      .def("update", &update, py::arg("time_s"), py::kw_only(), py::arg("vessel_id"),
           py::arg("mean"), py::arg("covariance"),
           R"(Take all vessels at a time.

Parameters
----------
time_s : float
    Not before the last one.
vessel_id : (n,) array of int
    0 for own ship, different for each vessel.
mean : (n, 4) array
    [x, vx, y, vy], metres and m/s.
covariance : (n, 4, 4) array
    Of own ship that of its velocity alone: plots are measured from its position.

Returns
-------
EncounterReport

Raises
------
ValueError
    When a shape does not fit or two vessels have the same number.
FilterError
    When the time is before the last one or not finite; nothing is changed.)")
      .def_property_readonly(
          "encounters",
          [](const PyWatch& one) {
            const auto hold = one.hold();
            return Encounters{{one.encounters().begin(), one.encounters().end()}};
          },
          "EncounterTable of those that have not ended, by their vessels' numbers.")
      .def(
          "acknowledge",
          [](PyWatch& one, std::int64_t id) {
            const auto hold = one.hold();
            return one.acknowledge(id);
          },
          py::arg("encounter_id"),
          "Mark an encounter as known to the operator; False if none has that number.")
      .def(
          "save",
          [](const PyWatch& one) {
            const auto hold = one.hold();
            return to_bytes(one.save());
          },
          "The complete state as bytes, for a watch with the same limits, zones and room.")
      .def(
          "restore",
          [](PyWatch& one, const py::bytes& state) {
            const auto hold = one.hold();
            if (!one.restore(bytes_of(state)))
              throw py::value_error("state was not saved by a watch with the same limits");
          },
          py::arg("state"), "Continues bit for bit where the saved watch was.")
      .def_property_readonly("limits",
                             [](const PyWatch& one) { return DangerLimits(one.limits()); })
      .def_property_readonly("zones", [](const PyWatch& one) { return one.zones(); })
      .def_property_readonly("max_vessels", &PyWatch::max_vessels)
      .def("_arguments", [](const PyWatch& one) {
        return Arguments()
            .with("limits", one.limits())
            .with("zones", one.zones())
            .with("max_vessels", one.max_vessels());
      });
}

}  // namespace wakeline::python
