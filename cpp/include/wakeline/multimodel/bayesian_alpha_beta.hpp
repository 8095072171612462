// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "wakeline/core/fields.hpp"
#include "wakeline/multimodel/line_estimator.hpp"

namespace wakeline {

/// The polynomials of a `BayesianAlphaBeta` and their persistence.
struct LineWeighing {
  static constexpr int kMaxPlots = 16;
  static constexpr int kLeastOfParabola = 4;  ///< through three plots it would follow their noise

  int min_plots = 2;
  int max_plots = 10;
  bool parabolas = true;
  double sojourn_s = 30.0;
  double longest_line_probability = 0.4;
  double acceleration_std_mps2 = 0.15;

  static constexpr auto fields() noexcept {
    using L = LineWeighing;
    return field_table(
        field("min_plots", &L::min_plots, between(2, kMaxPlots), "plots",
              "Plots of the shortest line."),
        field("max_plots", &L::max_plots, between(2, kMaxPlots), "plots",
              "Plots of the longest line and of the longest parabola; at least min_plots."),
        field("parabolas", &L::parabolas, "There are parabolas through four plots and more, too."),
        field("sojourn_s", &L::sojourn_s, kTime, "s",
              "Mean time until another line or parabola is the right one."),
        field("longest_line_probability", &L::longest_line_probability, inside(0, 1), "1",
              "Prior probability of the longest line; the others have equal shares."),
        field("acceleration_std_mps2", &L::acceleration_std_mps2, kNotNegative, "m/s²",
              "Standard deviation, per axis, of a maneuver that began at the last plot but one: it "
              "widens the covariance and does not count in weighing."));
  }

  [[nodiscard]] int lines() const noexcept { return max_plots - min_plots + 1; }
  /// Number of plots of the shortest parabola.
  [[nodiscard]] int first_parabola() const noexcept {
    return std::max(min_plots, kLeastOfParabola);
  }
  /// Number of lines and parabolas.
  [[nodiscard]] int members() const noexcept {
    return lines() + (parabolas ? std::max(max_plots - first_parabola() + 1, 0) : 0);
  }
  /// Number of plots of a member: lines first, shorter before longer.
  [[nodiscard]] int plots_of(int member) const noexcept {
    return member < lines() ? min_plots + member : first_parabola() + member - lines();
  }

  friend bool operator==(const LineWeighing&, const LineWeighing&) = default;

  /// Throws `std::invalid_argument` when a parameter is invalid.
  void validate() const {
    validate_fields(*this);
    require(max_plots >= min_plots, "max_plots", "at least min_plots", max_plots);
    require(members() <= kMaxModes, "max_plots", "so few that there are at most 16 members",
            max_plots);
  }
};

/// Lines and parabolas through the last 2, 3, ... plots, weighted by Bayes' rule.
///
/// Like `FuzzyAlphaBeta` it uses many plots on a straight and few in a turn, but without an
/// estimate of the usual residual, which a turn inflates, without holding the choice for a scan,
/// and without a hard choice. Each member predicts the next plot with a known error: the noise of
/// the plot times `1 + position_factor`; the likelihood of the plot is the evidence for it. From
/// scan to scan a member stays the correct one with probability exp(-dt / sojourn), else it is
/// drawn from the prior. The estimate is the mixture of the members. A parabola follows a turn that
/// a line cuts.
///
/// One mode per member: lines first, shorter before longer, then parabolas. A member without enough
/// plots has probability 0; before there are any plots the shortest line has probability 1.
/// O(max_plots) per scan, no heap; the only factorisation is that of the plot's covariance.
template <class ScalarType = double>
class BayesianAlphaBeta
    : public LineEstimator<BayesianAlphaBeta<ScalarType>, LineWeighing::kMaxPlots, ScalarType> {
  using Base = LineEstimator<BayesianAlphaBeta, LineWeighing::kMaxPlots, ScalarType>;
  friend Base;

 public:
  using typename Base::Mask;
  using typename Base::Probability;
  using typename Base::Scalar;

  /// Throws `std::invalid_argument` when a parameter is invalid.
  explicit BayesianAlphaBeta(const LineWeighing& weighing = {})
      : Base(validated(weighing).max_plots, weighing.min_plots, weighing.acceleration_std_mps2),
        weighing_(weighing) {
    const int members = weighing_.members();
    const double longest = members > 1 ? weighing_.longest_line_probability : 1.0;
    prior_ = Probability::Constant(members, Scalar((1.0 - longest) / std::max(members - 1, 1)));
    prior_[weighing_.lines() - 1] = Scalar(longest);
    begin();
  }

  /// Saves or restores the state; fails with different parameters.
  void archive(Archive& fields) {
    fields.rules(weighing_);
    BayesianAlphaBeta loaded = *this;
    loaded.archive_plots(fields);
    fields(loaded.weight_);
    const bool weighs = loaded.weight_.minCoeff() >= Scalar(0) && loaded.weight_.sum() > Scalar(0);
    if (!(weighs && is_finite(loaded.weight_))) fields.fail();
    if (!fields.loading() || !fields.ok()) return;
    *this = loaded;
    this->refresh();
  }

  /// One probability for each member.
  [[nodiscard]] const Probability& mode_probability() const noexcept { return probability_; }
  [[nodiscard]] const LineWeighing& weighing() const noexcept { return weighing_; }

 private:
  void begin() noexcept {
    weight_ = prior_;
    begin_probability();
  }

  void pass(Scalar dt_s) noexcept {
    using std::exp;
    const Scalar stay = exp(-dt_s / Scalar(weighing_.sojourn_s));
    weight_ = stay * weight_ + (Scalar(1) - stay) * prior_;
  }

  [[nodiscard]] const Probability& evaluation() const noexcept { return weight_; }
  void set_evaluation(const Mask& lanes, const Probability& weight) noexcept {
    for (Eigen::Index k = 0; k < weight_.size(); ++k)
      weight_[k] = select(lanes, weight[k], weight_[k]);
  }

  /// Bayes' rule over the members that predicted the plot, with N(v; 0, (1 + f) R) up to a common
  /// factor; the probability of the others does not change.
  void evaluate(const Gaussian<2, Scalar>& plot, const Mask& lanes) noexcept {
    const Cholesky<2, Scalar> factor(plot.covariance);
    std::array<Likelihood<Scalar>, kMaxModes> likelihood;
    Scalar predicted = Scalar(0);
    for_each_member([&](int member, const Line<Scalar>& line, const Mask& exists) {
      predicted += select(exists, weight_[member], Scalar(0));
      const Scalar spread = Scalar(1) + line.position_factor;
      const Vec<Scalar, 2> innovation = plot.mean - line.position_m;
      likelihood[static_cast<std::size_t>(member)] = {select(exists, Scalar(1) / spread, Scalar(0)),
                                                      factor.squared_norm(innovation) / spread};
    });
    Probability after = weight_;
    const auto count = static_cast<std::size_t>(weighing_.members());
    const Scalar logarithm = reweigh<kMaxModes, Scalar>(
        {after.data(), count}, [&](std::size_t member) { return likelihood[member]; });
    const Mask evaluated = lanes && factor.ok() && logarithm != Scalar(kImpossible<Scalar>);
    for_each_member([&](int member, const Line<Scalar>&, const Mask& exists) {
      weight_[member] = select(evaluated && exists, after[member] * predicted, weight_[member]);
    });
  }

  /// Sets the belief to the mixture of the members with enough plots.
  void update_belief() noexcept {
    Scalar total = Scalar(0);
    for_each_member([&](int member, const Line<Scalar>&, const Mask& exists) {
      total += select(exists, weight_[member], Scalar(0));
    });
    auto& mixture = this->belief_;
    mixture = zero_like(mixture);
    begin_probability();
    for_each_member([&](int member, const Line<Scalar>& line, const Mask& exists) {
      const Scalar share = select(exists, weight_[member] / total, Scalar(0));
      mixture.mean += share * line.mean();
      probability_[member] = select(this->ready(), share, probability_[member]);
    });
    const auto acceleration_std_mps2 = Scalar(weighing_.acceleration_std_mps2);
    for_each_member([&](int member, const Line<Scalar>& line, const Mask&) {
      const Vec<Scalar, 4> d = line.mean() - mixture.mean;
      line.for_each_covariance(acceleration_std_mps2, [&](int row, int column, Scalar element) {
        mixture.covariance(row, column) += probability_[member] * (element + d[row] * d[column]);
      });
    });
    mirror_lower<Scalar, 4>(mixture.covariance);
  }

  void begin_probability() noexcept { probability_ = Probability::Unit(weighing_.members(), 0); }

  /// Calls `f(member, line, exists)` for every member with enough plots in some lane; parabolas are
  /// passed as lines.
  template <class Function>
  void for_each_member(Function&& function) const noexcept {
    for (int member = 0; member < weighing_.members(); ++member) {
      const int plots = weighing_.plots_of(member);
      if (plots > this->bank_.size()) continue;
      const Line<Scalar>& line = this->lines_[static_cast<std::size_t>(plots - 2)];
      const Mask exists = this->bank_.holds(plots);
      if (member < weighing_.lines())
        function(member, line, exists);
      else
        function(member, line.parabola(), exists);
    }
  }

  LineWeighing weighing_;
  Probability prior_;
  Probability weight_;       ///< of all members, including those without enough plots
  Probability probability_;  ///< of those with enough plots
};

}  // namespace wakeline
