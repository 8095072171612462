// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Tracks as arrays.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "support/arrays.hpp"

namespace wakeline::python {

struct PyTracks {
  py::array_t<std::int64_t> track_id;
  std::vector<std::string> status;
  py::array_t<double> time_s, mean, covariance, mode_probability, nis, existence, visibility;
  py::object turn_rate_rad_s;  ///< None where no model changes its turn rate
  py::array_t<std::int64_t> hits, misses;
  std::vector<std::string> name;
  std::vector<std::string> identity;
  py::array_t<double> identity_probability, identity_time_s;
  py::array_t<double> mean_nis, mean_nis_bounds, whiteness, whiteness_bound;
};

void define_track_lines(py::class_<PyTracks>& table);  // track_lines.cpp

}  // namespace wakeline::python
