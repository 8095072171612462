// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "multimodel.hpp"
#include "support/types.hpp"

namespace wakeline::python {

namespace {

using PyBayesian = PyEstimator<BayesianAlphaBeta<>>;

}  // namespace

void define_bayesian_alpha_beta(py::module_& m) {
  const LineWeighing weighing;
  EstimatorClass<BayesianAlphaBeta<>> bank(
      m, "BayesianAlphaBeta",
      R"(Lines and parabolas through the last plots, weighted by Bayes' rule.

Each member predicts the next plot with a known variance: the plot's, times one plus the member's noise factor. The plot's
likelihood is the evidence, and the right member is a Markov chain. The estimate is the mixture. Like `FuzzyAlphaBeta` it uses
many plots on a straight and few in a turn, but without its usual residual, which a turn inflates, its hold and its hard choice;
parabolas follow a turn. Same interface as `Imm`, with one mode per member: lines first, shorter before longer, then parabolas.

Uses the position of any sensor; innovations are in north and east.

Parameters
----------
min_plots, max_plots : int
    Lengths of the shortest and the longest line, 2 to 16; at most 16 members in all.
parabolas : bool
    Whether there are also parabolas, through at least four plots.
sojourn_s : float
    Mean sojourn of the right member.
longest_line_probability : float
    Prior of the longest line; the other members are equally probable.
acceleration_std_mps2 : float
    Per axis, of a maneuver since the last plot but one: increases the covariance, not used in the weights.

Raises
------
ValueError
    When a parameter makes no sense.)");
  bank.def(
      py::init([](int min_plots, int max_plots, bool parabolas, double sojourn_s, double longest,
                  double acceleration) {
        return PyBayesian(BayesianAlphaBeta<>(LineWeighing{.min_plots = min_plots,
                                                           .max_plots = max_plots,
                                                           .parabolas = parabolas,
                                                           .sojourn_s = sojourn_s,
                                                           .longest_line_probability = longest,
                                                           .acceleration_std_mps2 = acceleration}));
      }),
      py::kw_only(), py::arg("min_plots") = weighing.min_plots,
      py::arg("max_plots") = weighing.max_plots, py::arg("parabolas") = weighing.parabolas,
      py::arg("sojourn_s") = weighing.sojourn_s,
      py::arg("longest_line_probability") = weighing.longest_line_probability,
      py::arg("acceleration_std_mps2") = weighing.acceleration_std_mps2);
  define_copies(bank);
  bank.def("_arguments", [](const PyBayesian& estimator) {
    const LineWeighing& rules = estimator.get().weighing();
    return Arguments()
        .with("min_plots", rules.min_plots)
        .with("max_plots", rules.max_plots)
        .with("parabolas", rules.parabolas)
        .with("sojourn_s", rules.sojourn_s)
        .with("longest_line_probability", rules.longest_line_probability)
        .with("acceleration_std_mps2", rules.acceleration_std_mps2);
  });
  bank.def_property_readonly(
      "plots_of_mode",
      [](const PyBayesian& estimator) {
        const LineWeighing& rules = estimator.get().weighing();
        py::array_t<int> plots(rules.members());
        for (int mode = 0; mode < rules.members(); ++mode)
          plots.mutable_at(mode) = rules.plots_of(mode);
        return plots;
      },
      "(K,) number of plots of each member.");
}

}  // namespace wakeline::python
