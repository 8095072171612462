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
                                         R"(A tree of histories of turn rates, not mixed.

Each hypothesis is one filter with its own past. A prediction lets every hypothesis keep its turn rate or take another one; an
update weighs the hypotheses by their likelihood, joins those that have become alike and keeps the likeliest. Has the face of
`Imm`; `mode_probability` has one number for each turn rate of the grid.

Parameters
----------
filter : Kalman, Ekf, Ukf or SquareRootUkf over CoordinatedTurn, or Ekf, Ukf or SquareRootUkf over CoordinatedTurnRate
    What every hypothesis is like; its turn rate does not matter. Over CoordinatedTurnRate each learns its own rate: one that
    comes into a mode begins at the rate of the grid, with `prior_turn_rate_std_rad_s` (the straightest with a tenth of
    it); what it has learnt is in the state. A fifth of the grid's step, and `turn_rate_psd_rad2s3` of 0, keep the modes
    apart.
grid_rad_s : (2 to 16,) array, optional
    Turn rates, rising; -4 to 4 degrees a second in steps of 1 when left out.
grid_std_rad_s : (K,) array, optional
    Of filters over CoordinatedTurnRate, how far the rate may be off each of the grid when a turn begins, instead of
    `prior_turn_rate_std_rad_s` and a tenth of it. Next to none (1e-4 rad/s) at rates that vessels are known to turn at, and
    more at some between them, which learn theirs, is nearly as good as either where either is right.
grid_weight : (K,) array, optional
    How usual each rate is among turns, as parts of their sum; that of the straightest does not matter. All alike when left out.
straight_sojourn_s, turn_sojourn_s : float
    Mean time on a straight (the straightest rate of the grid) and in a turn, once it may end. The defaults suit small
    craft that turn often; ships go straight for minutes.
straighten_probability : float
    That a turn ends in a straight; other turns are alike.
chain : ModeChain, optional
    Another chain, instead of those three and `grid_weight`.
initial_mode_probability : (K,) array, optional
    What a start begins with; 0.9 for the straightest when left out.
max_hypotheses : int
    Kept after an update; K or more.
max_branches : int
    Filtered in a scan, at most 256: what was kept, and the likeliest switches from it that there is room for.
min_segment_s : float
    A turn rate that is younger does not change.
merge_distance : float
    Hypotheses of one turn rate that are nearer join, around the heavier one: the Mahalanobis distance in its covariance; 0 joins none.
sibling_distance : float
    The same for those that came to it in one scan and differ only in what came before; `merge_distance` or more.
switch_time_spread : float
    Uncertainty of when in the scan a switch came: this part, 0 to 1, of the variance of a time uniform in it.
negligible_probability : float
    Hypotheses that have less are dropped.

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
            R"(A tree whose modes differ in more than their turn rate: in their noise, too.

Parameters
----------
filters : sequence of 1 to 16 filters
    One for each mode, of one kind (Kalman, Ekf, Ukf or SquareRootUkf), all over CoordinatedTurn or all over
    CoordinatedTurnRate. Of these, a straight is one about 0 whose `prior_turn_rate_std_rad_s` is next to none and whose
    `turn_rate_psd_rad2s3` is 0; a hypothesis takes the rate of a mode up when it comes into it, unless the one that it leaves
    had the same prior.
chain : ModeChain
    Of as many modes.
initial_mode_probability : (K,) array, optional
    What a start begins with; all alike when left out.
max_hypotheses, max_branches, min_segment_s, merge_distance, sibling_distance, switch_time_spread, negligible_probability
    As of the class.

Raises
------
TypeError
    When `filters` is no sequence, or one of them is no filter.
ValueError
    When the filters are not alike, or a parameter makes no sense.)");
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
      R"(The generalised pseudo-Bayes estimator of an order: GPB1, GPB2, ...

Histories with the same last ``order - 1`` turn rates join in every scan.

Parameters
----------
order : int
    1 or more, 2 or more over CoordinatedTurnRate; K to the power of it is at most 256.
filter, grid_rad_s, chain, initial_mode_probability
    As of the class.
stay_probability : float
    Of the turn rates' chain where none is given: to stay, the rest to each other one alike.

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
      "(K,) turn rates of the modes, positive to starboard. Those learnt are in the state.");
  history.def_property_readonly("hypothesis_count", of_kind(&AnyModeHistory::hypotheses),
                                "How many there are at present.");
}

}  // namespace wakeline::python
