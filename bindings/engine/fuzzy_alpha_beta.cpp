// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>
#include <utility>

#include "multimodel.hpp"
#include "support/option.hpp"
#include "support/types.hpp"

namespace wakeline::python {
namespace {

using Fuzzy = FuzzyAlphaBeta<>;
using PyFuzzy = PyEstimator<Fuzzy>;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// What the criterion saw and did in every scan of one or R runs.
struct FuzzyTrace {
  py::array_t<double> quality, sigma_hat_m, residual_ratios, rule_strengths, prediction_m,
      innovation_m;
  py::array_t<int> chosen;
};

/// An array of the shape of the runs and scans, and `columns` where that is not 0.
template <class T>
py::array_t<T> per_scan_of(const DoubleArray& z, py::ssize_t columns, T fill) {
  std::vector<py::ssize_t> shape(z.shape(), z.shape() + z.ndim() - 1);
  if (columns > 0) shape.push_back(columns);
  py::array_t<T> array(shape);
  std::fill_n(array.mutable_data(), array.size(), fill);
  return array;
}

FuzzyTrace empty_trace(const DoubleArray& z, py::ssize_t max_plots) {
  return {per_scan_of(z, 0, kNone),
          per_scan_of(z, 0, kNone),
          per_scan_of(z, max_plots - 1, kNone),
          per_scan_of(z, max_plots, kNone),
          per_scan_of(z, 2, kNone),
          per_scan_of(z, 2, kNone),
          per_scan_of(z, 0, 0)};
}

/// Copies values to a row of an array; the rest of the row stays.
void fill_row(py::array_t<double>& array, std::size_t row, std::size_t columns,
              std::span<const double> values) {
  std::copy(values.begin(), values.end(), array.mutable_data() + row * columns);
}

template <int kM>
void trace_scan(Fuzzy& estimator, const AnySensorOf<kM>& sensor, const double* z, double dt_s,
                std::size_t row, FuzzyTrace& trace) {
  const Vec<double, kM> reading = Eigen::Map<const Vec<double, kM>>(z + row * kM);
  const auto plots = static_cast<std::size_t>(estimator.criterion().max_plots);
  const bool moved = estimator.predict(dt_s) == Status::kOk;
  const Vec<double, 2> prediction = position_of(estimator.estimate()).mean;
  fill_row(trace.prediction_m, row, 2, {prediction.data(), 2});
  const auto step =
      moved ? estimator.update(sensor, reading) : failed_step<2, double>(Status::kNotFinite);
  trace.chosen.mutable_data()[row] = estimator.chosen();
  trace.sigma_hat_m.mutable_data()[row] = estimator.sigma_hat_m();
  if (!step) return;
  fill_row(trace.innovation_m, row, 2, {step.innovation.data(), 2});
  fill_row(trace.residual_ratios, row, plots - 1, estimator.residual_ratios());
  fill_row(trace.rule_strengths, row, plots, estimator.rule_strengths());
  trace.quality.mutable_data()[row] = estimator.quality();
}

FuzzyTrace trace_runs(const PyFuzzy& prototype, const DoubleArray& z, const py::object& dt_s,
                      const py::object& sensor, const py::object& start) {
  Fuzzy estimator = prototype.get();
  return visit_numbers(to_sensor(sensor), [&]<int kM>(const AnySensorOf<kM>& model) {
    const bool many = z.ndim() == 3;
    require_shape((z.ndim() == 2 || many) && z.shape(z.ndim() - 1) == kM, "z",
                  "(T, " + std::to_string(kM) + ") or (R, T, " + std::to_string(kM) + ")", z);
    const auto runs = static_cast<std::size_t>(many ? z.shape(0) : 1);
    const auto scans = static_cast<std::size_t>(z.shape(many ? 1 : 0));
    const std::vector<double> steps = parse_steps(dt_s, scans);
    const std::vector<AnyBelief> starts = parse_starts(start, runs, StateLayout::kKinematics);
    FuzzyTrace trace = empty_trace(z, estimator.criterion().max_plots);
    {
      const py::gil_scoped_release release;
      for (std::size_t r = 0; r < runs; ++r) {
        require_ok(estimator.start(kinematics_of(starts[starts.size() == 1 ? 0 : r])), "start");
        for (std::size_t k = 0; k < scans; ++k)
          trace_scan(estimator, model, z.data(), steps[k], r * scans + k, trace);
      }
    }
    return trace;
  });
}

}  // namespace

void define_fuzzy_alpha_beta(py::module_& m) {
  const FuzzyCriterion criterion;
  py::class_<FuzzyTrace> trace(m, "FuzzyTrace",
                               "Result of `FuzzyAlphaBeta.trace`: arrays over scans, and over "
                               "runs if there are several; "
                               "NaN without residuals.");
  define_pickle(trace, &FuzzyTrace::quality, &FuzzyTrace::sigma_hat_m, &FuzzyTrace::residual_ratios,
                &FuzzyTrace::rule_strengths, &FuzzyTrace::prediction_m, &FuzzyTrace::innovation_m,
                &FuzzyTrace::chosen);
  trace.def_readonly("quality", &FuzzyTrace::quality, "(..., T) output of the Sugeno system")
      .def_readonly("chosen", &FuzzyTrace::chosen, "(..., T) plots of the selected line")
      .def_readonly("sigma_hat_m", &FuzzyTrace::sigma_hat_m, "(..., T)")
      .def_readonly("residual_ratios", &FuzzyTrace::residual_ratios,
                    "(..., T, J - 1) of the lines through 2 .. J plots")
      .def_readonly("rule_strengths", &FuzzyTrace::rule_strengths, "(..., T, J)")
      .def_readonly("prediction_m", &FuzzyTrace::prediction_m, "(..., T, 2) north and east")
      .def_readonly("innovation_m", &FuzzyTrace::innovation_m, "(..., T, 2) north and east");

  EstimatorClass<Fuzzy> fuzzy(
      m, "FuzzyAlphaBeta",
      R"(A line through the last plots, with their number from a fuzzy criterion: many on a straight, few in a turn.

In each scan the plot is compared with the predictions of the lines through the last 2, 3, ... plots. Each line has the ratio of
its residual to `sigma_hat_m`, the mean residual of the shortest line since the start; ``bad(ratio) = 1 / (1 + exp(-steepness
(ratio - threshold)))`` and ``good = 1 - bad``. Rule p of a zero-order Sugeno system: if the first p lines are good and the rest
bad, track with ``max(2, p + 1)`` plots. The estimate is the line through the weighted mean of these numbers of plots. Before
the second plot it is the initial belief, predicted and updated as in a Kalman filter. A plot within a sixteenth of a step after
the previous one is merged with it, without an effect on the choice.

Same interface as `Imm`, with one mode per line. Uses the position of any sensor; innovations are in north and east.

Parameters
----------
max_plots : int
    Length of the longest line, 2 to 16.
steepness, threshold : float
    Of the membership functions.
clip : float
    Upper limit of the ratios.
t_norm : {'product', 'minimum'}
    Combination of degrees.
hold : bool
    Whether the greater of the last two outputs is used, against single outliers.
acceleration_std_mps2 : float
    Per axis, of a maneuver since the last plot but one: increases the covariance, not used in the choice.

Raises
------
ValueError
    When a parameter makes no sense.

References
----------
V. M. Grinyak, M. V. Trofimov, Multi-model tracking of moving vessels with a fuzzy criterion of maneuver detection.)");
  fuzzy.def(py::init([](int max_plots, double steepness, double threshold, double clip,
                        const std::string& t_norm, bool hold, double acceleration) {
              return PyFuzzy(Fuzzy(FuzzyCriterion{.max_plots = max_plots,
                                                  .steepness = steepness,
                                                  .threshold = threshold,
                                                  .clip = clip,
                                                  .t_norm = to_option<TNorm>("t_norm", t_norm),
                                                  .hold = hold,
                                                  .acceleration_std_mps2 = acceleration}));
            }),
            py::kw_only(), py::arg("max_plots") = criterion.max_plots,
            py::arg("steepness") = criterion.steepness, py::arg("threshold") = criterion.threshold,
            py::arg("clip") = criterion.clip, py::arg("t_norm") = "product",
            py::arg("hold") = criterion.hold,
            py::arg("acceleration_std_mps2") = criterion.acceleration_std_mps2);
  define_copies(fuzzy);
  fuzzy.def("_arguments", [](const PyFuzzy& estimator) {
    const FuzzyCriterion& rules = estimator.get().criterion();
    return Arguments()
        .with("max_plots", rules.max_plots)
        .with("steepness", rules.steepness)
        .with("threshold", rules.threshold)
        .with("clip", rules.clip)
        .with("t_norm", word_of(rules.t_norm))
        .with("hold", rules.hold)
        .with("acceleration_std_mps2", rules.acceleration_std_mps2);
  });
  fuzzy
      .def_property_readonly("quality", of_kind(&Fuzzy::quality),
                             "Output of the Sugeno system at the last plot, before it is held and "
                             "rounded; NaN without one.")
      .def_property_readonly("chosen", of_kind(&Fuzzy::chosen), "Plots of the selected line.")
      .def_property_readonly("sigma_hat_m", of_kind(&Fuzzy::sigma_hat_m),
                             "Mean residual of the shortest line since the start; NaN before the "
                             "first one.")
      .def_property_readonly(
          "residual_ratios",
          [](const PyFuzzy& estimator) { return array_of(estimator.get().residual_ratios()); },
          "For each line at the last plot: its residual / `sigma_hat_m`, "
          "clipped.")
      .def_property_readonly(
          "rule_strengths",
          [](const PyFuzzy& estimator) { return array_of(estimator.get().rule_strengths()); },
          "Strength of each rule.")
      .def_property_readonly(
          "plots_of_mode",
          [](const PyFuzzy& estimator) {
            py::array_t<int> plots(estimator.get().criterion().max_plots - 1);
            for (py::ssize_t k = 0; k < plots.size(); ++k)
              plots.mutable_at(k) = static_cast<int>(k) + 2;
            return plots;
          },
          "(K,) number of plots that each line goes through.")
      .def(
          "evaluate",
          [](const PyFuzzy& estimator, const DoubleArray& ratios) {
            const auto most = static_cast<py::ssize_t>(estimator.get().criterion().max_plots - 1);
            require_shape(ratios.ndim() == 1 && ratios.size() >= 1 && ratios.size() <= most,
                          "ratios", "(n,), n from 1 to " + std::to_string(most), ratios);
            const auto lines = static_cast<std::size_t>(ratios.size());
            std::vector<double> clipped(ratios.data(), ratios.data() + lines);
            for (double& ratio : clipped) {
              require(ratio >= 0.0, "ratios", "0 or more", ratio);
              ratio = std::min(ratio, estimator.get().criterion().clip);
            }
            std::vector<double> strengths(lines + 1);
            const double quality =
                estimator.get().criterion().evaluate(clipped, {strengths.data(), lines + 1});
            return std::pair<double, py::array_t<double>>(quality, array_of(strengths));
          },
          py::arg("ratios"),
          "The Sugeno system alone: its output and the strengths (n + 1,) of its rules for the "
          "ratios "
          "(n,), not negative, of the lines through 2, 3, ... plots.")
      .def("trace", &trace_runs, py::arg("z"), py::arg("dt_s"), py::arg("sensor"), py::arg("start"),
           R"(Inputs and outputs of the criterion in every scan of whole recordings.

Parameters
----------
z, dt_s, sensor, start
    As for `run`.

Returns
-------
FuzzyTrace

Raises
------
ValueError
    When a shape does not fit.
FilterError
    When the estimator cannot start.)");
}

}  // namespace wakeline::python
