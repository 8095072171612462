// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Tracks as JSON lines.
#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "support/arrays.hpp"
#include "track_table.hpp"
#include "wakeline/wire/json_track.hpp"

namespace wakeline::python {
namespace {

using Rows = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;

std::vector<py::bytes> json_lines(const PyTracks& table, const std::optional<Rows>& rows,
                                  const std::optional<std::string>& radar,
                                  const std::vector<std::string>& modes,
                                  const std::optional<DoubleArray>& place_deg,
                                  const std::optional<DoubleArray>& direction,
                                  const std::optional<DoubleArray>& approach) {
  const py::ssize_t tracks = table.track_id.size();
  if (rows) require_shape(rows->ndim() == 1, "rows", "(n,)", *rows);
  const py::ssize_t count = rows ? rows->size() : tracks;
  const auto require_columns = [count](const char* name, const std::optional<DoubleArray>& given,
                                       py::ssize_t columns) {
    if (given)
      require_shape(given->ndim() == 2 && given->shape(0) == count && given->shape(1) == columns,
                    name, shape_text({count, columns}), *given);
  };
  require_columns("place_deg", place_deg, 2);
  require_columns("direction", direction, 2);
  require_columns("approach", approach, 3);
  const py::ssize_t mode_count = table.mode_probability.shape(1);
  const bool has_names = static_cast<py::ssize_t>(modes.size()) == mode_count;

  std::vector<py::bytes> lines;
  lines.reserve(static_cast<std::size_t>(count));
  std::string text;
  for (py::ssize_t k = 0; k < count; ++k) {
    const py::ssize_t row = rows ? rows->at(k) : k;
    if (row < 0 || row >= tracks)
      throw py::index_error("rows must be from 0 to " + std::to_string(tracks - 1) + ", got " +
                            std::to_string(row));
    const auto at = static_cast<std::size_t>(row);
    const std::span<const double> probability(table.mode_probability.data(row, 0),
                                              static_cast<std::size_t>(mode_count));
    const double* bounds = table.mean_nis_bounds.data(row, 0);
    JsonTrack track{
        .id = table.track_id.at(row),
        .status = table.status[at],
        .name = table.name[at],
        .time_s = table.time_s.at(row),
        .kinematics = {Eigen::Map<const Vec<double, 4>>(table.mean.data(row, 0)),
                       Eigen::Map<const Mat<double, 4, 4>>(table.covariance.data(row, 0, 0))},
        .mode_probability = probability,
        .existence = table.existence.at(row),
        .hits = table.hits.at(row),
        .misses = table.misses.at(row),
        .identity = table.identity[at],
        .identity_probability = table.identity_probability.at(row),
        .identity_time_s = table.identity_time_s.at(row),
        .mean_nis = table.mean_nis.at(row),
        .mean_nis_lower = bounds[0],
        .mean_nis_upper = bounds[1],
        .whiteness = table.whiteness.at(row),
        .whiteness_bound = table.whiteness_bound.at(row)};
    if (has_names && mode_count > 0)
      track.mode = modes[static_cast<std::size_t>(std::ranges::max_element(probability) -
                                                  probability.begin())];
    if (place_deg) track.place = {place_deg->at(k, 0), place_deg->at(k, 1)};
    if (direction) track.direction = {direction->at(k, 0), direction->at(k, 1)};
    if (approach) track.approach = {approach->at(k, 0), approach->at(k, 1), approach->at(k, 2)};
    if (radar) track.radar = *radar;
    text.clear();
    append_track_line(track, text);
    lines.emplace_back(text);
  }
  return lines;
}

}  // namespace

void define_track_lines(py::class_<PyTracks>& table) {
  table.def(
      "json_lines", &json_lines, py::arg("rows") = py::none(), py::kw_only(),
      py::arg("radar") = py::none(), py::arg("modes") = std::vector<std::string>{},
      py::arg("place_deg") = py::none(), py::arg("direction") = py::none(),
      py::arg("approach") = py::none(),
      R"doc(Tracks as JSON lines of version 1, octets for each: see `wakeline.live.json_lines`.

Parameters
----------
rows : (n,) array of int, optional
    Rows of the table; default all.
radar : str, optional
    Whose sector has updated the tracks.
modes : list of str
    Names of the motion models; of another number than these, lines name no mode.
place_deg : (n, 2) array, optional
    Latitude and longitude.
direction : (n, 2) array, optional
    Range (m) and bearing (rad) from own ship.
approach : (n, 3) array, optional
    CPA (m), TCPA (s) and the probability of a distance below the limit, to own ship.

Raises
------
ValueError, IndexError
    When a shape does not fit, or the table has no such row.)doc");
}

}  // namespace wakeline::python
