// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "face.hpp"
#include "support/fields.hpp"
#include "support/types.hpp"

namespace wakeline::python {
namespace {

void require_order(int order) {
  if (order != 2 && order != 3)
    throw py::value_error("order must be 2 or 3 states an axis, got " + std::to_string(order));
}

/// A schedule of gains in Python, of two states an axis or of three, too.
template <class Schedule, bool OfThree>
py::class_<Schedule> define_gains(py::handle scope, const char* name, const char* doc,
                                  const StructLooks& looks = {}) {
  auto schedule = define_struct<Schedule>(scope, name, doc, looks);
  schedule.def(
      "gains",
      [](const Schedule& s, int order, std::int64_t reading, double elapsed_s, double std_m,
         double range_m) {
        require_order(order);
        require(reading >= 1, "reading", "1 or more", static_cast<double>(reading));
        require_not_negative("elapsed_s", elapsed_s);
        require_positive("std_m", std_m);
        require_not_negative("range_m", range_m);
        const GainOccasion<double> occasion{static_cast<double>(reading), elapsed_s, std_m,
                                            range_m};
        if constexpr (OfThree) {
          if (order == 3) {
            s.template validate<3>();
            return to_array(s.template gains<3>(occasion));
          }
        } else if (order == 3) {
          throw py::value_error("order must be 2: there are no such gains of three states an axis");
        }
        s.template validate<2>();
        return to_array(s.template gains<2>(occasion));
      },
      py::arg("order") = 2, py::kw_only(), py::arg("reading") = 1, py::arg("elapsed_s") = 1.0,
      py::arg("std_m") = 1.0, py::arg("range_m") = 0.0,
      "[alpha, beta] or, of order 3, [alpha, beta, gamma] for the reading-th reading since the "
      "start, `elapsed_s` after the previous one, with a standard deviation of `std_m`, at a "
      "range.");
  return schedule;
}

void define_schedules(py::module_& m) {
  define_gains<ConstantGains, true>(
      m, "ConstantGains",
      "Constant gains. A filter rejects those that are not stable (`stable_gains`).",
      {.positional = 3});
  define_gains<GrowingMemory, true>(
      m, "GrowingMemory",
      R"(Growing memory: the least-squares line (or parabola) through all readings so far.

With regular steps the filter equals that line exactly, for any start. A missed scan does not count.)");
  define_gains<BenedictBordner, false>(
      m, "BenedictBordner",
      "beta = alpha² / (2 - alpha): the least error after a change of velocity for the noise that "
      "an alpha lets through.",
      {.positional = 1});
  define_gains<CriticallyDamped, true>(
      m, "CriticallyDamped",
      "All poles at theta: the least-squares line or parabola with weights theta a reading back "
      "(fading memory).",
      {.positional = 1});
  define_gains<TrackingIndex, true>(
      m, "TrackingIndex",
      R"(Gains of the steady Kalman filter, by the tracking index: accel_std T² / standard deviation of the reading.

The standard deviation is that of each reading along and across the bearing, so that the gains depend on the range; the index
depends on the step. Source: P. R. Kalata, The tracking index: a generalized parameter for alpha-beta and alpha-beta-gamma target trackers,
IEEE Trans. AES-20, 1984.)",
      {.positional = 1})
      .def(
          "steady_covariance",
          [](const TrackingIndex& schedule, double period_s, double std_m, int order) {
            require_order(order);
            require_positive("period_s", period_s);
            require_positive("std_m", std_m);
            schedule.validate<2>();
            if (order == 3) return to_array(schedule.steady_covariance<3>(period_s, std_m));
            return to_array(schedule.steady_covariance<2>(period_s, std_m));
          },
          py::arg("period_s"), py::arg("std_m"), py::arg("order") = 2,
          "(order, order) covariance of the states of one axis after an update, in the steady "
          "state.");
  define_gains<RangeDependent, false>(
      m, "RangeDependent",
      R"(Gains by range, as in a radar plotting aid: those of `near`, beyond their range in inverse proportion to it, down to `far`.

With D in km, ``alpha = 20 / D`` within 0.2 .. 0.5 and ``beta = 4 / D`` within 0.01 .. 0.2. Source: Hannoshyna, Kalinichenko, Nikitin, (30).)");
  define_gains<RecentMemory, false>(
      m, "RecentMemory",
      R"(Recent memory: the least-squares line through all readings with weights 1, 2, 3, ....

Source: Hannoshyna, Kalinichenko, Nikitin, (29).)");
  define_struct<AdaptiveGains>(
      m, "AdaptiveGains",
      R"(Gains from the last plots: those of a growing memory over a window, each weighted with the squared innovation that it met.

Noise alone makes them about 0.74 and 0.37 with a window of five; a maneuver changes them little. For `AlphaBeta`; of one
quantity see `AdaptiveAlphaBeta`. Source: Hannoshyna, Kalinichenko, Nikitin, (33), in two passes.)");

  m.def(
      "stable_gains",
      [](double alpha, double beta, std::optional<double> gamma) {
        return gamma ? stable_gains(alpha, beta, *gamma) : stable_gains(alpha, beta);
      },
      py::arg("alpha"), py::arg("beta"), py::arg("gamma") = py::none(),
      "Whether a filter with these gains is stable: alpha > 0, beta > 0, 2 alpha + beta < 4 "
      "and, with gamma, 0 < gamma < 4 alpha beta / (2 - alpha).");
}

template <int Order>
using PyAlphaBeta = PyEstimator<AlphaBetaFilter<Order>>;

/// The filter with the process noise given, else that of its gain schedule.
template <int Order>
PyAlphaBeta<Order> make(const GainSchedule<Order>& gains, const std::optional<ProcessNoise>& noise,
                        [[maybe_unused]] double prior_accel_std_mps2) {
  typename AlphaBetaFilter<Order>::Motion motion = AlphaBetaFilter<Order>(gains).motion();
  if (noise) motion.noise = *noise;
  if constexpr (Order == 3) motion.prior_accel_std_mps2 = prior_accel_std_mps2;
  return AlphaBetaFilter<Order>(gains, motion);
}

/// The arguments of both filters.
template <int Order>
Arguments filter_arguments(const PyAlphaBeta<Order>& estimator) {
  const AlphaBetaFilter<Order>& filter = estimator.get();
  return Arguments().with("gains", filter.schedule()).with("noise", filter.motion().noise);
}

}  // namespace

void define_alpha_beta(py::module_& m) {
  define_schedules(m);

  EstimatorClass<AlphaBetaFilter<2>> line(
      m, "AlphaBeta",
      R"(The alpha-beta filter over [x, vx, y, vy], with a gain schedule.

``x += alpha e`` and ``vx += beta e / T`` per axis, with e the innovation in north and east and T the time since the previous
reading, including missed scans; readings within an eighth of a scan count as simultaneous. Covariance, NIS and likelihood are
those of these gains under the given noise, so that it can be compared with a Kalman filter. Uses the position of any sensor.

Parameters
----------
gains : ConstantGains, GrowingMemory, RecentMemory, AdaptiveGains, BenedictBordner, CriticallyDamped, TrackingIndex or RangeDependent
noise : ProcessNoise, optional
    Process noise for the covariance; default that of the tracking index, else `WhiteAcceleration()`.

Raises
------
ValueError
    When a parameter makes no sense or gains are not stable.)");
  line.def(py::init([](const GainSchedule<2>& gains, const std::optional<ProcessNoise>& noise) {
             return make<2>(gains, noise, 0.0);
           }),
           py::arg("gains"), py::kw_only(), py::arg("noise") = py::none());
  define_copies(line);
  line.def("_arguments", [](const PyAlphaBeta<2>& one) { return filter_arguments(one); });

  EstimatorClass<AlphaBetaFilter<3>> parabola(
      m, "AlphaBetaGamma",
      R"(The alpha-beta-gamma filter over [x, vx, ax, y, vy, ay], with a gain schedule.

As `AlphaBeta`, and ``ax += gamma e / (2 T²)``.

Parameters
----------
gains : ConstantGains, GrowingMemory, CriticallyDamped or TrackingIndex
noise : ProcessNoise, optional
    Process noise for the covariance; default that of the tracking index, else `WhiteJerk()`.
prior_accel_std_mps2 : float
    Prior standard deviation of the acceleration, for a start without one.

Raises
------
ValueError
    When a parameter makes no sense or gains are not stable.)");
  parabola.def(py::init([](const GainSchedule<3>& gains, const std::optional<ProcessNoise>& noise,
                           double prior) { return make<3>(gains, noise, prior); }),
               py::arg("gains"), py::kw_only(), py::arg("noise") = py::none(),
               py::arg("prior_accel_std_mps2") = ConstantAcceleration{}.prior_accel_std_mps2);
  define_copies(parabola);
  parabola.def("_arguments", [](const PyAlphaBeta<3>& one) {
    return filter_arguments(one).with("prior_accel_std_mps2",
                                      one.get().motion().prior_accel_std_mps2);
  });
}

}  // namespace wakeline::python
