// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Datagrams and sentences of radar networks: plots in, tracks out.
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "support/columns.hpp"
#include "support/types.hpp"
#include "wakeline/wire/asterix_feed.hpp"
#include "wakeline/wire/asterix_reader.hpp"
#include "wakeline/wire/sensor_clock.hpp"
#include "wakeline/wire/ttm_feed.hpp"

namespace wakeline::python {
namespace {

/// The records of a datagram as columns.
struct PyRecords {
  std::vector<RadarRecord> rows;
  std::vector<std::tuple<std::size_t, std::string, std::string>> problems;
};

template <class T, class Class>
void define_column(Class& table, const char* name, T (*value)(const RadarRecord&),
                   const char* doc) {
  table.def_property_readonly(
      name, [value](const PyRecords& records) { return column_of<T>(records.rows, value); }, doc);
}

void define_numbers(py::class_<PyRecords>& table) {
  struct Column {
    const char* name;
    double RadarRecord::*member;
    const char* doc;
  };
  static constexpr Column kColumns[] = {
      {"time_s", &RadarRecord::time_s,
       "(n,) time of day, on the day nearest to that of reception; NaN when absent"},
      {"range_m", &RadarRecord::range_m, "(n,) NaN when absent"},
      {"bearing_rad", &RadarRecord::bearing_rad,
       "(n,) clockwise from the radar's north; of a sector mark the start of the sector"},
      {"latitude_rad", &RadarRecord::latitude_rad,
       "(n,) of the target; of a mark of the radar; NaN when absent"},
      {"longitude_rad", &RadarRecord::longitude_rad, "(n,) likewise"},
      {"speed_mps", &RadarRecord::speed_mps, "(n,) NaN when absent"},
      {"course_rad", &RadarRecord::course_rad, "(n,) NaN when absent"},
      {"period_s", &RadarRecord::period_s, "(n,) of the antenna, in marks; NaN when absent"},
  };
  for (const Column& column : kColumns)
    table.def_property_readonly(
        column.name,
        [member = column.member](const PyRecords& records) {
          return column_of<double>(records.rows,
                                   [member](const RadarRecord& row) { return row.*member; });
        },
        column.doc);
}

PyRecords decode(AsterixReader& reader, const py::bytes& datagram, double received_s) {
  PyRecords records;
  reader.feed(bytes_of(datagram), received_s);
  for (auto event = reader.next(); event != AsterixEvent::kEnd; event = reader.next()) {
    if (event == AsterixEvent::kRecord) {
      records.rows.push_back(reader.record());
    } else {
      const AsterixProblem& problem = reader.problem();
      const std::string text = "category " + std::to_string(problem.category) + ": " +
                               to_string(problem.fault) + " (wanted " +
                               std::to_string(problem.wanted) + " octets, got " +
                               std::to_string(problem.came) + ")";
      records.problems.emplace_back(problem.offset, text, problem.item);
    }
  }
  return records;
}

/// A column of flags; none are set where it is not given.
using Flags = std::optional<py::array_t<bool, py::array::c_style | py::array::forcecast>>;

void set_flags(const char* name, const Flags& flags, std::span<ReportedTrack> tracks,
               bool ReportedTrack::*flag) {
  if (!flags) return;
  const auto count = static_cast<py::ssize_t>(tracks.size());
  require_shape(flags->ndim() == 1 && flags->size() == count, name, shape_text({count}), *flags);
  for (py::ssize_t k = 0; k < count; ++k) tracks[static_cast<std::size_t>(k)].*flag = flags->at(k);
}

/// The rows of the columns that all feeds take.
std::vector<ReportedTrack> reported(
    const py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>& track_id,
    const py::object& estimate_time_s, const DoubleArray& mean,
    const std::optional<DoubleArray>& covariance, const Flags& acquiring,
    const py::object& turn_rate_rad_s, const py::object& age_s,
    const std::optional<std::vector<std::string>>& name) {
  require_shape(track_id.ndim() == 1, "track_id", "(k,)", track_id);
  const py::ssize_t count = track_id.size();
  const DoubleArray time_s = column("estimate_time_s", estimate_time_s, count);
  require_shape(mean.ndim() == 2 && mean.shape(0) == count && mean.shape(1) == 4, "mean",
                shape_text({count, 4}), mean);
  if (covariance)
    require_shape(covariance->ndim() == 3 && covariance->size() == 16 * count, "covariance",
                  shape_text({count, 4, 4}), *covariance);
  if (name && static_cast<py::ssize_t>(name->size()) != count)
    throw py::value_error("name must have " + std::to_string(count) + " texts, got " +
                          std::to_string(name->size()));
  const auto optional = [count](const char* label, const py::object& values) {
    return values.is_none() ? std::nullopt : std::optional(column(label, values, count));
  };
  const auto turn_rate = optional("turn_rate_rad_s", turn_rate_rad_s);
  const auto age = optional("age_s", age_s);
  std::vector<ReportedTrack> tracks(static_cast<std::size_t>(count));
  set_flags("acquiring", acquiring, tracks, &ReportedTrack::acquiring);
  for (py::ssize_t k = 0; k < count; ++k) {
    ReportedTrack& track = tracks[static_cast<std::size_t>(k)];
    track.id = track_id.at(k);
    track.time_s = time_s.at(k);
    track.kinematics.mean = Eigen::Map<const Vec<double, 4>>(mean.data(k, 0));
    if (covariance) {
      const Eigen::Map<const Mat<double, 4, 4>> given(covariance->data() + 16 * k);
      track.kinematics.covariance = given;
      track.has_covariance = given.allFinite();
    }
    if (turn_rate) track.turn_rate_rad_s = turn_rate->at(k);
    if (age) track.age_s = age->at(k);
    if (name) track.set_name((*name)[static_cast<std::size_t>(k)]);
  }
  return tracks;
}

double finite_time(double time_s) {
  if (!std::isfinite(time_s))
    throw py::value_error("time_s must be finite, got " + std::to_string(time_s));
  return time_s;
}

/// The numbers of the tracks that are sent, with state and copies.
template <class Class>
void define_feed(Class& feed) {
  using Feed = typename Class::type;
  define_copies(feed);
  feed.def_property_readonly(
          "numbers",
          [](const Feed& self) {
            py::dict numbers;
            self.schedule().for_each(
                [&](std::int64_t id, int number) { numbers[py::int_(id)] = number; });
            return numbers;
          },
          "The number of each track that is being sent, by track_id.")
      .def_property_readonly(
          "waiting", [](const Feed& self) { return self.schedule().waiting(); },
          "Tracks of the last update without a free number.");
}

constexpr const char* kColumnsDoc = R"doc(
track_id : (k,) array of int
    All tracks that are shown: one that is missing has its last report now.
estimate_time_s : float or (k,) array
    Time of each estimate. A track is due when it is newer than the one sent last.
mean : (k, 4) array
    [x, vx, y, vy], as of `TrackTable.mean`.
)doc";

void define_ttm(py::module_& m) {
  py::class_<TtmFeed> feed(
      m, "TtmFeed",
      R"doc(Tracks as NMEA 0183 sentences: OSD, then a TTM for each target that is due.

Targets are predicted to the time of sending and referred to own ship; all directions are true. A target keeps its number, 0 to
99; the sentence with status L is sent once, and the number then rests for `hold_off_s`. A target has at most one sentence in
`interval_s`, and only with a new estimate. The source of these rules are the receivers: OpenCPN places a target by its own latest fix, and keeps
no trail of targets that come faster than every 2 s.

Parameters
----------
plane : LocalPlane
    The plane of the tracks.
talker : str
    Two letters before the formatter: RA for radar.
interval_s : float
    Give the antenna's period where it is longer than 3 s.
hold_off_s : float
    Rest of a number.
tll : bool
    Send TLL (latitude and longitude) in place of TTM, for receivers that cannot use range and bearing.

Raises
------
ValueError
    When the talker is not two capital letters or digits, or a time is negative or not finite.)doc");
  define_feed(feed);
  feed.def("_arguments",
           [](const TtmFeed& self) {
             return Arguments()
                 .with("plane", py::cast(self.plane()))
                 .with("talker", self.config().talker)
                 .with("interval_s", self.config().interval_s)
                 .with("hold_off_s", self.config().hold_off_s)
                 .with("tll", self.config().tll);
           })
      .def(py::init([](const LocalPlane& plane, const std::string& talker, double interval_s,
                       double hold_off_s, bool tll) {
             return TtmFeed(plane, {talker, interval_s, hold_off_s, tll});
           }),
           py::arg("plane"), py::kw_only(), py::arg("talker") = "RA", py::arg("interval_s") = 3.0,
           py::arg("hold_off_s") = 60.0, py::arg("tll") = false)
      .def(
          "update",
          [](TtmFeed& self, double time_s,
             const py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>& track_id,
             const py::object& estimate_time_s, const DoubleArray& mean,
             const std::optional<std::vector<std::string>>& name, const std::optional<OwnShip>& own,
             double heading_rad, bool own_velocity_known, const Flags& acquiring,
             const Flags& manual) {
            std::vector<ReportedTrack> tracks =
                reported(track_id, estimate_time_s, mean, std::nullopt, acquiring, py::none(),
                         py::none(), name);
            set_flags("manual", manual, tracks, &ReportedTrack::manual);
            std::vector<py::bytes> sentences;
            self.update(
                finite_time(time_s), own.value_or(OwnShip{}), heading_rad, tracks,
                [&](std::string_view text) { sentences.emplace_back(text.data(), text.size()); },
                own_velocity_known);
            return sentences;
          },
          py::arg("time_s"), py::arg("track_id"), py::arg("estimate_time_s"), py::arg("mean"),
          py::kw_only(), py::arg("name") = py::none(), py::arg("own") = py::none(),
          py::arg("heading_rad") = std::numeric_limits<double>::quiet_NaN(),
          py::arg("own_velocity_known") = true, py::arg("acquiring") = py::none(),
          py::arg("manual") = py::none(),
          (std::string("The sentences that are due, each with carriage return and line feed.\n\n"
                       "Parameters\n----------\ntime_s : float\n    Now, UTC in seconds since any "
                       "midnight.") +
           kColumnsDoc +
           R"doc(name : sequence of str, optional
    Cut to the room in the sentence, at most 20 characters.
own : OwnShip, optional
    Own ship in the plane, at the origin if not given. Its position should be the fix that the receiver has.
heading_rad : float
    Of own ship, true; NaN when it is unknown or old (OSD then says V).
own_velocity_known : bool
    False: fields that need the velocity of own ship are empty.
acquiring : (k,) array of bool, optional
    Whether the operator has acquired the target and its motion is not known yet: Q, without speed, course and CPA.
manual : (k,) array of bool, optional
    Whether the operator has acquired it at any time: M instead of A.)doc")
              .c_str());
}

/// The arguments of the call that makes an equal feed; those of the service are in category 062.
template <class Format>
Arguments feed_arguments(const AsterixFeed<Format>& feed) {
  const AsterixFeedConfig& config = feed.config();
  Arguments arguments;
  arguments.with("plane", py::cast(feed.plane()))
      .with("area", int{config.source.area})
      .with("system", int{config.source.system})
      .with("interval_s", config.interval_s)
      .with("hold_off_s", config.hold_off_s)
      .with("datagram_octets", config.datagram_octets);
  if constexpr (std::is_same_v<Format, asterix::Cat062>)
    arguments.with("service", int{config.service}).with("several_radars", config.several_radars);
  return arguments;
}

void define_init(py::class_<Cat062Feed>& feed) {
  feed.def(py::init([](const LocalPlane& plane, std::uint8_t area, std::uint8_t system,
                       std::uint8_t service, bool several_radars, double interval_s,
                       double hold_off_s, std::size_t datagram_octets) {
             return Cat062Feed(plane, {.source = {area, system},
                                       .service = service,
                                       .several_radars = several_radars,
                                       .interval_s = interval_s,
                                       .hold_off_s = hold_off_s,
                                       .datagram_octets = datagram_octets});
           }),
           py::arg("plane"), py::kw_only(), py::arg("area") = 0, py::arg("system") = 0,
           py::arg("service") = 1, py::arg("several_radars") = false, py::arg("interval_s") = 0.0,
           py::arg("hold_off_s") = 60.0, py::arg("datagram_octets") = 1400);
}

void define_init(py::class_<Cat010Feed>& feed) {
  feed.def(py::init([](const LocalPlane& plane, std::uint8_t area, std::uint8_t system,
                       double interval_s, double hold_off_s, std::size_t datagram_octets) {
             AsterixFeedConfig config;
             config.source = {area, system};
             config.interval_s = interval_s;
             config.hold_off_s = hold_off_s;
             config.datagram_octets = datagram_octets;
             return Cat010Feed(plane, config);
           }),
           py::arg("plane"), py::kw_only(), py::arg("area") = 0, py::arg("system") = 0,
           py::arg("interval_s") = 0.0, py::arg("hold_off_s") = 60.0,
           py::arg("datagram_octets") = 1400);
}

template <class Format>
void define_asterix_feed(py::module_& m, const char* name, const char* doc) {
  using Feed = AsterixFeed<Format>;
  py::class_<Feed> feed(m, name, doc);
  define_feed(feed);
  define_init(feed);
  feed.def("_arguments", &feed_arguments<Format>)
      .def(
          "update",
          [](Feed& self, double time_s,
             const py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>& track_id,
             const py::object& estimate_time_s, const DoubleArray& mean,
             const std::optional<DoubleArray>& covariance, const Flags& coasting,
             const py::object& turn_rate_rad_s, const py::object& age_s,
             const std::optional<std::vector<std::string>>& name, const Flags& acquiring) {
            std::vector<ReportedTrack> tracks =
                reported(track_id, estimate_time_s, mean, covariance, acquiring, turn_rate_rad_s,
                         age_s, name);
            set_flags("coasting", coasting, tracks, &ReportedTrack::coasting);
            std::vector<py::bytes> datagrams;
            self.update(finite_time(time_s), tracks,
                        [&](asterix::Octets octets) { datagrams.push_back(to_bytes(octets)); });
            return datagrams;
          },
          py::arg("time_s"), py::arg("track_id"), py::arg("estimate_time_s"), py::arg("mean"),
          py::kw_only(), py::arg("covariance") = py::none(), py::arg("coasting") = py::none(),
          py::arg("turn_rate_rad_s") = py::none(), py::arg("age_s") = py::none(),
          py::arg("name") = py::none(), py::arg("acquiring") = py::none(),
          (std::string("The datagrams that are due.\n\nParameters\n----------\ntime_s : float\n    "
                       "Now, UTC in seconds since any midnight.") +
           kColumnsDoc +
           R"doc(covariance : (k, 4, 4) array, optional
coasting : (k,) array of bool, optional
    Whether the radar did not see the target when it looked last.
turn_rate_rad_s : float or (k,) array, optional
    To starboard.
age_s : float or (k,) array, optional
    Time since the last plot.
name : sequence of str, optional
acquiring : (k,) array of bool, optional
    Whether the operator has acquired the target and its motion is not known yet (CNF).)doc")
              .c_str());
}

void define_decoder(py::module_& m) {
  py::class_<PyRecords> records(m, "AsterixRecords",
                                R"doc(Plots and marks of a datagram, one per row, in its order.

Numbers that a record does not have are NaN. `problems` has (offset, problem, item) of what cannot be read.)doc");
  define_column<std::uint8_t>(
      records, "kind", [](const RadarRecord& row) { return static_cast<std::uint8_t>(row.kind); },
      "(n,) 0 plot, 1 north mark (or start of an update cycle, category 010), 2 sector mark");
  define_column<std::uint8_t>(
      records, "category", [](const RadarRecord& row) { return row.category; },
      "(n,) 10, 34 or 48");
  define_column<std::int64_t>(
      records, "source",
      [](const RadarRecord& row) -> std::int64_t {
        return 256 * row.source.area + row.source.system;
      },
      "(n,) 256 SAC + SIC");
  define_numbers(records);
  define_column<std::int64_t>(
      records, "track_number",
      [](const RadarRecord& row) -> std::int64_t { return row.track_number; },
      "(n,) of the radar's own tracker; -1 when absent");
  define_column<bool>(
      records, "test", [](const RadarRecord& row) { return row.test; },
      "(n,) whether it is a simulated or test target");
  records.def_readonly("problems", &PyRecords::problems, "Each (offset, problem, item).")
      .def("__len__", [](const PyRecords& self) { return self.rows.size(); });

  py::class_<AsterixReader>(
      m, "AsterixDecoder",
      R"doc(Datagrams of ASTERIX categories 010, 034 and 048 to plots and marks of rotating radars.

Source: EUROCONTROL-SPEC-0149, parts 7 (010, edition 1.1), 2b (034, 1.29) and 4 (048, 1.32). Blocks of other
categories are skipped and counted, as are records that are neither plots with a position nor marks: status messages,
tracks without detection. After a record that cannot be read, the rest of its block is skipped.)doc")
      .def(py::init())
      .def("decode", &decode, py::arg("datagram"), py::arg("received_s"),
           R"doc(The records of a datagram.

Parameters
----------
datagram : bytes
received_s : float
    Time of reception, UTC in seconds since any midnight: the day of the times of day.

Returns
-------
AsterixRecords)doc")
      .def_property_readonly("other_blocks", &AsterixReader::other_blocks,
                             "Blocks of other categories so far.")
      .def_property_readonly("other_records", &AsterixReader::other_records,
                             "Records so far that are neither plots nor marks.");

  py::class_<SensorClock>(m, "SensorClock", R"doc(Times of a sensor on the receiver's clock.

Clocks of sensors are often wrong and seldom drift. A time at most `limit_s` from that of reception is right; the difference of
a first time that is not is held as the offset of the sensor's clock. It is found again when all times have been more than `limit_s`
from where the offset puts them for 10 s. Until then such a time is that of data that come late, where it is before the
reception, and else that of reception.

Parameters
----------
limit_s : float

Raises
------
ValueError
    When the limit is not between 0 and half a day.)doc")
      .def(py::init<double>(), py::arg("limit_s") = 5.0)
      .def("__call__", &SensorClock::operator(), py::arg("time_s"), py::arg("received_s"),
           "The time on the receiver's clock, on the day nearest to that of reception; that of "
           "reception for NaN.")
      .def_property_readonly("offset_s", &SensorClock::offset_s,
                             "What is added to the sensor's times; 0 where its clock is right.")
      .def_property_readonly("changes", &SensorClock::changes, "How often the offset has changed.");
}

}  // namespace

void define_wire(py::module_& parent) {
  py::module_ m = parent.def_submodule("wire", "Datagrams and sentences of radar networks.");
  define_decoder(m);
  define_ttm(m);
  define_asterix_feed<asterix::Cat062>(m, "Cat062Feed",
                                       R"doc(Tracks as ASTERIX category 062 (system tracks).

Items: I062/010, 015, 070, 105, 100, 185, 245 (of a named track), 040, 080, 290 (where `age_s` is given), 200 and 500 (with a covariance).
Estimates have their own time. TSB marks the first report of a track, TSE the last one, which is sent once; its number, 0 to 65535, then rests
for `hold_off_s`. Cartesian positions and velocities are in the plane, x east. Source: EUROCONTROL-SPEC-0149, part 9, edition 1.21.

Parameters
----------
plane : LocalPlane
    The plane of the tracks, whose reference is that of I062/100.
area, system, service : int
    SAC, SIC (I062/010) and I062/015.
several_radars : bool
    Whether tracks are of several radars: MON is 0.
interval_s : float
    Least time between reports of a track.
hold_off_s : float
    Rest of a number.
datagram_octets : int
    Longest datagram.

Raises
------
ValueError
    When a time is negative or not finite, or a datagram is not 128 to 8192 octets.)doc");
  define_asterix_feed<asterix::Cat010>(
      m, "Cat010Feed", R"doc(Tracks as ASTERIX category 010, the usual output of coastal radars.

Items: I010/010, 000, 020 (primary radar), 140, 041, 042 (within 32 km), 200, 161, 170 and 500 (with a covariance). The velocity is I010/200, as
readers disagree on the unit of I010/202. TRE marks the last report of a track, which is sent once; its number, 0 to 4095, then rests for
`hold_off_s`. Source: EUROCONTROL-SPEC-0149, part 7, edition 1.1. Parameters as those of
`Cat062Feed` with the same names.)doc");
}

}  // namespace wakeline::python
