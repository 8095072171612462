// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Radar video as arrays: amplitudes and a `RadarVideo`.
#pragma once

#include <utility>

#include "support/types.hpp"
#include "wakeline/video/sweep.hpp"

namespace wakeline::python {

template <class Amplitude>
using AmplitudeArray = py::array_t<Amplitude, py::array::c_style | py::array::forcecast>;

/// Calls `use(array)` with an array (N, C) of uint8 or uint16.
template <class Use>
auto with_amplitude(const py::object& amplitude, Use&& use) {
  const py::array array = py::array::ensure(amplitude);
  if (!array) throw py::value_error("amplitude must be an array (N, C) of uint8 or uint16");
  require_shape(array.ndim() == 2 && array.shape(1) > 0, "amplitude", "(N, C)", array);
  if (py::isinstance<py::array_t<std::uint8_t>>(array))
    return use(AmplitudeArray<std::uint8_t>(array));
  if (py::isinstance<py::array_t<std::uint16_t>>(array))
    return use(AmplitudeArray<std::uint16_t>(array));
  throw py::value_error("amplitude must be of uint8 or uint16, got " +
                        py::str(array.dtype()).cast<std::string>());
}

/// The sweeps of a `RadarVideo`, kept alive.
template <class Amplitude>
class Video {
 public:
  Video(const py::object& video, AmplitudeArray<Amplitude> amplitude)
      : amplitude_(std::move(amplitude)),
        azimuth_rad_(column(video, "azimuth_rad")),
        time_s_(column(video, "time_s")),
        azimuth_width_rad_(video.attr("azimuth_width_rad").cast<double>()),
        start_range_m_(video.attr("start_range_m").cast<double>()),
        cell_m_(video.attr("cell_m").cast<double>()),
        data_(amplitude_.data()),
        cells_(static_cast<std::size_t>(amplitude_.shape(1))) {}

  [[nodiscard]] py::ssize_t size() const { return azimuth_rad_.shape(0); }

  /// Needs no Python.
  [[nodiscard]] Sweep<Amplitude> sweep(py::ssize_t k) const {
    return {.time_s = time_s_.data()[k],
            .azimuth_rad = azimuth_rad_.data()[k],
            .azimuth_width_rad = azimuth_width_rad_,
            .start_range_m = start_range_m_,
            .cell_m = cell_m_,
            .amplitude = {data_ + static_cast<std::size_t>(k) * cells_, cells_}};
  }

 private:
  [[nodiscard]] DoubleArray column(const py::object& video, const char* name) const {
    const auto values = video.attr(name).cast<DoubleArray>();
    require_shape(values.ndim() == 1 && values.shape(0) == amplitude_.shape(0), name,
                  shape_text({amplitude_.shape(0)}), values);
    return values;
  }

  AmplitudeArray<Amplitude> amplitude_;
  DoubleArray azimuth_rad_, time_s_;
  double azimuth_width_rad_, start_range_m_, cell_m_;
  const Amplitude* data_;
  std::size_t cells_;
};

/// Calls `use(video)` with the sweeps of 8 or 16 bits.
template <class Use>
auto with_video(const py::object& video, Use&& use) {
  return with_amplitude(video.attr("amplitude"), [&]<class Array>(Array amplitude) {
    using Amplitude = typename Array::value_type;
    return use(Video<Amplitude>(video, std::move(amplitude)));
  });
}

}  // namespace wakeline::python
