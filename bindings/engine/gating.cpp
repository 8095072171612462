// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdint>
#include <string>
#include <variant>

#include "support/fields.hpp"
#include "support/option.hpp"
#include "support/types.hpp"
#include "wakeline/core/angle.hpp"
#include "wakeline/gating/chi_square_gate.hpp"
#include "wakeline/gating/radius_gate.hpp"
#include "wakeline/gating/strobe_echo.hpp"

namespace wakeline::python {
namespace {

/// Knows the gate that it was made with.
struct PyCovarianceStrobe : CovarianceStrobe {
  ChiSquareGate gate;
};

using AnyStrobe = std::variant<RadiusGate, PyCovarianceStrobe, RangeBearingWindow>;

Vec<double, 2> to_position(const char* name, const DoubleArray& position) {
  return to_vector(name, position, 2);
}

// Radar video as a picture ------------------------------------------------------------------------

/// From a sweep to the next: the mean step of one turn or sector. Throws ValueError unless the
/// sweeps run clockwise, each within a quarter of a step of its place.
double even_step_rad(const DoubleArray& azimuth_rad, double width_rad) {
  const py::ssize_t sweeps = azimuth_rad.shape(0);
  if (sweeps < 2) return width_rad;
  const auto azimuth = azimuth_rad.unchecked<1>();
  const auto turned = [&](py::ssize_t k) { return wrap_angle(azimuth(k) - azimuth(k - 1)); };
  double total = 0.0;
  for (py::ssize_t k = 1; k < sweeps; ++k) total += turned(k);
  const double step = total / static_cast<double>(sweeps - 1);
  if (!(step > 0.0)) throw py::value_error("video must have clockwise sweeps");
  double off = 0.0;
  for (py::ssize_t k = 1; k < sweeps; ++k) {
    off += turned(k) - step;
    if (!(std::abs(off) <= 0.25 * step))
      throw py::value_error("video must have sweeps at even steps of azimuth, got sweep " +
                            std::to_string(k) + " " + std::to_string(off) +
                            " rad off its position; use a wakeline.ScanImage for a regular grid");
  }
  if (static_cast<double>(sweeps) * step > 2 * kPi<double> + 0.5 * step)
    throw py::value_error("video must hold at most one turn, got " +
                          std::to_string(static_cast<double>(sweeps) * step / (2 * kPi<double>)) +
                          "; take one of video.turns()");
  return step;
}

/// The sweeps of a RadarVideo, which must outlive the picture, as a picture.
template <class Amplitude>
AmplitudeImage<Amplitude> to_image(const py::object& video, const py::array& amplitude) {
  const auto azimuth_rad = video.attr("azimuth_rad").cast<DoubleArray>();
  if (azimuth_rad.shape(0) == 0) throw py::value_error("video must have sweeps, got none");
  const double width_rad = video.attr("azimuth_width_rad").cast<double>();
  return {static_cast<const Amplitude*>(amplitude.data()),
          static_cast<int>(amplitude.shape(0)),
          static_cast<int>(amplitude.shape(1)),
          azimuth_rad.at(0),
          even_step_rad(azimuth_rad, width_rad),
          video.attr("start_range_m").cast<double>(),
          video.attr("cell_m").cast<double>()};
}

// Strobes -----------------------------------------------------------------------------------------

StrobeEcho lay_strobe(const py::object& video, const AnyStrobe& strobe,
                      const DoubleArray& predicted_m, int least_amplitude, int pedestal,
                      const std::string& several) {
  const StrobeSettings settings{least_amplitude, pedestal,
                                to_option<EchoChoice>("several", several)};
  settings.validate();
  const Vec<double, 2> predicted = to_position("predicted_m", predicted_m);
  const auto is_a = [&](const char* module, const char* name) {
    return py::isinstance(video, py::module_::import(module).attr(name));
  };
  if (!is_a("wakeline.recording", "RadarVideo") && !is_a("wakeline", "ScanImage"))
    throw py::type_error("video must be a wakeline.recording.RadarVideo or a ScanImage, got " +
                         py::str(py::type::of(video).attr("__name__")).cast<std::string>());
  const auto amplitude = video.attr("amplitude").cast<py::array>();
  const auto on = [&](const auto& image) {
    return std::visit([&](const auto& s) { return strobe_echo(image, s, predicted, settings); },
                      strobe);
  };
  return amplitude.itemsize() == 1 ? on(to_image<std::uint8_t>(video, amplitude))
                                   : on(to_image<std::uint16_t>(video, amplitude));
}

/// What all shapes of strobes offer.
template <class Strobe>
void define_contains(py::class_<Strobe>& strobe) {
  strobe.def(
      "contains",
      [](const Strobe& s, const DoubleArray& predicted_m, const DoubleArray& plot_m) {
        return s.contains(to_position("predicted_m", predicted_m), to_position("plot_m", plot_m));
      },
      py::arg("predicted_m"), py::arg("plot_m"), "Whether a plot [north, east] is inside.");
}

void define_strobes(py::module_& m) {
  auto circle = define_struct<RadiusGate>(
      m, "RadiusGate", "A circle of fixed radius around the predicted position.", {.called = true});
  define_contains(circle);

  py::class_<PyCovarianceStrobe> ellipse(m, "CovarianceStrobe",
                                         R"(The gate of an estimator around the predicted position.

Parameters
----------
innovation_covariance_m2 : (2, 2) array
    Innovation covariance over north and east.
gate : ChiSquareGate
    Its probability to contain the plot.

Raises
------
ValueError
    When the covariance is not symmetric positive definite.)");
  define_copies(ellipse);
  ellipse
      .def(py::init([](const DoubleArray& covariance, const ChiSquareGate& gate) {
             const PyCovarianceStrobe strobe{
                 {to_matrix("innovation_covariance_m2", covariance, 2, 2), gate.threshold(2)},
                 gate};
             strobe.validate();
             return strobe;
           }),
           py::arg("innovation_covariance_m2"),
           py::arg_v("gate", ChiSquareGate{}, "ChiSquareGate()"))
      .def_property_readonly(
          "innovation_covariance_m2",
          [](const PyCovarianceStrobe& s) { return to_array(s.innovation_covariance_m2); },
          "(2, 2)")
      .def_property_readonly(
          "threshold", [](const PyCovarianceStrobe& s) { return s.threshold; },
          "largest normalized innovation squared inside")
      .def("_arguments", [](const PyCovarianceStrobe& s) {
        return Arguments()
            .with("innovation_covariance_m2", s.innovation_covariance_m2)
            .with("gate", s.gate);
      });
  define_contains(ellipse);

  auto window = define_struct<RangeBearingWindow>(
      m, "RangeBearingWindow", "A window of range and bearing around the predicted position.");
  define_contains(window);
}

void define_strobe_echo(py::module_& m) {
  py::class_<StrobeEcho>(m, "StrobeEcho",
                         "The echo in a strobe as a measurement; true when there is one.")
      .def("__bool__", [](const StrobeEcho& e) { return static_cast<bool>(e); })
      .def_property_readonly(
          "status", [](const StrobeEcho& e) { return std::string(to_string(e.status)); },
          "'ok'; 'cut', 'touches edge', 'several echoes' or 'crowded', the last of these that "
          "holds; 'empty', 'outside' or 'invalid' without a measurement")
      .def_property_readonly(
          "position", [](const StrobeEcho& e) { return PyGaussian::from(e.position()); },
          "north and east from the antenna, m; NaN without a measurement")
      .def_readonly("range_m", &StrobeEcho::range_m, "of the centroid")
      .def_readonly("bearing_rad", &StrobeEcho::bearing_rad, "clockwise from north, 0 to 2 pi")
      .def_property_readonly(
          "covariance", [](const StrobeEcho& e) { return to_array(e.covariance); },
          "(2, 2) of `range_m` and `bearing_rad`")
      .def_readonly("total_amplitude", &StrobeEcho::total_amplitude, "sum over the measured cells")
      .def_readonly("peak_amplitude", &StrobeEcho::peak_amplitude, "largest of the measured cells")
      .def_readonly("cells", &StrobeEcho::cells, "measured")
      .def_readonly("echoes", &StrobeEcho::echoes,
                    "separate echoes, measured or not; 0 if there were too many to separate")
      .def_readonly("strobe_cells", &StrobeEcho::strobe_cells,
                    "of the picture inside the strobe, whatever their amplitude")
      .def_readonly("touches_edge", &StrobeEcho::touches_edge,
                    "the measured echo extends beyond the strobe")
      .def_readonly("cut", &StrobeEcho::cut, "part of the strobe is outside the picture")
      .def("__repr__", [](const StrobeEcho& e) {
        return std::string("<StrobeEcho: ") + to_string(e.status) +
               ", range_m=" + text_of(e.range_m) + ", bearing_rad=" + text_of(e.bearing_rad) + ">";
      });

  const StrobeSettings settings;
  m.def("strobe_echo", &lay_strobe, py::arg("video"), py::arg("strobe"), py::arg("predicted_m"),
        py::kw_only(), py::arg("least_amplitude") = settings.least_amplitude,
        py::arg("pedestal") = settings.pedestal, py::arg("several") = "all",
        R"(The echo in a strobe: the centroid of the amplitudes inside.

A cell is inside if its center is. The centroid is that of range and bearing, which the width of the
beam does not bias. Its covariance is the weighted spread divided by the effective number of cells,
plus the quantization of the grid.

Parameters
----------
video : RadarVideo or ScanImage
    At most one revolution, at even steps of azimuth.
strobe : RadiusGate, CovarianceStrobe or RangeBearingWindow
predicted_m : (2,) array
    North and east from the antenna.
least_amplitude : int
    Cells below it do not count. Set it above the noise, which otherwise biases the centroid towards
    the prediction.
pedestal : int
    Subtracted from the amplitude of every cell that counts; below `least_amplitude`.
several : {'all', 'nearest', 'strongest'}
    Which of several separate echoes is measured: the centroid of all, the one nearest to the
    prediction, or the one with the largest weight.

Returns
-------
StrobeEcho
    With the status 'invalid' if the prediction is not finite.

Raises
------
ValueError
    When a setting is invalid, or the sweeps are not clockwise at even steps.

References
----------
Grinyak, Trofimov, "Multi-model tracking of moving vessels with a fuzzy criterion of maneuver
detection".)");
}

}  // namespace

void define_gating(py::module_& parent) {
  py::module_ m = parent.def_submodule("gating", "Gates and strobes for a target's plot.");
  define_struct<ChiSquareGate>(
      m, "ChiSquareGate",
      "The ellipsoid that holds the target's own plot with a given probability.", {.called = true})
      .def("threshold", &ChiSquareGate::threshold, py::arg("dof"),
           "Largest normalized innovation squared inside, for `dof` measured quantities, at least "
           "1; else NaN.");
  define_strobes(m);
  define_strobe_echo(m);
}

}  // namespace wakeline::python
