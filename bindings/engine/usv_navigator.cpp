// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/navigation/usv_navigator.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "support/arguments.hpp"
#include "support/types.hpp"
#include "wakeline/filter/augmented_ukf.hpp"
#include "wakeline/measurement/fix.hpp"

namespace wakeline::python {
namespace {

using AnyNavigator =
    std::variant<UsvNavigator<UsvMotion, Ekf>, UsvNavigator<UsvMotion, Ukf>,
                 UsvNavigator<UsvMotion, AugmentedUkf>, UsvNavigator<UsvBiasMotion, Ekf>,
                 UsvNavigator<UsvBiasMotion, Ukf>, UsvNavigator<UsvBiasMotion, AugmentedUkf>,
                 UsvNavigator<UsvCurrentMotion, Ekf>, UsvNavigator<UsvCurrentMotion, Ukf>,
                 UsvNavigator<UsvCurrentMotion, AugmentedUkf>>;

struct PyReading : PyStep {
  bool rejected;
  bool widened;
};

template <int M>
PyReading to_reading(const UsvReading<M>& reading) {
  return {to_step<M>(reading), reading.rejected, reading.widened};
}

/// Standard deviations of the readings of a run.
struct ReadingStd {
  Vec<double, 2> gnss_m;
  double compass_rad, velocity_mps, log_mps, rate_of_turn_rad_s;
};

bool all_finite(const double* row, int count) {
  return std::all_of(row, row + count, [](double x) { return std::isfinite(x); });
}

/// A sensor's readings, one row a time, NaN where there is none; empty when it was not there.
struct Column {
  std::optional<DoubleArray> values;
  int width;

  Column(const char* name, std::optional<DoubleArray> given, py::ssize_t rows, int columns)
      : values(std::move(given)), width(columns) {
    if (!values) return;
    const bool fits =
        width == 1 ? values->ndim() == 1 && values->shape(0) == rows
                   : values->ndim() == 2 && values->shape(0) == rows && values->shape(1) == width;
    require_shape(fits, name, width == 1 ? shape_text({rows}) : shape_text({rows, width}), *values);
  }

  /// Row k when all of it is there.
  [[nodiscard]] const double* at(py::ssize_t k) const {
    if (!values) return nullptr;
    const double* row = values->data() + k * width;
    return all_finite(row, width) ? row : nullptr;
  }
};

/// What `run` returns.
struct UsvRun {
  py::array_t<double> mean, covariance;
  std::map<std::string, py::array_t<double>> nis;
  std::map<std::string, py::array_t<bool>> rejected;
};

/// Whether a navigator has the states that a sensor reads.
template <class Navigator, class Sensor>
inline constexpr bool kHas = holds(std::remove_cvref_t<Navigator>::kComponents, Sensor::kReads);

class PyNavigator {
  template <class Visit>
  auto visit(Visit visit) {
    return std::visit(visit, navigator_);
  }

 public:
  /// `arguments` make an equal one.
  template <class Navigator>
  PyNavigator(const Navigator& navigator, const Arguments& arguments)
      : navigator_(navigator), arguments_(arguments) {}

  const Arguments& arguments() const { return arguments_; }

  void archive(Archive& fields) {
    visit([&](auto& navigator) { navigator.archive(fields); });
  }

  void start(const UsvStart& start) {
    validate(start);
    visit([&](auto& navigator) { require_ok(navigator.start(start), "start"); });
  }

  void predict(double dt_s, const std::optional<DoubleArray>& imu) {
    std::optional<Imu> reading;
    if (imu) reading = to_imu(to_vector("imu", *imu, 3).data());
    visit([&](auto& navigator) {
      require_ok(reading ? navigator.predict(dt_s, *reading) : navigator.predict(dt_s), "predict");
    });
  }

  PyReading update_position(const DoubleArray& z, const DoubleArray& std) {
    const Fix fix = gnss(pair("gnss_std_m", std));
    return visit(
        [&](auto& navigator) { return to_reading(navigator.update(fix, pair("position_m", z))); });
  }

  PyReading update_heading(double heading_rad, double std) {
    const Compass compass = validated(Compass(std));
    return visit([&](auto& navigator) {
      return to_reading(navigator.update(compass, Vec<double, 1>(heading_rad)));
    });
  }

  PyReading update_velocity(const DoubleArray& z, double std) {
    require_positive("velocity_std_mps", std);
    return visit([&](auto& navigator) {
      return to_reading(velocity(navigator, pair("velocity_mps", z), std));
    });
  }

  PyReading update_speed(double speed_mps, double std) {
    const SpeedLog log = validated(SpeedLog(std));
    return visit([&](auto& navigator) -> PyReading {
      if constexpr (kHas<decltype(navigator), SpeedLog>)
        return to_reading(navigator.update(log, Vec<double, 1>(speed_mps)));
      else
        throw no_such_state(navigator, "a log", "a speed through water (states 7)");
    });
  }

  PyReading update_rate_of_turn(double rate_rad_s, double gyro_rad_s, double std) {
    return visit([&](auto& navigator) -> PyReading {
      if constexpr (kHas<decltype(navigator), RateOfTurn>)
        return to_reading(navigator.update(
            rate_of_turn(gyro_rad_s, navigator.model().input.noise.yaw_rate_std_rad_s, std),
            Vec<double, 1>(rate_rad_s)));
      else
        throw no_such_state(navigator, "a rate of turn", "a gyro bias (states 7 or 8)");
    });
  }

  int states() const {
    return std::visit([](const auto& navigator) { return navigator.kStates; }, navigator_);
  }

  /// Predicts by a row of the IMU and takes the fix and the heading at the end of the step; each
  /// row that is not finite is missing. Writes the belief into `mean` and `covariance`.
  void step(double dt_s, const double* imu, const double* fix, const double* heading,
            const ReadingStd& std, double* mean, double* covariance) {
    visit([&](auto& navigator) {
      require_ok(
          all_finite(imu, 3) ? navigator.predict(dt_s, to_imu(imu)) : navigator.predict(dt_s),
          "predict");
      const auto accept = [](const auto& reading, const char* what) {
        if (!reading.rejected) require_ok(reading.status, what);
      };
      if (all_finite(fix, 2))
        accept(navigator.update(gnss(std.gnss_m), Vec<double, 2>(fix[0], fix[1])), "gnss");
      if (all_finite(heading, 1))
        accept(navigator.update(Compass(std.compass_rad), Vec<double, 1>(heading[0])), "compass");
      const auto& belief = navigator.estimate();
      std::copy_n(belief.mean.data(), navigator.kStates, mean);
      std::copy_n(belief.covariance.data(), belief.covariance.size(), covariance);  // symmetric
    });
  }

  PyGaussian estimate() const {
    if (!started()) require_ok(Status::kNotStarted, "estimate");
    return std::visit([](const auto& navigator) { return PyGaussian::from(navigator.estimate()); },
                      navigator_);
  }

  bool started() const {
    return std::visit([](const auto& navigator) { return navigator.started(); }, navigator_);
  }

  UsvRun run(const DoubleArray& time_s, const std::optional<DoubleArray>& imu,
             const std::optional<DoubleArray>& gnss, const std::optional<DoubleArray>& compass,
             const std::optional<DoubleArray>& velocity, const std::optional<DoubleArray>& log,
             const std::optional<DoubleArray>& rate_of_turn,
             const std::optional<DoubleArray>& imu_std, const ReadingStd& std, bool smooth) {
    require_shape(time_s.ndim() == 1 && time_s.shape(0) > 0, "time_s", "(T,), T > 0", time_s);
    const py::ssize_t rows = time_s.shape(0);
    for (py::ssize_t k = 0; k < rows; ++k)
      if (!std::isfinite(time_s.at(k)) || (k > 0 && time_s.at(k) < time_s.at(k - 1)))
        throw py::value_error("time_s must be finite and not decrease, got " +
                              std::to_string(time_s.at(k)) + " in row " + std::to_string(k));
    const Readings readings{{"imu", imu, rows, 3},         {"gnss", gnss, rows, 2},
                            {"compass", compass, rows, 1}, {"velocity", velocity, rows, 2},
                            {"log", log, rows, 1},         {"rate_of_turn", rate_of_turn, rows, 1},
                            {"imu_std", imu_std, rows, 2}};
    return visit([&](auto& navigator) {
      using Navigator = std::remove_reference_t<decltype(navigator)>;
      if (!navigator.started()) require_ok(Status::kNotStarted, "run");
      if (log && !kHas<decltype(navigator), SpeedLog>)
        throw no_such_state(navigator, "log", "a speed through water (states 7)");
      if (rate_of_turn && !kHas<decltype(navigator), RateOfTurn>)
        throw no_such_state(navigator, "rate_of_turn", "a gyro bias (states 7 or 8)");
      if (rate_of_turn && !imu)
        throw py::value_error("rate_of_turn must be given together with imu, got imu=None");
      UsvRun run = unread({{"gnss", gnss},
                           {"velocity", velocity},
                           {"compass", compass},
                           {"log", log},
                           {"rate_of_turn", rate_of_turn}},
                          rows);
      std::vector<typename Navigator::State> beliefs;
      std::vector<std::size_t> widened;
      Navigator moved = navigator;
      {
        const py::gil_scoped_release no_python;
        std::vector<typename Navigator::Leg> legs;
        for (py::ssize_t k = 0; k < rows; ++k) {
          if (k > 0) {
            const double dt_s = time_s.at(k) - time_s.at(k - 1);
            const double* motion = readings.imu.at(k);
            legs.push_back(motion ? moved.leg(dt_s, to_imu(motion)) : moved.leg(dt_s));
            if (const double* noise = readings.imu_std.at(k))
              legs.back().input.noise = validated(ImuNoise{noise[0], noise[1]});
            require_ok_in(k, moved.predict(legs.back()), "predict");
          }
          auto* leg = legs.empty() ? nullptr : &legs.back();
          if (take(moved, readings, std, k, run, leg)) widened.push_back(beliefs.size());
          beliefs.push_back(moved.estimate());
        }
        if (smooth) smooth_between(widened, moved, beliefs, legs);
      }
      navigator = moved;
      copy(beliefs, run);
      return run;
    });
  }

 private:
  struct Readings {
    Column imu, gnss, compass, velocity, log, rate_of_turn, imu_std;
  };

  template <class Navigator>
  static py::value_error no_such_state(const Navigator&, const char* what, const char* wanted) {
    return py::value_error(std::string(what) + " needs a navigator with " + wanted + ", got " +
                           std::to_string(Navigator::kStates) + " states");
  }

  static Vec<double, 2> pair(const char* name, const DoubleArray& array) {
    return to_vector(name, array, 2);
  }

  static void validate(const UsvStart& start) {
    for (const double std : start.position_std_m) require_positive("position_std_m", std);
    require_positive("velocity_std_mps", start.velocity_std_mps);
    require_positive("heading_std_rad", start.heading_std_rad);
  }

  static Imu to_imu(const double* row) { return {row[0], row[1], row[2]}; }

  static Fix gnss(const Vec<double, 2>& std) {
    for (const double each : std) require_positive("gnss_std_m", each);
    return {.covariance_m2 = std.cwiseAbs2().asDiagonal()};
  }

  template <class Navigator>
  static UsvReading<2> velocity(Navigator& navigator, const Vec<double, 2>& z, double std) {
    if constexpr (kHas<Navigator, GroundVelocity>)
      return navigator.update(GroundVelocity(std), z);
    else
      return navigator.update(GroundVelocityInCurrent(std), z);
  }

  static RateOfTurn rate_of_turn(double gyro_rad_s, double gyro_std, double std) {
    return validated(RateOfTurn{std, gyro_rad_s, gyro_std});
  }

  /// The scores of the sensors given, of no reading yet.
  static UsvRun unread(const std::map<std::string, std::optional<DoubleArray>>& sensors,
                       py::ssize_t rows) {
    UsvRun run;
    for (const auto& [name, values] : sensors) {
      if (!values) continue;
      run.nis[name] = py::array_t<double>(rows);
      run.rejected[name] = py::array_t<bool>(rows);
      std::fill_n(run.nis[name].mutable_data(), rows, std::nan(""));
      std::fill_n(run.rejected[name].mutable_data(), rows, false);
    }
    return run;
  }

  /// Smooths the rows before, between and from those where the belief was widened, each part by
  /// itself.
  template <class Navigator>
  static void smooth_between(std::vector<std::size_t> ends, const Navigator& navigator,
                             std::span<typename Navigator::State> beliefs,
                             std::span<const typename Navigator::Leg> legs) {
    ends.push_back(beliefs.size());
    std::size_t first = 0;
    for (const std::size_t end : ends) {
      if (end > first)
        require_ok(navigator.smooth(beliefs.subspan(first, end - first),
                                    legs.subspan(first, end - first - 1)),
                   "smooth");
      first = end;
    }
  }

  /// All readings of row k, to which `leg` has led; whether the belief was widened for one of them.
  template <class Navigator>
  static bool take(Navigator& navigator, const Readings& readings, const ReadingStd& std,
                   py::ssize_t k, UsvRun& run, typename Navigator::Leg* leg) {
    bool widened = false;
    const auto note = [&](const char* name, const Column& column, auto update) {
      if (!column.values) return;
      const double* z = column.at(k);
      if (!z) return;
      const auto reading = update(z);
      run.nis[name].mutable_data()[k] = reading.nis;
      run.rejected[name].mutable_data()[k] = reading.rejected;
      widened |= reading.widened;
      if (!reading.rejected) require_ok_in(k, reading.status, name);
    };
    note("gnss", readings.gnss, [&](const double* z) {
      return navigator.update(gnss(std.gnss_m), Vec<double, 2>(z[0], z[1]));
    });
    note("velocity", readings.velocity, [&](const double* z) {
      return velocity(navigator, Vec<double, 2>(z[0], z[1]), std.velocity_mps);
    });
    note("compass", readings.compass, [&](const double* z) {
      return navigator.update(Compass(std.compass_rad), Vec<double, 1>(z[0]));
    });
    if constexpr (kHas<Navigator, SpeedLog>)
      note("log", readings.log, [&](const double* z) {
        return navigator.update(SpeedLog(std.log_mps), Vec<double, 1>(z[0]));
      });
    if constexpr (kHas<Navigator, RateOfTurn>)
      if (const double* motion = readings.imu.at(k)) {
        const double* noise = readings.imu_std.at(k);
        const double gyro_std = noise ? noise[1] : navigator.model().input.noise.yaw_rate_std_rad_s;
        note("rate_of_turn", readings.rate_of_turn, [&](const double* z) {
          const RateOfTurn sensor = rate_of_turn(motion[2], gyro_std, std.rate_of_turn_rad_s);
          const Vec<double, 1> rate(z[0]);
          const auto reading = navigator.update(sensor, rate);
          if (reading && leg) *leg = Navigator::turned_by(sensor, rate, *leg);
          return reading;
        });
      }
    return widened;
  }

  template <class Belief>
  static void copy(const std::vector<Belief>& beliefs, UsvRun& run) {
    constexpr int kN = decltype(Belief::mean)::RowsAtCompileTime;
    const auto rows = static_cast<py::ssize_t>(beliefs.size());
    run.mean = py::array_t<double>({rows, py::ssize_t(kN)});
    run.covariance = py::array_t<double>({rows, py::ssize_t(kN), py::ssize_t(kN)});
    for (std::size_t k = 0; k < beliefs.size(); ++k) {
      std::copy_n(beliefs[k].mean.data(), kN, run.mean.mutable_data() + k * kN);
      std::copy_n(beliefs[k].covariance.data(), kN * kN,
                  run.covariance.mutable_data() + k * kN * kN);  // symmetric
    }
  }

  AnyNavigator navigator_;
  Arguments arguments_;
};

using Array = py::array_t<double>;

/// One step of R navigators with the same states: beliefs (R, N) and (R, N, N).
std::pair<Array, Array> step_navigators(const std::vector<PyNavigator*>& navigators, double dt_s,
                                        const DoubleArray& imu, const DoubleArray& gnss,
                                        const DoubleArray& compass, const ReadingStd& std) {
  const auto runs = static_cast<py::ssize_t>(navigators.size());
  const auto rows_of = [&](const char* name, const DoubleArray& rows, py::ssize_t width) {
    const std::vector<py::ssize_t> wanted =
        width == 1 ? std::vector{runs} : std::vector{runs, width};
    require_shape(shape_of(rows) == wanted, name, shape_text(wanted), rows);
  };
  rows_of("imu", imu, 3);
  rows_of("gnss", gnss, 2);
  rows_of("compass", compass, 1);
  const py::ssize_t n = runs == 0 ? 0 : navigators[0]->states();
  for (const PyNavigator* navigator : navigators)
    if (navigator->states() != n)
      throw py::value_error("navigators must have the same number of states, got " +
                            std::to_string(n) + " and " + std::to_string(navigator->states()));
  Array mean({runs, n}), covariance({runs, n, n});
  double *to_mean = mean.mutable_data(), *to_covariance = covariance.mutable_data();
  for (py::ssize_t r = 0; r < runs; ++r)
    navigators[std::size_t(r)]->step(dt_s, imu.data() + 3 * r, gnss.data() + 2 * r,
                                     compass.data() + r, std, to_mean + n * r,
                                     to_covariance + n * n * r);
  return {std::move(mean), std::move(covariance)};
}

template <class Model>
PyNavigator make(const Model& model, const std::string& filter, const UsvOutliers& outliers,
                 const ImuNoise& unmeasured, const Unscented& unscented,
                 const Arguments& arguments) {
  if (filter == "ekf")
    return PyNavigator(UsvNavigator<Model, Ekf>(model, outliers, unmeasured), arguments);
  if (filter == "ukf")
    return PyNavigator(UsvNavigator<Model, Ukf>(model, outliers, unmeasured, unscented), arguments);
  if (filter == "augmented_ukf")
    return PyNavigator(UsvNavigator<Model, AugmentedUkf>(model, outliers, unmeasured, unscented),
                       arguments);
  throw py::value_error("filter must be 'ekf', 'ukf' or 'augmented_ukf', got " + quoted(filter));
}

}  // namespace

void define_usv_navigator(py::module_& m) {
  using Arrays = std::optional<DoubleArray>;
  py::class_<PyReading, PyStep>(m, "UsvReading", "Outcome of a reading; true if it was accepted.")
      .def_readonly("rejected", &PyReading::rejected, "outside the gate: the belief is unchanged")
      .def_readonly("widened", &PyReading::widened,
                    "outside the gate, but accepted after too many consecutive rejections")
      .def(py::pickle(
          [](const PyReading& r) { return py::make_tuple(fields_of(r), r.rejected, r.widened); },
          [](const py::tuple& fields) {
            return PyReading{step_of(fields[0].cast<py::tuple>()), fields[1].cast<bool>(),
                             fields[2].cast<bool>()};
          }));

  py::class_<UsvRun> run(m, "UsvRun", "Result of `UsvNavigator.run`.");
  define_pickle(run, &UsvRun::mean, &UsvRun::covariance, &UsvRun::nis, &UsvRun::rejected);
  run.def_readonly("mean", &UsvRun::mean, "(T, N)")
      .def_readonly("covariance", &UsvRun::covariance, "(T, N, N)")
      .def_readonly("nis", &UsvRun::nis,
                    "by sensor: (T,) normalized innovations squared, NaN without a reading")
      .def_readonly("rejected", &UsvRun::rejected, "by sensor: (T,) True for a rejected outlier");

  py::class_<PyNavigator> navigator(
      m, "UsvNavigator",
      R"(Own ship's position, motion and heading by IMU, GNSS, compass and log.

States are [north, east, v_north, v_east, heading] for 5, the same followed by the biases [forward,
starboard, gyro] for 8, and [north, east, heading, speed through water, gyro bias, current north,
current east] for 7, which does not use the accelerometers. Metres, seconds, radians; headings in
[-pi, pi].

A reading whose NIS is outside the gate is rejected. After more than `rejections` consecutive
rejections of one sensor the covariance is inflated and the reading accepted, unless it is more than
a million standard deviations off, or positions accepted meanwhile refute it. Then velocities remain
rejected, and compass and log may move only the current, within the gate of `current_std_mps` unless
it was stronger before. Accepted headings refute rates of turn.

It does not detect a frozen receiver; `recording.read_nmea` marks such fixes in a log.

Parameters
----------
states : {5, 7, 8}
filter : {'ekf', 'ukf', 'augmented_ukf'}
    The extended and the unscented filter, which add the noise of the IMU to the covariance, or the
    unscented filter with sigma points for that noise. All agree if turns between readings are small.
acceleration_std_mps2, yaw_rate_std_rad_s : float
    Standard deviation of a reading of the IMU, constant over a step.
unmeasured_acceleration_std_mps2, unmeasured_yaw_rate_std_rad_s : float
    Process noise of a step without a reading of the IMU.
acceleration_bias_std_mps2, gyro_bias_std_rad_s, current_std_mps : float
    Initial standard deviations of biases and current (per axis), whose initial means are zero.
speed_walk_mps, current_walk_mps : float
    Random walks of speed through water and current over 1 s, for 7 states.
turned_at : float
    Point in a step whose heading rotates the acceleration, for 5 and 8 states: 0.5 is its middle, 0
    its start, as in the paper.
gate_probability : float
    Probability that a good reading is inside the gate.
rejections : int
    Consecutive rejections before a reading is accepted; 0: every reading is used as it is.
alpha, beta, kappa : float
    Parameters of the unscented transform.

Raises
------
ValueError
    When a parameter makes no sense.)");
  define_copies(navigator);
  navigator
      .def(py::init([](int states, const std::string& filter, double a_std, double w_std,
                       double blind_a_std, double blind_w_std, double a_bias, double w_bias,
                       double current, double speed_walk, double current_walk, double turned_at,
                       double gate, int rejections, double alpha, double beta, double kappa) {
             const UsvOutliers outliers{ChiSquareGate{gate}, rejections};
             const UsvInput input{{}, {a_std, w_std}, 1.0};
             const Arguments arguments = Arguments()
                                             .with("states", states)
                                             .with("filter", filter)
                                             .with("acceleration_std_mps2", a_std)
                                             .with("yaw_rate_std_rad_s", w_std)
                                             .with("unmeasured_acceleration_std_mps2", blind_a_std)
                                             .with("unmeasured_yaw_rate_std_rad_s", blind_w_std)
                                             .with("acceleration_bias_std_mps2", a_bias)
                                             .with("gyro_bias_std_rad_s", w_bias)
                                             .with("current_std_mps", current)
                                             .with("speed_walk_mps", speed_walk)
                                             .with("current_walk_mps", current_walk)
                                             .with("turned_at", turned_at)
                                             .with("gate_probability", gate)
                                             .with("rejections", rejections)
                                             .with("alpha", alpha)
                                             .with("beta", beta)
                                             .with("kappa", kappa);
             const auto build = [&](auto model) {
               model.input = input;
               return make(model, filter, outliers, {blind_a_std, blind_w_std},
                           {alpha, beta, kappa}, arguments);
             };
             if (states == 5) return build(UsvMotion{.turned_at = turned_at});
             if (states == 8)
               return build(UsvBiasMotion{.acceleration_bias_std_mps2 = a_bias,
                                          .gyro_bias_std_rad_s = w_bias,
                                          .turned_at = turned_at});
             if (states == 7)
               return build(UsvCurrentMotion{.gyro_bias_std_rad_s = w_bias,
                                             .current_std_mps = current,
                                             .speed_walk_mps = speed_walk,
                                             .current_walk_mps = current_walk});
             throw py::value_error("states must be 5, 7 or 8, got " + std::to_string(states));
           }),
           py::arg("states") = 8, py::arg("filter") = "ekf", py::kw_only(),
           py::arg("acceleration_std_mps2") = ImuNoise{}.acceleration_std_mps2,
           py::arg("yaw_rate_std_rad_s") = ImuNoise{}.yaw_rate_std_rad_s,
           py::arg("unmeasured_acceleration_std_mps2") = 0.1,
           py::arg("unmeasured_yaw_rate_std_rad_s") = deg(2.0),
           py::arg("acceleration_bias_std_mps2") = UsvBiasMotion{}.acceleration_bias_std_mps2,
           py::arg("gyro_bias_std_rad_s") = UsvBiasMotion{}.gyro_bias_std_rad_s,
           py::arg("current_std_mps") = UsvCurrentMotion{}.current_std_mps,
           py::arg("speed_walk_mps") = UsvCurrentMotion{}.speed_walk_mps,
           py::arg("current_walk_mps") = UsvCurrentMotion{}.current_walk_mps,
           py::arg("turned_at") = UsvMotion{}.turned_at,
           py::arg("gate_probability") = UsvOutliers{}.gate.probability,
           py::arg("rejections") = UsvOutliers{}.rejections, py::arg("alpha") = Unscented{}.alpha,
           py::arg("beta") = Unscented{}.beta, py::arg("kappa") = Unscented{}.kappa)
      .def("_arguments", &PyNavigator::arguments)
      .def(
          "start",
          [](PyNavigator& self, const DoubleArray& position, const DoubleArray& velocity,
             double heading, const DoubleArray& position_std, double velocity_std,
             double heading_std) {
            self.start({to_vector("position_m", position, 2),
                        to_vector("velocity_mps", velocity, 2), heading,
                        to_vector("position_std_m", position_std, 2), velocity_std, heading_std});
          },
          py::arg("position_m"), py::arg("velocity_mps"), py::arg("heading_rad"), py::kw_only(),
          py::arg("position_std_m") = std::vector<double>{8.0, 7.0},
          py::arg("velocity_std_mps") = UsvStart{}.velocity_std_mps,
          py::arg("heading_std_rad") = UsvStart{}.heading_std_rad,
          "Start at [north, east] m with a velocity over ground [north, east] m/s and a heading.")
      .def("predict", &PyNavigator::predict, py::arg("dt_s"), py::arg("imu") = py::none(),
           "Predict with a reading of the IMU [forward m/s², starboard m/s², yaw rate rad/s], or "
           "without one.")
      .def("update_position", &PyNavigator::update_position, py::arg("position_m"),
           py::arg("gnss_std_m") = std::vector<double>{8.0, 7.0}, "A GNSS position [north, east].")
      .def("update_velocity", &PyNavigator::update_velocity, py::arg("velocity_mps"),
           py::arg("velocity_std_mps") = 0.1, "A velocity over ground [north, east].")
      .def("update_heading", &PyNavigator::update_heading, py::arg("heading_rad"),
           py::arg("heading_std_rad") = deg(1.0), "A compass heading.")
      .def("update_speed", &PyNavigator::update_speed, py::arg("speed_mps"),
           py::arg("speed_std_mps") = 0.1, "A speed through water by the log; 7 states.")
      .def("update_rate_of_turn", &PyNavigator::update_rate_of_turn, py::arg("rate_rad_s"),
           py::arg("gyro_rad_s"), py::arg("rate_std_rad_s") = deg(0.1),
           "A rate of turn at the time of a reading of the IMU's gyro; 7 or 8 states.")
      .def_property_readonly("estimate", &PyNavigator::estimate, "The belief, a Gaussian.")
      .def_property_readonly("started", &PyNavigator::started, "Whether it has a belief.")
      .def(
          "run",
          [](PyNavigator& self, const DoubleArray& time, const Arrays& imu, const Arrays& gnss,
             const Arrays& compass, const Arrays& velocity, const Arrays& log, const Arrays& rate,
             const Arrays& imu_std, const DoubleArray& gnss_std, double compass_std,
             double velocity_std, double log_std, double rate_std, bool smooth) {
            const ReadingStd std{to_vector("gnss_std_m", gnss_std, 2), compass_std, velocity_std,
                                 log_std, rate_std};
            for (const double each : std.gnss_m) require_positive("gnss_std_m", each);
            require_positive("compass_std_rad", compass_std);
            require_positive("velocity_std_mps", velocity_std);
            require_positive("log_std_mps", log_std);
            require_positive("rate_of_turn_std_rad_s", rate_std);
            return self.run(time, imu, gnss, compass, velocity, log, rate, imu_std, std, smooth);
          },
          py::arg("time_s"), py::arg("imu") = py::none(), py::arg("gnss") = py::none(),
          py::arg("compass") = py::none(), py::kw_only(), py::arg("velocity") = py::none(),
          py::arg("log") = py::none(), py::arg("rate_of_turn") = py::none(),
          py::arg("imu_std") = py::none(), py::arg("gnss_std_m") = std::vector<double>{8.0, 7.0},
          py::arg("compass_std_rad") = deg(1.0), py::arg("velocity_std_mps") = 0.1,
          py::arg("log_std_mps") = 0.1, py::arg("rate_of_turn_std_rad_s") = deg(0.1),
          py::arg("smooth") = false,
          R"(Process a log from the current belief, which is that of `time_s[0]`.

Parameters
----------
time_s : (T,) array
    Not decreasing.
imu : (T, 3) array, optional
    Row k is the mean from time k - 1 to time k: [forward m/s², starboard m/s², yaw rate rad/s].
gnss, velocity : (T, 2) array, optional
    Position m and velocity over ground m/s, [north, east].
compass, log, rate_of_turn : (T,) array, optional
    Heading rad, speed through water m/s (7 states), rate of turn rad/s (7 or 8 states); the last is
    ignored in rows without a reading of `imu`.
imu_std : (T, 2) array, optional
    Row k is the standard deviation from time k - 1 to time k of [acceleration m/s², yaw rate rad/s],
    measured or not, instead of the navigator's.
gnss_std_m, compass_std_rad, velocity_std_mps, log_std_mps, rate_of_turn_std_rad_s : float
    Standard deviations; that of gnss is [north, east].
smooth : bool
    Whether the returned beliefs also use later readings, up to one at which the covariance was
    inflated.

In every array a row that is not finite is a missing reading.

Returns
-------
UsvRun

Raises
------
ValueError
    When shapes do not fit, times decrease, a sensor needs a missing state, or `rate_of_turn` is
    given without `imu`.
FilterError
    When the navigator was not started, or a step fails; the navigator is then unchanged.)");

  m.def(
      "step_navigators",
      [](const std::vector<PyNavigator*>& navigators, double dt_s, const DoubleArray& imu,
         const DoubleArray& gnss, const DoubleArray& compass, const DoubleArray& gnss_std,
         double compass_std) {
        const ReadingStd std{to_vector("gnss_std_m", gnss_std, 2), compass_std, {}, {}, {}};
        for (const double each : std.gnss_m) require_positive("gnss_std_m", each);
        require_positive("compass_std_rad", compass_std);
        return step_navigators(navigators, dt_s, imu, gnss, compass, std);
      },
      py::arg("navigators"), py::arg("dt_s"), py::arg("imu"), py::arg("gnss"), py::arg("compass"),
      py::kw_only(), py::arg("gnss_std_m") = std::vector<double>{8.0, 7.0},
      py::arg("compass_std_rad") = deg(1.0),
      R"(One step of many navigators: `predict`, then the readings at the end of the step.

A simulation in closed loop steps all its runs at once with it; a log as a whole is the work of
`UsvNavigator.run`, which gives the same beliefs.

Parameters
----------
navigators : sequence of UsvNavigator
    R started navigators with the same number N of states.
dt_s : float
imu : (R, 3) array
    Means over the step: [forward m/s², starboard m/s², yaw rate rad/s].
gnss : (R, 2) array
    Positions m, [north, east].
compass : (R,) array
    Headings rad.
gnss_std_m, compass_std_rad : float
    Standard deviations; that of gnss is [north, east].

In every array a row that is not finite is a missing reading.

Returns
-------
(mean, covariance)
    (R, N) and (R, N, N).

Raises
------
ValueError
    When shapes do not fit, or the navigators differ in the number of states.
FilterError
    When a navigator was not started, or a step fails; those before it have made their step.)");
}

}  // namespace wakeline::python
