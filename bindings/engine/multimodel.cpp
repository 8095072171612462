// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <optional>
#include <type_traits>
#include <variant>
#include <vector>

#include "face.hpp"
#include "multimodel.hpp"
#include "support/option.hpp"
#include "support/types.hpp"
#include "turn_grid.hpp"

namespace wakeline::python {
namespace {

Chain make_chain(const DoubleArray& matrix, const std::optional<double>& period_s) {
  require_shape(matrix.ndim() == 2 && matrix.shape(0) == matrix.shape(1) && matrix.shape(0) > 0 &&
                    matrix.shape(0) <= kMaxModes,
                "matrix", "(K, K), K at most " + std::to_string(kMaxModes), matrix);
  const Chain::Matrix rows = to_matrix("matrix", matrix, matrix.shape(0), matrix.shape(0));
  return period_s ? Chain(rows, *period_s) : Chain(rows);
}

Chain chain_of_generator(const DoubleArray& rates) {
  require_shape(rates.ndim() == 2 && rates.shape(0) == rates.shape(1) && rates.shape(0) > 0 &&
                    rates.shape(0) <= kMaxModes,
                "generator_per_s", "(K, K), K at most " + std::to_string(kMaxModes), rates);
  return Chain::from_generator(to_matrix("generator_per_s", rates, rates.shape(0), rates.shape(0)));
}

Arguments chain_arguments(const Chain& chain) {
  const auto generator_per_s = chain.generator_per_s();
  if (!generator_per_s) return Arguments().with("matrix", chain.transition(0.0));
  return Arguments("from_generator").with("generator_per_s", *generator_per_s);
}

using PyImm = PyEstimator<AnyImm>;

/// The arguments of all estimators over a grid of turn rates.
Arguments grid_arguments(const AnyImm& imm) {
  return Arguments()
      .with("filter", without_turn(imm.bank().filter(0)))
      .with("chain", imm.chain())
      .with("initial_mode_probability", imm.initial_mode_probability());
}

Arguments imm_arguments(const PyImm& estimator) {
  const AnyImm& imm = estimator.get();
  std::vector<AnyFilter> filters;
  for (int k = 0; k < imm.bank().size(); ++k) filters.push_back(imm.bank().filter(k));
  return Arguments()
      .with("filters", filters)
      .with("chain", imm.chain())
      .with("initial_mode_probability", imm.initial_mode_probability());
}

/// Turn rates of the models, none where the rate of one is not known.
std::optional<py::array_t<double>> known_turn_rates(const PyImm& estimator) {
  const AnyImm& imm = estimator.get();
  std::vector<double> rates;
  for (int k = 0; k < imm.bank().size(); ++k)
    std::visit(
        [&]<class Filter>(const Filter& filter) {
          if constexpr (std::is_same_v<typename Filter::Motion, ConstantVelocity>)
            rates.push_back(0.0);
          else if constexpr (requires { filter.motion().turn_rate_rad_s; })
            rates.push_back(filter.motion().turn_rate_rad_s);
        },
        imm.bank().filter(k).variant());
  if (rates.size() != static_cast<std::size_t>(imm.bank().size())) return std::nullopt;
  return array_of(rates);
}

Arguments adaptive_grid_arguments(const PyEstimator<AnyAdaptiveGridImm>& estimator) {
  const AnyAdaptiveGridImm& imm = estimator.get();
  const AdaptiveGrid& grid = imm.grid();
  const AdaptiveGrid::Rates initial = grid.initial();
  return grid_arguments(imm)
      .with("max_turn_rate_rad_s", grid.max_turn_rate_rad_s)
      .with("initial_turn_rates_rad_s", std::vector<double>(initial.begin(), initial.end()))
      .with("min_spacing_rad_s", grid.min_spacing_rad_s)
      .with("kept_spacing_rad_s", grid.kept_spacing_rad_s)
      .with("least_move_rad_s", grid.least_move_rad_s)
      .with("centre_threshold", grid.centre_threshold)
      .with("centre_gain", grid.centre_gain)
      .with("unlikely_threshold", grid.unlikely_threshold)
      .with("likely_threshold", grid.likely_threshold);
}

Arguments switching_grid_arguments(const PyEstimator<AnySwitchingGridImm>& estimator) {
  const AnySwitchingGridImm& imm = estimator.get();
  const SwitchingGrid& grid = imm.grid();
  return grid_arguments(imm)
      .with("grid_rad_s", grid.grid_rad_s.rates_rad_s())
      .with("threshold", grid.threshold)
      .with("rule", word_of(grid.rule))
      .with("carry", word_of(grid.carry))
      .with("initial_centre", grid.initial());
}

Arguments likely_model_set_arguments(const PyEstimator<AnyLikelyModelSetImm>& estimator) {
  const AnyLikelyModelSetImm& imm = estimator.get();
  const LikelyModelSet& set = imm.grid();
  return grid_arguments(imm)
      .with("grid_rad_s", set.grid_rad_s.rates_rad_s())
      .with("unlikely_threshold", set.unlikely_threshold)
      .with("likely_threshold", set.likely_threshold);
}

PyImm make_imm(const std::vector<AnyFilter>& filters, const Chain& chain,
               const std::optional<DoubleArray>& initial) {
  AnyImm imm(chain, AnyFilterBank(filters));
  if (initial)
    imm.set_initial_mode_probability(
        to_vector("initial_mode_probability", *initial, static_cast<py::ssize_t>(filters.size())));
  return imm;
}

void define_adaptive_grid(py::module_& m) {
  const AdaptiveGrid grid;
  EstimatorClass<AnyAdaptiveGridImm> adaptive(m, "AdaptiveGridImm",
                                              R"(Three turn models with adaptive turn rates.

The turn rates move before each prediction that follows an update, by its mode probabilities. Same interface as `Imm`.

The printed rule has centre_threshold 0.3, centre_gain 1, kept_spacing_rad_s 0 and least_move_rad_s 0. Its grid collapses to half of
min_spacing_rad_s on each side, where the rates may differ too little to be distinguished, and nothing opens it again. The
defaults keep it open and move its center slowly.

Parameters
----------
filter : Kalman, Ekf, Ukf or SquareRootUkf over CoordinatedTurn
    What all three models are like; its turn rate does not matter.
max_turn_rate_rad_s : float
    No model turns faster.
initial_turn_rates_rad_s : (3,) array, optional
    Left, centre and right at a start, none less than the one before it; zero and half the maximum to each side when left
    out. Not printed.
min_spacing_rad_s : float
    The least spacing that a move starts from. Not printed.
kept_spacing_rad_s : float
    No side comes nearer to the centre, but for the maximum: what keeps the grid open. Not in the paper: 0.
least_move_rad_s : float
    A grid none of whose rates would move so far stays, which saves time. Not in the paper: 0.
centre_threshold : float
    A centre less probable than this moves towards the mean rate. In the paper 0.3.
centre_gain : float
    How far it moves towards it. Not in the paper: 1, all the way.
unlikely_threshold : float
    Where the centre is the most probable, a side less probable than this comes half way nearer.
likely_threshold : float
    Where a side is the most probable, and more than this, it goes twice as far.
stay_probability : float
    Of the models' chain: to stay; the rest is shared equally by the other models.
chain : ModeChain, optional
    Another chain of three modes, instead of `stay_probability`.
initial_mode_probability : (3,) array, optional
    What a start begins with; 0.9 for the centre when left out. Not printed.

Raises
------
ValueError
    When a parameter makes no sense.

References
----------
Le Minh Hoang, A. A. Konovalov, Dao Van Luc, J. Russian Universities. Radioelectronics, 2023, 26(3), step 1.1.)");
  adaptive.def(
      py::init([](const AnyFilter& filter, double max_rate,
                  const std::optional<DoubleArray>& initial_rates, double min_spacing,
                  double kept_spacing, double least_move, double centre, double gain,
                  double unlikely, double likely, double stay, const std::optional<Chain>& chain,
                  const std::optional<DoubleArray>& initial) {
        AdaptiveGrid grid{.max_turn_rate_rad_s = max_rate,
                          .min_spacing_rad_s = min_spacing,
                          .kept_spacing_rad_s = kept_spacing,
                          .least_move_rad_s = least_move,
                          .centre_threshold = centre,
                          .centre_gain = gain,
                          .unlikely_threshold = unlikely,
                          .likely_threshold = likely};
        if (initial_rates) {
          const Eigen::VectorXd rates = to_vector("initial_turn_rates_rad_s", *initial_rates, 3);
          grid.initial_turn_rates_rad_s = {rates[0], rates[1], rates[2]};
        }
        return PyEstimator<AnyAdaptiveGridImm>(with_initial(
            AnyAdaptiveGridImm(grid, chain_of(chain, stay, 3), turning_bank(filter, 3)), initial));
      }),
      py::arg("filter"), py::kw_only(), py::arg("max_turn_rate_rad_s") = grid.max_turn_rate_rad_s,
      py::arg("initial_turn_rates_rad_s") = py::none(),
      py::arg("min_spacing_rad_s") = grid.min_spacing_rad_s,
      py::arg("kept_spacing_rad_s") = grid.kept_spacing_rad_s,
      py::arg("least_move_rad_s") = grid.least_move_rad_s,
      py::arg("centre_threshold") = grid.centre_threshold,
      py::arg("centre_gain") = grid.centre_gain,
      py::arg("unlikely_threshold") = grid.unlikely_threshold,
      py::arg("likely_threshold") = grid.likely_threshold, py::arg("stay_probability") = 0.9,
      py::arg("chain") = py::none(), py::arg("initial_mode_probability") = py::none());
  define_copies(adaptive);
  define_filter_estimate(adaptive);
  define_turn_rates(adaptive);
  adaptive.def("_arguments", &adaptive_grid_arguments);
}

void define_switching_grid(py::module_& m) {
  const SwitchingGrid grid;
  EstimatorClass<AnySwitchingGridImm> switching(
      m, "SwitchingGridImm", R"(Three turn models in a window on a fixed grid of turn rates.
      
      The window moves before each prediction that follows an update, by its mode probabilities. Same interface as `Imm`.

Parameters
----------
filter : Kalman, Ekf, Ukf or SquareRootUkf over CoordinatedTurn
    What all three models are like; its turn rate does not matter.
grid_rad_s : (3 to 16,) array, optional
    Turn rates, rising; 2.5 deg/s apart up to 5 deg/s to each side when left out.
threshold : float
    A model with a larger probability moves the window. 0.7 in the paper, with which it is often too late.
rule : 'symmetric' or 'literal'
    Left if the left model is above the threshold, right if the right one is, else stay; or as printed: left if the left
    one is, stay if the center is, else right.
carry : 'slot' or 'identity'
    Whether each slot keeps its estimate and probability, or each remaining model does and the entering one starts with
    the combined estimate and the probability of the leaving one. Not printed.
initial_centre : int, optional
    Index of the window's center at a start; default the straightest rate except the ends. Not printed.
stay_probability : float
    Of the models' chain: to stay; the rest is shared equally by the other models.
chain : ModeChain, optional
    Another chain of three modes, instead of `stay_probability`.
initial_mode_probability : (3,) array, optional
    What a start begins with; 0.9 for the centre when left out. Not printed.

Raises
------
ValueError
    When a parameter makes no sense.

References
----------
Le Minh Hoang, A. A. Konovalov, Dao Van Luc, J. Russian Universities. Radioelectronics, 2023, 26(3), step 1.2.)");
  switching.def(
      py::init([](const AnyFilter& filter, const std::optional<DoubleArray>& rates,
                  double threshold, const std::string& rule, const std::string& carry,
                  const std::optional<int>& centre, double stay, const std::optional<Chain>& chain,
                  const std::optional<DoubleArray>& initial) {
        const SwitchingGrid grid{.grid_rad_s = rates ? to_grid(*rates, SwitchingGrid::kLeastRates)
                                                     : SwitchingGrid{}.grid_rad_s,
                                 .threshold = threshold,
                                 .rule = to_option<SwitchRule>("rule", rule),
                                 .carry = to_option<SwitchCarry>("carry", carry),
                                 .initial_centre = centre};
        return PyEstimator<AnySwitchingGridImm>(with_initial(
            AnySwitchingGridImm(grid, chain_of(chain, stay, 3), turning_bank(filter, 3)), initial));
      }),
      py::arg("filter"), py::arg("grid_rad_s") = py::none(), py::kw_only(),
      py::arg("threshold") = grid.threshold, py::arg("rule") = "symmetric",
      py::arg("carry") = "identity", py::arg("initial_centre") = py::none(),
      py::arg("stay_probability") = 0.9, py::arg("chain") = py::none(),
      py::arg("initial_mode_probability") = py::none());
  switching.def_property_readonly("centre", of_kind(&AnySwitchingGridImm::centre),
                                  "Index of the window's center in the grid.");
  define_copies(switching);
  define_filter_estimate(switching);
  define_turn_rates(switching);
  switching.def("_arguments", &switching_grid_arguments);
}

void define_likely_model_set(py::module_& m) {
  const LikelyModelSet set;
  EstimatorClass<AnyLikelyModelSetImm> likely(
      m, "LikelyModelSetImm",
      R"(Turn models that become active and inactive by their probability.

All are active at a start. Before each prediction that follows an update the unlikely ones become inactive and the neighbors
of the likely ones active; the most probable one always has active neighbors. Same interface as `Imm`; an inactive model
has probability 0 and turn rate NaN, and its `filter_estimate` is its last belief.

Parameters
----------
filter : Kalman, Ekf, Ukf or SquareRootUkf over CoordinatedTurn
    What all models are like; its turn rate does not matter.
grid_rad_s : (2 to 16,) array, optional
    Turn rates, rising; 2 deg/s apart up to 4 deg/s to each side when left out.
unlikely_threshold : float
    A model less probable than this becomes inactive.
likely_threshold : float
    The neighbors of a model at least as probable as this become active.
stay_probability : float
    Of the models' chain: to stay; the rest is shared equally by the other active models.
chain : ModeChain, optional
    Another chain of as many modes, instead of `stay_probability`; transitions to inactive models go to the active ones.
initial_mode_probability : (K,) array, optional
    What a start begins with; 0.9 for the straightest when left out.

Raises
------
ValueError
    When a parameter makes no sense.

References
----------
X. R. Li, Y. Zhang, IEEE Trans. AES-36, 2000: the likely-model set.)");
  likely.def(
      py::init([](const AnyFilter& filter, const std::optional<DoubleArray>& rates, double unlikely,
                  double principal, double stay, const std::optional<Chain>& chain,
                  const std::optional<DoubleArray>& initial) {
        LikelyModelSet set{.unlikely_threshold = unlikely, .likely_threshold = principal};
        if (rates) set.grid_rad_s = to_grid(*rates);
        const int models = set.grid_rad_s.size();
        return PyEstimator<AnyLikelyModelSetImm>(with_initial(
            AnyLikelyModelSetImm(set, chain_of(chain, stay, models), turning_bank(filter, models)),
            initial));
      }),
      py::arg("filter"), py::arg("grid_rad_s") = py::none(), py::kw_only(),
      py::arg("unlikely_threshold") = set.unlikely_threshold,
      py::arg("likely_threshold") = set.likely_threshold, py::arg("stay_probability") = 0.9,
      py::arg("chain") = py::none(), py::arg("initial_mode_probability") = py::none());
  define_copies(likely);
  define_filter_estimate(likely);
  define_turn_rates(likely);
  likely.def("_arguments", &likely_model_set_arguments);
}

}  // namespace

void define_multimodel(py::module_& parent) {
  py::module_ m = parent.def_submodule("multimodel", "Estimators with several motion models.");

  py::class_<Chain> chain(
      m, "ModeChain",
      R"(The Markov chain between modes: `matrix[i, j] = P(mode j now | mode i before)`.

Parameters
----------
matrix : (K, K) array
    Rows sum to 1.
period_s : float, optional
    The time step of the matrix; the chain is then in continuous time. Default: the matrix is applied once per
    prediction, whatever its step, so that all steps must be equal; uneven steps and trackers warn of it.

Raises
------
ValueError
    When a row is not a distribution, or no continuous-time chain has this matrix over the period.)");
  define_copies(chain);
  chain.def(py::init(&make_chain), py::arg("matrix"), py::arg("period_s") = py::none())
      .def_static(
          "from_sojourn_s",
          [](const DoubleArray& sojourn_s) {
            const Eigen::VectorXd times = to_vector("sojourn_s", sojourn_s);
            if (times.size() < 1 || times.size() > kMaxModes)
              throw py::value_error("sojourn_s must have 1 to " + std::to_string(kMaxModes) +
                                    " times, got " + std::to_string(times.size()));
            return Chain::from_sojourn_s(ModeVector<double, kRuntimeModes>(times));
          },
          py::arg("sojourn_s"),
          "The chain with a mean sojourn of sojourn_s[k] seconds in mode k and equal transitions "
          "to "
          "the other modes.")
      .def_static(
          "from_generator", &chain_of_generator, py::arg("generator_per_s"),
          "The chain in continuous time with the rate generator_per_s[i, j] from mode i to mode j; "
          "rows sum to 0.")
      .def(
          "transition",
          [](const Chain& chain, double dt_s) {
            require_not_negative("dt_s", dt_s);
            return to_array(chain.transition(dt_s));
          },
          py::arg("dt_s"), "P(dt), (K, K). Raises ValueError for a negative step.")
      .def_property_readonly(
          "modes", [](const Chain& chain) { return chain.modes(); }, "Number of modes, K.")
      .def_property_readonly("continuous", &Chain::continuous,
                             "Whether the chain is in continuous time.")
      .def("_arguments", &chain_arguments);

  py::class_<AnyMixture, AnyEstimator>(m, "MultiModelEstimator",
                                       "What estimators of several models share.")
      .def(
          "mode_probability",
          [](const AnyMixture& estimator) { return to_array(estimator.mode_probability()); },
          "(K,)")
      .def_property_readonly(
          "models", [](const AnyMixture& estimator) { return estimator.mode_probability().size(); },
          "K");

  EstimatorClass<AnyImm> imm(m, "Imm", R"(The interacting multiple model estimator.

Parameters
----------
filters : sequence of K filters
    `Kalman`, `Ekf`, `Ukf`, `SquareRootUkf` and `AlphaBeta`, over any states.
chain : ModeChain
initial_mode_probability : (K,) array, optional
    What a start begins with; uniform when left out.)");
  imm.def(py::init([](const py::sequence& filters, const Chain& chain,
                      const std::optional<DoubleArray>& initial) {
            return make_imm(to_filters(filters), chain, initial);
          }),
          py::arg("filters"), py::arg("chain"), py::arg("initial_mode_probability") = py::none());
  define_copies(imm);
  define_filter_estimate(imm);
  define_imm_smoother(imm);
  imm.def("turn_rates_rad_s", &known_turn_rates,
          "(K,) turn rates of the models, positive to starboard; None if one is unknown.");
  imm.def("_arguments", &imm_arguments);

  define_adaptive_grid(m);
  define_switching_grid(m);
  define_likely_model_set(m);
  define_mode_history(m);
  define_bayesian_alpha_beta(m);
  define_fuzzy_alpha_beta(m);
}

}  // namespace wakeline::python
