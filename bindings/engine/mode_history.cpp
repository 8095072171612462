// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <tuple>

#include "multimodel.hpp"
#include "support/types.hpp"
#include "turn_grid.hpp"
#include "wakeline/multimodel/turning_chain.hpp"

namespace wakeline::python {
namespace {

using PyModeHistory = PyEstimator<AnyModeHistory>;

/// One number for each turn rate, where there are any.
std::optional<TurnRateGrid::Rates> for_each_rate(const char* name,
                                                 const std::optional<DoubleArray>& numbers,
                                                 const TurnRateGrid& grid_rad_s) {
  if (!numbers) return std::nullopt;
  const Eigen::VectorXd vector = to_vector(name, *numbers);
  grid_rad_s.require_for_each(name, vector.size());
  return TurnRateGrid::Rates(vector);
}

TurnRateGrid grid_or_default(const std::optional<DoubleArray>& rates) {
  return rates ? to_grid(*rates) : TurnRateGrid::evenly(deg(4.0), 4);
}

void add_tree(Arguments& arguments, const HistoryTree& tree) {
  arguments.with("max_hypotheses", tree.max_hypotheses)
      .with("max_branches", tree.max_branches)
      .with("min_segment_s", tree.min_segment_s)
      .with("merge_distance", tree.merge_distance)
      .with("sibling_distance", tree.sibling_distance)
      .with("switch_time_spread", tree.switch_time_spread)
      .with("negligible_probability", tree.negligible_probability);
}

/// The turn rate that each filter knows, or begins to learn its own about.
template <class Bank>
TurnRateGrid::Rates turn_rates(const Bank& bank) {
  TurnRateGrid::Rates rates_rad_s(bank.size());
  bank.for_each([&]<class Filter>(int k, const Filter& filter) {
    if constexpr (kLearnsTurnRate<Filter>)
      rates_rad_s[k] = filter.motion().prior_turn_rate_rad_s;
    else
      rates_rad_s[k] = filter.motion().turn_rate_rad_s;
  });
  return rates_rad_s;
}

template <class Bank>
TurnRateGrid::Rates deviations(const Bank& bank) {
  TurnRateGrid::Rates std_rad_s(bank.size());
  bank.for_each([&](int k, const auto& filter) { std_rad_s[k] = turn_rate_std_rad_s(filter); });
  return std_rad_s;
}

Arguments arguments_over_filters(const AnyModeHistory& any) {
  return std::visit(
      [&](const auto& history) {
        std::vector<AnyFilter> filters;
        history.bank().for_each(
            [&](int, const auto& filter) { filters.emplace_back(filter, any.linear()); });
        Arguments arguments("of");
        arguments.with("filters", filters)
            .with("chain", history.chain())
            .with("initial_mode_probability", history.initial_mode_probability());
        add_tree(arguments, history.tree());
        return arguments;
      },
      any.variant());
}

Arguments arguments_over_grid(const AnyModeHistory& any, const TurnRateGrid& grid_rad_s) {
  return std::visit(
      [&](const auto& history) {
        const HistoryTree& tree = history.tree();
        const bool pseudo_bayes = tree.pseudo_bayes_order > 0;
        Arguments arguments(pseudo_bayes ? "pseudo_bayes" : "");
        if (pseudo_bayes) arguments.with("order", tree.pseudo_bayes_order);
        const auto& bank = history.bank();
        auto filter = bank.filter(grid_rad_s.straightest() == 0 ? 1 : 0);
        expect_turn_rate(filter, 0.0, turn_rate_std_rad_s(filter));
        arguments.with("filter", AnyFilter(filter, any.linear()))
            .with("grid_rad_s", grid_rad_s.rates_rad_s());
        const auto grid_std_rad_s = deviations(bank);
        if (grid_std_rad_s != history.usual_deviations(grid_rad_s, filter))
          arguments.with("grid_std_rad_s", grid_std_rad_s);
        arguments.with("chain", history.chain())
            .with("initial_mode_probability", history.initial_mode_probability());
        if (!pseudo_bayes) add_tree(arguments, tree);
        return arguments;
      },
      any.variant());
}

Arguments history_arguments(const PyModeHistory& estimator) {
  const AnyModeHistory& any = estimator.get();
  return any.grid_rad_s() ? arguments_over_grid(any, *any.grid_rad_s())
                          : arguments_over_filters(any);
}

HistoryTree tree_of(int max_hypotheses, int max_branches, double min_segment_s,
                    double merge_distance, double sibling_distance, double switch_time_spread,
                    double negligible_probability) {
  return {.max_hypotheses = max_hypotheses,
          .max_branches = max_branches,
          .min_segment_s = min_segment_s,
          .merge_distance = merge_distance,
          .sibling_distance = sibling_distance,
          .switch_time_spread = switch_time_spread,
          .negligible_probability = negligible_probability};
}

}  // namespace

void define_mode_history(py::module_& m) {
  const HistoryTree tree;
  const TurnHabits habits;
  const auto tree_arguments = std::tuple(
      py::arg("max_hypotheses") = tree.max_hypotheses, py::arg("max_branches") = tree.max_branches,
      py::arg("min_segment_s") = tree.min_segment_s,
      py::arg("merge_distance") = tree.merge_distance,
      py::arg("sibling_distance") = tree.sibling_distance,
      py::arg("switch_time_spread") = tree.switch_time_spread,
      py::arg("negligible_probability") = tree.negligible_probability);
  EstimatorClass<AnyModeHistory> history(m, "ModeHistory",
                                         R"(A tree of turn-rate histories without mixing.

Each hypothesis is one filter with its history. In a prediction every hypothesis keeps its turn rate or switches to another one; an
update weights the hypotheses by their likelihood, merges similar ones and keeps the likeliest. Same interface as `Imm`;
`mode_probability` has one number per turn rate of the grid.

Parameters
----------
filter : Kalman, Ekf, Ukf or SquareRootUkf over CoordinatedTurn, or Ekf, Ukf or SquareRootUkf over CoordinatedTurnRate
    Prototype of the hypotheses; its turn rate does not matter. Over CoordinatedTurnRate each hypothesis learns its rate: when it
    enters a mode, it starts at the rate of the grid with `prior_turn_rate_std_rad_s` (the straightest with a tenth of it); the
    estimated rate is in the state. A fifth of the grid's step, and `turn_rate_psd_rad2s3` of 0, keep the modes distinct.
grid_rad_s : (2 to 16,) array, optional
    Increasing turn rates; default -4 to 4 degrees per second in steps of 1.
grid_std_rad_s : (K,) array, optional
    For filters over CoordinatedTurnRate: initial standard deviation of the rate around each rate of the grid, instead of
    `prior_turn_rate_std_rad_s` and a tenth of it. Nearly zero (1e-4 rad/s) at known rates and more at some between them, which
    are then learnt, is nearly as good as either alternative where that one is right.
grid_weight : (K,) array, optional
    Relative frequency of each rate among turns; that of the straightest does not matter. Default: all equal.
straight_sojourn_s, turn_sojourn_s : float
    Mean sojourn on a straight (the straightest rate of the grid) and in a turn, after `min_segment_s`. The defaults suit small
    craft that turn often; ships go straight for minutes.
straighten_probability : float
    Probability that a turn ends in a straight; other turns are equally probable.
chain : ModeChain, optional
    Another chain, instead of those three and `grid_weight`.
initial_mode_probability : (K,) array, optional
    Initial probabilities; default 0.9 for the straightest.
    max_hypotheses : int
    Maximum kept after an update; at least K.
max_branches : int
    Maximum filtered in a scan, at most 256: the kept hypotheses and their likeliest switches.
min_segment_s : float
    Minimum time between switches.
merge_distance : float
    Hypotheses of one turn rate within this Mahalanobis distance (in the covariance of the more probable one) merge; 0: none.
sibling_distance : float
    The same for hypotheses that switched to it in one scan and differ only before that; at least `merge_distance`.
switch_time_spread : float
    Uncertainty of the switch time within a scan: this share, 0 to 1, of the variance of a uniform time.
negligible_probability : float
    Less probable hypotheses are dropped.

Raises
------
ValueError
    When a parameter makes no sense.

References
----------
G. A. Ackerson, K. S. Fu, IEEE Trans. Automatic Control 15, 1970; J. K. Tugnait, Automatica 18, 1982; D. J. Salmond, Proc. SPIE
1305, 1990.)");
  std::apply(
      [&](const auto&... of_the_tree) {
        history.def(
            py::init([](const AnyFilter& filter, const std::optional<DoubleArray>& rates,
                        const std::optional<DoubleArray>& deviation,
                        const std::optional<DoubleArray>& weight, double straight, double turn,
                        double straighten, const std::optional<Chain>& chain,
                        const std::optional<DoubleArray>& initial, int max_hypotheses,
                        int max_branches, double min_segment, double merge_distance,
                        double sibling_distance, double spread, double negligible) {
              const TurnRateGrid grid = grid_or_default(rates);
              const TurnHabits habits{straight, turn, straighten};
              const TurnRateGrid::Rates weights =
                  for_each_rate("grid_weight", weight, grid)
                      .value_or(TurnRateGrid::Rates::Ones(grid.size()));
              return PyModeHistory(with_initial(
                  AnyModeHistory(tree_of(max_hypotheses, max_branches, min_segment, merge_distance,
                                         sibling_distance, spread, negligible),
                                 grid, chain ? *chain : turning_chain(grid, habits, weights),
                                 filter, for_each_rate("grid_std_rad_s", deviation, grid)),
                  initial));
            }),
            py::arg("filter"), py::arg("grid_rad_s") = py::none(), py::kw_only(),
            py::arg("grid_std_rad_s") = py::none(), py::arg("grid_weight") = py::none(),
            py::arg("straight_sojourn_s") = habits.straight_sojourn_s,
            py::arg("turn_sojourn_s") = habits.turn_sojourn_s,
            py::arg("straighten_probability") = habits.straighten_probability,
            py::arg("chain") = py::none(), py::arg("initial_mode_probability") = py::none(),
            of_the_tree...);
        history.def_static(
            "of",
            [](const py::sequence& filters, const Chain& chain,
               const std::optional<DoubleArray>& initial, int max_hypotheses, int max_branches,
               double min_segment, double merge_distance, double sibling_distance, double spread,
               double negligible) {
              return PyModeHistory(with_initial(
                  AnyModeHistory(tree_of(max_hypotheses, max_branches, min_segment, merge_distance,
                                         sibling_distance, spread, negligible),
                                 chain, to_filters(filters)),
                  initial));
            },
            py::arg("filters"), py::arg("chain"), py::arg("initial_mode_probability") = py::none(),
            py::kw_only(), of_the_tree...,
            R"(A tree whose modes differ in turn rate and noise.

Parameters
----------
filters : sequence of 1 to 16 filters
    One per mode, of one kind (Kalman, Ekf, Ukf or SquareRootUkf), all over CoordinatedTurn or all over
    CoordinatedTurnRate. In the latter case a straight has a prior rate of 0, `prior_turn_rate_std_rad_s` of nearly zero and
    `turn_rate_psd_rad2s3` of 0; a hypothesis adopts the rate of a mode when it enters it, unless the previous mode had the
    same prior.
chain : ModeChain
    Of as many modes.
initial_mode_probability : (K,) array, optional
    Mode probabilities at a start; equal by default.
max_hypotheses, max_branches, min_segment_s, merge_distance, sibling_distance, switch_time_spread, negligible_probability
    As of the class.

Raises
------
TypeError
    When `filters` is not a sequence of filters.
ValueError
    When the filters are of different kinds, or a parameter is invalid.)");
      },
      tree_arguments);
  history.def_static(
      "pseudo_bayes",
      [](int order, const AnyFilter& filter, const std::optional<DoubleArray>& rates, double stay,
         const std::optional<Chain>& chain, const std::optional<DoubleArray>& initial) {
        const TurnRateGrid grid = grid_or_default(rates);
        if (order > 1 && std::pow(grid.size(), order) > 256)
          throw py::value_error("order " + std::to_string(order) + " over " +
                                std::to_string(grid.size()) +
                                " turn rates needs more than 256 filters in a scan");
        return PyModeHistory(
            with_initial(AnyModeHistory(HistoryTree::pseudo_bayes(order, grid.size()), grid,
                                        chain_of(chain, stay, grid.size()), filter),
                         initial));
      },
      py::arg("order"), py::arg("filter"), py::arg("grid_rad_s") = py::none(), py::kw_only(),
      py::arg("stay_probability") = 0.9, py::arg("chain") = py::none(),
      py::arg("initial_mode_probability") = py::none(),
      R"(The generalized pseudo-Bayes estimator of an order: GPB1, GPB2, ...
      
      Histories with the same last ``order - 1`` turn rates merge in every scan.

Parameters
----------
order : int
    1 or more, 2 or more over CoordinatedTurnRate; K to the power of it is at most 256.
filter, grid_rad_s, chain, initial_mode_probability
    As of the class.
stay_probability : float
    Of the turn rates' chain where none is given: to stay; the rest is shared equally by the others.

Raises
------
ValueError
    When a parameter makes no sense.

References
----------
Bar-Shalom, Li, Kirubarajan, Estimation with Applications to Tracking and Navigation, 2001, 11.6.3-11.6.5.)");
  define_copies(history);
  history.def("_arguments", &history_arguments);
  history.def(
      "turn_rates_rad_s",
      [](const PyModeHistory& one) {
        return std::visit([](const auto& history) { return to_array(turn_rates(history.bank())); },
                          one.get().variant());
      },
      "(K,) turn rates of the modes, positive to starboard. Learnt rates are in the state.");
  history.def_property_readonly("hypothesis_count", of_kind(&AnyModeHistory::hypotheses),
                                "Current number of hypotheses.");
}

}  // namespace wakeline::python
