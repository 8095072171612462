// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include <cmath>
#include <tuple>
#include <variant>

#include "support/each.hpp"
#include "support/types.hpp"
#include "wakeline/filter/adaptive_alpha_beta.hpp"
#include "wakeline/filter/alpha_beta_smoother.hpp"
#include "wakeline/filter/exponential_smoother.hpp"
#include "wakeline/filter/three_point_smoother.hpp"
#include "wakeline/filter/window_bank.hpp"

namespace wakeline::python {
namespace {

/// A smoother of a line or of angles, which says nothing before its first reading; `fresh` is what
/// a run begins with, `arguments` are those it was made of.
template <class OfLine, class OfAngles>
struct Either {
  using Variant = std::variant<OfLine, OfAngles>;
  Variant smoother;
  Variant fresh;
  Arguments arguments;
  bool started = false;

  template <class... Settings>
  static Either make(Arguments arguments, bool wrapped, const Settings&... settings) {
    arguments.with("wrapped", wrapped);
    if (wrapped) return {OfAngles(settings...), OfAngles(settings...), arguments};
    return {OfLine(settings...), OfLine(settings...), arguments};
  }

  /// `update(smoother)` with a reading.
  template <class Update>
  void take(Update update) {
    require_ok(std::visit(update, smoother), "update");
    started = true;
  }

  /// `say(smoother)`, NaN before the first reading.
  template <class Say>
  [[nodiscard]] double said(Say say) const {
    return started ? std::visit(say, smoother) : NAN;
  }

  void archive(Archive& fields) {
    fields(started);
    std::visit([&](auto& one) { one.archive(fields); }, smoother);
  }
};

/// Steps of readings (T,), which go forward.
std::vector<double> parse_reading_steps(const DoubleArray& dt_s, py::ssize_t readings) {
  require_shape(dt_s.ndim() == 0 || (dt_s.ndim() == 1 && dt_s.shape(0) == readings), "dt_s",
                "() or " + shape_text({readings}), dt_s);
  std::vector<double> steps;
  for (py::ssize_t k = 0; k < readings; ++k) {
    steps.push_back(dt_s.data()[dt_s.ndim() == 0 ? 0 : k]);
    if (k > 0 && !(steps.back() >= 0.0 && std::isfinite(steps.back())))
      throw py::value_error("dt_s must be finite and not negative, got " +
                            std::to_string(steps.back()));
  }
  return steps;
}

/// One run over T readings; `update(smoother, dt_s, reading)`.
template <class S, class Update>
void run_one(S smoother, const std::vector<double>& steps, const double* reading, double ahead_s,
             double* value, double* rate, double* forecast, Update update) {
  bool started = false;
  double waited_s = 0.0;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    waited_s += k > 0 ? steps[k] : 0.0;
    if (!std::isnan(reading[k])) {
      require_ok(update(smoother, waited_s, reading[k]), ("reading " + std::to_string(k)).c_str());
      waited_s = 0.0;
      started = true;
    }
    value[k] = !started ? NAN : waited_s > 0.0 ? smoother.forecast(waited_s) : smoother.value();
    rate[k] = started ? smoother.rate() : NAN;
    forecast[k] = started ? smoother.forecast(waited_s + ahead_s) : NAN;
  }
}

template <class E, class Update>
std::tuple<Array, Array, Array> run_all(const E& either, const DoubleArray& dt_s,
                                        const DoubleArray& reading, double ahead_s, Update update) {
  require_shape(reading.ndim() > 0, "reading", "(..., T)", reading);
  require_finite("ahead_s", ahead_s);
  const py::ssize_t scans = reading.shape(reading.ndim() - 1);
  const std::vector<double> steps = parse_reading_steps(dt_s, scans);
  Array value(shape_of(reading)), rate(shape_of(reading)), forecast(shape_of(reading));
  for (py::ssize_t at = 0; at < reading.size(); at += scans)
    std::visit(
        [&](const auto& fresh) {
          run_one(fresh, steps, reading.data() + at, ahead_s, value.mutable_data() + at,
                  rate.mutable_data() + at, forecast.mutable_data() + at, update);
        },
        either.fresh);
  return {value, rate, forecast};
}

constexpr const char* kRun = R"(Smooth series of readings, each from a fresh start.

Parameters
----------
dt_s : float or (T,) array
    Steps to the readings; the first one is ignored.
reading : (..., T) array
    NaN where missing: time passes.
ahead_s : float
    Prediction horizon.

Returns
-------
(value, rate, forecast)
    Each (..., T): after each reading, and `ahead_s` later; where a reading is missing, predicted to
    its time. NaN before the first reading.)";

/// What all smoothers offer.
template <class E>
void define_reading(py::class_<E>& smoother) {
  define_copies(smoother);
  smoother.def("_arguments", [](const E& e) { return e.arguments; })
      .def_property_readonly(
          "value", [](const E& e) { return e.said([](const auto& s) { return s.value(); }); },
          "NaN before the first reading")
      .def_property_readonly(
          "rate", [](const E& e) { return e.said([](const auto& s) { return s.rate(); }); },
          "of the value, per second")
      .def(
          "forecast",
          [](const E& e, double ahead_s) {
            return e.said([&](const auto& s) { return s.forecast(ahead_s); });
          },
          py::arg("ahead_s"), "The value `ahead_s` after the newest reading.");
}

template <class E>
void define_smoother(py::class_<E>& smoother) {
  define_reading(smoother);
  smoother
      .def(
          "update",
          [](E& e, double dt_s, double reading) {
            e.take([&](auto& s) { return s.update(dt_s, reading); });
          },
          py::arg("dt_s"), py::arg("reading"),
          "Process a reading, `dt_s` after the previous one; the step of the first is ignored.")
      .def(
          "run",
          [](const E& e, const DoubleArray& dt_s, const DoubleArray& reading, double ahead_s) {
            return run_all(e, dt_s, reading, ahead_s,
                           [](auto& s, double dt, double z) { return s.update(dt, z); });
          },
          py::arg("dt_s"), py::arg("reading"), py::kw_only(), py::arg("ahead_s") = 0.0, kRun);
}

template <class E>
void define_alpha(py::class_<E>& smoother) {
  smoother.def_property_readonly(
      "alpha",
      [](const E& e) { return std::visit([](const auto& s) { return s.alpha(); }, e.smoother); },
      "the last gain");
}

template <class E>
void define_beta(py::class_<E>& smoother) {
  define_alpha(smoother);
  smoother.def_property_readonly(
      "beta",
      [](const E& e) { return std::visit([](const auto& s) { return s.beta(); }, e.smoother); },
      "the last gain of the rate");
}

void define_exponential(py::module_& m) {
  using Plain = Either<ExponentialSmoother<Linear>, ExponentialSmoother<Wrapped>>;
  py::class_<Plain> plain(m, "ExponentialSmoother",
                          R"(Exponential smoothing: x^ += alpha (x - x^), for any time step; (21).

Its forecast is its value.

Parameters
----------
alpha : float
    Above 0 and at most 1.
wrapped : bool
    Readings are angles, radians: values are in -pi .. pi.)");
  plain.def(py::init([](double alpha, bool wrapped) {
              return Plain::make(Arguments().with("alpha", alpha), wrapped, alpha);
            }),
            py::arg("alpha") = 0.5, py::kw_only(), py::arg("wrapped") = false);
  define_smoother(plain);
  define_alpha(plain);

  using Adaptive =
      Either<AdaptiveExponentialSmoother<Linear>, AdaptiveExponentialSmoother<Wrapped>>;
  py::class_<Adaptive> adaptive(
      m, "AdaptiveExponentialSmoother",
      R"(Exponential smoothing with alpha from the response of the line through the last five readings; (23).

Parameters
----------
wrapped : bool
    Readings are angles, radians: values are in -pi .. pi.)");
  adaptive.def(py::init([](bool wrapped) { return Adaptive::make(Arguments(), wrapped); }),
               py::kw_only(), py::arg("wrapped") = false);
  define_smoother(adaptive);
  define_alpha(adaptive);
}

void define_three_point(py::module_& m) {
  using Points = Either<ThreePointSmoother<Linear>, ThreePointSmoother<Wrapped>>;
  const ThreePointSettings defaults;
  py::class_<Points> points(
      m, "ThreePointSmoother",
      R"(Each reading smoothed with its neighbors, at uneven steps; (22), (24), (25).

The value and the rate are those at the reading before the newest. Readings of one time are averaged.

Parameters
----------
weight_before_s, weight_after_s : float
    p: at this step a neighbor has the same weight as the reading itself.
adaptive : bool
    Weights by least squares over five readings instead; (24).
parabola : bool
    The rate is exact for a parabola at any steps, else by Simpson's weights; (25).
wrapped : bool
    Readings are angles, radians: values are in -pi .. pi.

Raises
------
ValueError
    When a weight is negative.)");
  points.def(py::init([](double before, double after, bool adaptive, bool parabola, bool wrapped) {
               return Points::make(Arguments()
                                       .with("weight_before_s", before)
                                       .with("weight_after_s", after)
                                       .with("adaptive", adaptive)
                                       .with("parabola", parabola),
                                   wrapped, ThreePointSettings{before, after, adaptive, parabola});
             }),
             py::kw_only(), py::arg("weight_before_s") = defaults.weight_before_s,
             py::arg("weight_after_s") = defaults.weight_after_s,
             py::arg("adaptive") = defaults.adaptive, py::arg("parabola") = defaults.parabola,
             py::arg("wrapped") = false);
  define_smoother(points);
  points.def_property_readonly(
      "delay_s",
      [](const Points& e) {
        return std::visit([](const auto& s) { return s.delay_s(); }, e.smoother);
      },
      "time between the value and the newest reading");

  const auto three = [](double before, double at, double after, double before_s, double after_s) {
    require_positive("before_s", before_s);
    require_positive("after_s", after_s);
    return ThreePoints<double>{before - at, after - at, before_s, after_s};
  };
  m.def(
      "three_point_rate",
      [three](const DoubleArray& before, const DoubleArray& at, const DoubleArray& after,
              const DoubleArray& before_s, const DoubleArray& after_s, bool parabola) {
        return each(
            [&](double b, double x, double a, double tb, double ta) {
              const ThreePoints<double> points = three(b, x, a, tb, ta);
              return parabola ? points.parabola_rate() : points.simpson_rate();
            },
            before, at, after, before_s, after_s);
      },
      py::arg("before"), py::arg("at"), py::arg("after"), py::arg("before_s"), py::arg("after_s"),
      py::kw_only(), py::arg("parabola") = true,
      R"(Derivative at the middle of three readings at uneven steps; (25).

Parameters
----------
before, at, after : array_like
    The readings.
before_s, after_s : array_like
    The steps between them, positive.
parabola : bool
    b + f - c, exact for a parabola, else 2/3 c + (b + f) / 6, with less noise; b, f and c are the slopes before, after and overall.)");
}

template <class R>
using AnySchedule =
    std::variant<AlphaBetaSmoother<ConstantGains, R>, AlphaBetaSmoother<GrowingMemory, R>,
                 AlphaBetaSmoother<BenedictBordner, R>, AlphaBetaSmoother<CriticallyDamped, R>,
                 AlphaBetaSmoother<TrackingIndex, R>, AlphaBetaSmoother<RangeDependent, R>,
                 AlphaBetaSmoother<RecentMemory, R>>;
using Schedule = std::variant<ConstantGains, GrowingMemory, BenedictBordner, CriticallyDamped,
                              TrackingIndex, RangeDependent, RecentMemory>;

/// One smoother of any schedule.
template <class R>
class ScheduledSmoother {
 public:
  ScheduledSmoother(const Schedule& schedule, double reading_std)
      : smoother_(std::visit(
            [&]<class S>(const S& gains) -> AnySchedule<R> {
              return AlphaBetaSmoother<S, R>(gains, reading_std);
            },
            schedule)) {}
  Status update(double dt_s, double reading, double range_m) noexcept {
    return std::visit([&](auto& s) { return s.update(dt_s, reading, range_m); }, smoother_);
  }
  double value() const noexcept {
    return of([](const auto& s) { return s.value(); });
  }
  double rate() const noexcept {
    return of([](const auto& s) { return s.rate(); });
  }
  double forecast(double ahead_s) const noexcept {
    return of([&](const auto& s) { return s.forecast(ahead_s); });
  }
  void archive(Archive& fields) {
    std::visit([&](auto& s) { s.archive(fields); }, smoother_);
  }

 private:
  template <class Ask>
  double of(Ask ask) const noexcept {
    return std::visit(ask, smoother_);
  }
  AnySchedule<R> smoother_;
};

void define_scheduled(py::module_& m) {
  using Filter = Either<ScheduledSmoother<Linear>, ScheduledSmoother<Wrapped>>;
  py::class_<Filter> filter(
      m, "AlphaBetaSmoother",
      R"(One quantity by an alpha-beta filter whose gains follow a schedule; (26)-(30).

Parameters
----------
gains : GrowingMemory, RecentMemory, RangeDependent, ConstantGains, BenedictBordner, CriticallyDamped or TrackingIndex
    (27) is `GrowingMemory()`, (28) `GrowingMemory(plots_before=1)`, (29) `RecentMemory()`, (30) `RangeDependent()`.
wrapped : bool
    Readings are angles, radians: values are in -pi .. pi.
reading_std : float
    Standard deviation of a reading, for a `TrackingIndex`.

Raises
------
ValueError
    When a parameter makes no sense or gains are not stable.)");
  filter.def(py::init([](const Schedule& gains, bool wrapped, double reading_std) {
               return Filter::make(
                   Arguments().with("gains", gains).with("reading_std", reading_std), wrapped,
                   gains, reading_std);
             }),
             py::arg_v("gains", GrowingMemory{}, "GrowingMemory()"), py::kw_only(),
             py::arg("wrapped") = false, py::arg("reading_std") = 1.0);
  define_reading(filter);
  filter
      .def(
          "update",
          [](Filter& e, double dt_s, double reading, double range_m) {
            e.take([&](auto& s) { return s.update(dt_s, reading, range_m); });
          },
          py::arg("dt_s"), py::arg("reading"), py::kw_only(), py::arg("range_m") = 0.0,
          "Process a reading, `dt_s` after the previous one, of an object at a range.")
      .def(
          "run",
          [](const Filter& e, const DoubleArray& dt_s, const DoubleArray& reading, double ahead_s,
             double range_m) {
            return run_all(e, dt_s, reading, ahead_s,
                           [&](auto& s, double dt, double z) { return s.update(dt, z, range_m); });
          },
          py::arg("dt_s"), py::arg("reading"), py::kw_only(), py::arg("ahead_s") = 0.0,
          py::arg("range_m") = 0.0, kRun);
}

void define_adaptive(py::module_& m) {
  using Adaptive = Either<AdaptiveAlphaBeta<Linear>, AdaptiveAlphaBeta<Wrapped>>;
  py::class_<Adaptive> adaptive(
      m, "AdaptiveAlphaBeta",
      R"(The adaptive alpha-beta filter, in two passes over the last readings; (33).

The first pass has the gains of a growing memory, the second ``alpha = sum((x^ - x~) e) / sum(e²)`` and
``beta = sum(dv e/t) / sum((e/t)²)`` over the first. Readings of one time are averaged.

Parameters
----------
window : int
    Readings of both passes, 3 to 16.
wrapped : bool
    Readings are angles, radians: values are in -pi .. pi.

Raises
------
ValueError
    When the window has fewer or more readings.)");
  adaptive.def(py::init([](int window, bool wrapped) {
                 return Adaptive::make(Arguments().with("window", window), wrapped,
                                       AdaptiveAlphaBetaSettings{window});
               }),
               py::kw_only(), py::arg("window") = AdaptiveAlphaBetaSettings{}.window,
               py::arg("wrapped") = false);
  define_smoother(adaptive);
  define_beta(adaptive);

  using Bank = Either<WindowBank<Linear>, WindowBank<Wrapped>>;
  const WindowBankSettings defaults;
  py::class_<Bank> bank(
      m, "WindowBank",
      R"(The least-squares lines through the last 2, 3, ... readings; the one with the best recent predictions is used.

Short windows follow a maneuver, long ones reduce noise in between; no tuning is needed. Readings of one time are averaged, without
an effect on the choice.

Parameters
----------
max_readings : int
    Length of the longest window, 2 to 32.
memory : float
    Factor of the energy of a window's innovations at each reading (fading memory).
wrapped : bool
    Readings are angles, radians: values are in -pi .. pi.

Raises
------
ValueError
    When a setting makes no sense.)");
  bank.def(py::init([](int most, double memory, bool wrapped) {
             return Bank::make(Arguments().with("max_readings", most).with("memory", memory),
                               wrapped, WindowBankSettings{most, memory});
           }),
           py::kw_only(), py::arg("max_readings") = defaults.max_readings,
           py::arg("memory") = defaults.memory, py::arg("wrapped") = false);
  define_smoother(bank);
  bank.def_property_readonly(
      "window",
      [](const Bank& e) {
        return std::visit([](const auto& s) { return s.window(); }, e.smoother);
      },
      "readings in the selected window");
}

}  // namespace

void define_smoothers(py::module_& filter) {
  define_exponential(filter);
  define_three_point(filter);
  define_scheduled(filter);
  define_adaptive(filter);
}

}  // namespace wakeline::python
