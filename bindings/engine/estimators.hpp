// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// What the bindings of filters, multi-model estimators and trackers share.
#pragma once

#include <optional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "catalog.hpp"
#include "custom.hpp"
#include "support/arguments.hpp"
#include "support/types.hpp"

namespace wakeline::python {

/// A Kalman, Ekf, Ukf, SquareRootUkf or AlphaBeta.
template <>
struct AsPython<AnyFilter> {
  static py::object of(const AnyFilter& filter);
};

/// True of an estimator whose modes change once per prediction, so that their probabilities depend
/// on how time is divided into steps: its chain is a matrix without a period, and two transitions
/// differ from one.
bool changes_per_prediction(const AnyEstimator& estimator);

/// Warns of such an estimator: `steps` says what it is used with, "steps of 3 s and 1 s".
void warn_of_steps(const AnyEstimator& estimator, const std::string& steps);

/// An estimator of several models in Python.
struct AnyMixture : AnyEstimator {
  using AnyEstimator::AnyEstimator;

  /// Warns at the first step that is not about as long as the first one.
  void note_step(double dt_s);

 private:
  double first_step_s_ = 0.0;
  bool warned_ = false;
};

/// True where two steps differ by more than a radar's period does.
inline bool are_uneven(double shortest_s, double longest_s) {
  return shortest_s > 0.0 && longest_s > 1.25 * shortest_s;
}

/// One kind of estimator in Python: a class of its own, all over the one composed at run time.
template <class KindType>
class PyEstimator
    : public std::conditional_t<WeighsAlternatives<KindType>, AnyMixture, AnyEstimator> {
  using Base = std::conditional_t<WeighsAlternatives<KindType>, AnyMixture, AnyEstimator>;

 public:
  using Kind = KindType;
  // NOLINTNEXTLINE(google-explicit-constructor): the same estimator.
  PyEstimator(const Kind& estimator) : Base(estimator) {}

  [[nodiscard]] const Kind& get() const { return std::get<Kind>(this->variant()); }
};

/// A constant member function of the estimator, called on its Python object.
template <class Kind, class Result>
auto of_kind(Result (Kind::*member)() const noexcept) {
  return [member](const PyEstimator<Kind>& estimator) { return (estimator.get().*member)(); };
}

/// The Python object of an estimator.
inline py::object to_python(const AnyEstimator& any) {
  return std::visit(
      []<class Kind>(const Kind& estimator) -> py::object {
        return py::cast(PyEstimator<Kind>(estimator));
      },
      any.variant());
}

/// "Ekf".
inline std::string class_name(const py::handle& object) {
  return py::str(py::type::handle_of(object).attr("__name__")).cast<std::string>();
}

template <class Class>
std::string class_name_of() {
  return py::str(py::type::of<Class>().attr("__name__")).cast<std::string>();
}

/// Whether a Python object is a `Class`. (`py::isinstance` looks the type up by its name each
/// time.)
template <class Class>
bool is_a(const py::handle& object) {
  static PyTypeObject* const type = reinterpret_cast<PyTypeObject*>(py::type::of<Class>().ptr());
  return PyObject_TypeCheck(object.ptr(), type) != 0;
}

/// The C++ object behind a Python one, where it is one of a list of types.
template <class... Types>
std::optional<std::variant<Types...>> found_in(TypeList<Types...>, const py::handle& object) {
  std::optional<std::variant<Types...>> found;
  (void)((is_a<Types>(object) && (found = object.cast<const Types&>(), true)) || ...);
  return found;
}

/// The same. Throws TypeError that names the types where it is none of them.
template <class... Types>
std::variant<Types...> one_of(TypeList<Types...> types, const char* argument,
                              const py::handle& object) {
  if (const auto found = found_in(types, object)) return *found;
  std::string names;
  int left = sizeof...(Types);
  (void)(..., (names += class_name_of<Types>() + (--left > 1 ? ", " : left == 1 ? " or " : "")));
  throw py::type_error(std::string(argument) + " must be " + names + ", got " + class_name(object));
}

inline AnySensor to_sensor(const py::handle& sensor) { return one_of(Sensors{}, "sensor", sensor); }

/// True where an estimator takes a `RuntimeSensor`: a filter or an Imm.
inline bool takes_readings(const AnyFilter&) { return true; }
inline bool takes_readings(const AnyEstimator& estimator) {
  return std::holds_alternative<AnyImm>(estimator.variant());
}

/// True where a reading, one of some rows of `width` numbers, has a part missing. Without a branch
/// for each reading, which would take a tenth of a run in lanes.
inline bool has_partial(const double* z, std::size_t rows, std::size_t numbers, std::size_t width) {
  bool partial = false;
  for (const double* const end = z + rows * width; z != end; z += width)
    for (std::size_t m = 1; m < numbers; ++m) partial |= (z[m] != z[m]) != (z[0] != z[0]);
  return partial;
}
inline bool has_partial(const DoubleArray& z, std::size_t numbers) {
  if (z.ndim() == 0 || z.shape(z.ndim() - 1) != static_cast<py::ssize_t>(numbers)) return false;
  return has_partial(z.data(), static_cast<std::size_t>(z.size()) / numbers, numbers, numbers);
}

/// True where each update calls Python.
inline bool calls_python(const ReadingSensor& any) {
  const auto* const sensor = std::get_if<RuntimeSensor>(&any);
  const PySensor* const custom = sensor != nullptr ? python_sensor(*sensor) : nullptr;
  return custom != nullptr && custom->calls();
}

/// Throws ValueError unless the sensor reads components that the state of each filter holds.
inline void require_reads(const AnyFilter& filter, const RuntimeSensor& sensor) {
  const StateRows reads = sensor.reads(), state = rows_of(filter.layout());
  for (int k = 0; k < reads.states; ++k)
    if (const Component one = reads.components[static_cast<std::size_t>(k)]; state.row_of(one) < 0)
      throw py::value_error("sensor reads " + name_of(one) + ", which the state " +
                            names_of(state) + " of the filter does not have");
}
inline void require_reads(const AnyEstimator& estimator, const RuntimeSensor& sensor) {
  const AnyFilterBank& bank = std::get<AnyImm>(estimator.variant()).bank();
  for (int k = 0; k < bank.size(); ++k) require_reads(bank.filter(k), sensor);
}

/// Throws ValueError when a Kalman filter, or one of several models an alpha-beta filter, is given
/// a sensor that is not linear.
template <class Estimator>
void require_linear(const Estimator& estimator, bool linear) {
  if (!linear && estimator.linear())
    throw py::value_error(
        "sensor must be linear for Kalman and, among filters, AlphaBeta: use "
        "ConvertedRangeBearing, Position or LinearSensor, or Ekf or Ukf");
}

/// The sensor of a reading or of many, as this estimator takes it. `covariances` is true where the
/// readings have their own. Throws TypeError or ValueError where it cannot.
template <class Estimator>
ReadingSensor to_reading_sensor(const Estimator& estimator, const py::handle& object,
                                const DoubleArray& z, bool covariances) {
  const bool takes = takes_readings(estimator);
  if (covariances && !takes)
    throw py::value_error("covariance must be None for any estimator but a filter or an Imm");
  const auto checked = [&](const RuntimeSensor& sensor) -> ReadingSensor {
    require_reads(estimator, sensor);
    return sensor;
  };
  if (const auto known = found_in(Sensors{}, object))
    return std::visit(
        [&]<class Sensor>(const Sensor& sensor) -> ReadingSensor {
          require_linear(estimator, Sensor::kLinear);
          if (takes && (covariances || has_partial(z, Sensor::kMeasurements)))
            return checked(sensor);
          return *known;
        },
        *known);
  if (!takes) return to_sensor(object);
  if (is_a<PySensor>(object)) {
    const auto custom = object.cast<std::shared_ptr<PySensor>>();
    require_linear(estimator, custom->linear());
    return checked(RuntimeSensor(custom));
  }
  return std::visit(
      [&]<class Sensor>(const Sensor& sensor) {
        require_linear(estimator, Sensor::kLinear);
        return checked(sensor);
      },
      one_of(Joined<Sensors, PartSensors>{}, "sensor", object));
}

/// Calls `function(sensor)` with the C++ sensor behind a Python one.
template <class Function>
auto visit_sensor(const py::handle& sensor, Function&& function) {
  return std::visit(function, to_sensor(sensor));
}

/// Throws TypeError for an estimator of a class derived in Python, whose methods nothing in C++
/// would call.
inline void require_own_class(const py::handle& estimator) {
  const auto* known = py::detail::get_type_info(Py_TYPE(estimator.ptr()));
  if (known != nullptr && known->type == Py_TYPE(estimator.ptr())) return;
  throw py::type_error(class_name(estimator) +
                       " is derived in Python from an estimator, and the engine would ignore its "
                       "methods: give one of the engine's classes");
}

/// Filters from a sequence of them.
inline std::vector<AnyFilter> to_filters(const py::sequence& sequence) {
  std::vector<AnyFilter> filters;
  for (py::handle item : sequence) {
    if (is_a<AnyFilter>(item) || is_a<PyEstimator<AlphaBeta<>>>(item)) require_own_class(item);
    if (is_a<AnyFilter>(item))
      filters.push_back(item.cast<const AnyFilter&>());
    else if (is_a<PyEstimator<AlphaBeta<>>>(item))
      filters.emplace_back(item.cast<const PyEstimator<AlphaBeta<>>&>().get());
    else
      throw py::type_error("filters must be Kalman, Ekf, Ukf, SquareRootUkf or AlphaBeta, got " +
                           class_name(item));
  }
  return filters;
}

inline PyGaussian to_gaussian(const AnyBelief& belief) { return {belief.mean, belief.covariance}; }

/// The belief that an estimator of a layout starts with: over that, or over [x, vx, y, vy].
inline AnyBelief to_start(const char* name, const PyGaussian& gaussian, StateLayout layout) {
  const int states = states_of(layout);
  const bool of_kinematics = has_kinematics(layout);
  if (gaussian.mean.size() != states && !(of_kinematics && gaussian.mean.size() == 4))
    throw py::value_error(std::string(name) + " must have a mean of " +
                          (of_kinematics && states != 4 ? "4 or " : "") + std::to_string(states) +
                          " states, got " + std::to_string(gaussian.mean.size()));
  return {gaussian.mean.size() == states ? layout : StateLayout::kKinematics, gaussian.mean,
          gaussian.covariance};
}

template <int M>
PyStep to_step(const AnyStep<M>& step) {
  return {step.status, step.innovation, step.innovation_covariance, step.nis, step.log_likelihood};
}

/// The step of a `RuntimeSensor`, with NaN for the numbers that were missing.
inline PyStep to_step(const Step<kMostNumbers>& step, const RuntimeSensor& sensor,
                      const Vec<double, kMostNumbers>& z) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const int numbers = sensor.numbers();
  PyStep result{step.status, step.innovation.head(numbers),
                step.innovation_covariance.topLeftCorner(numbers, numbers), step.nis,
                step.log_likelihood};
  for (int m = 0; m < numbers; ++m) {
    if (z[m] == z[m]) continue;
    result.innovation[m] = kNaN;
    result.innovation_covariance.row(m).setConstant(kNaN);
    result.innovation_covariance.col(m).setConstant(kNaN);
  }
  return result;
}

/// The covariances (..., M, M) of readings (..., M). Throws unless each of a reading that there is
/// is symmetric positive definite.
void require_covariances(const DoubleArray& covariance, const DoubleArray& z);

/// A known acceleration, (2,) array or None.
inline std::optional<Vec<double, 2>> to_acceleration(const std::optional<DoubleArray>& array) {
  if (!array) return std::nullopt;
  return to_vector<2>("acceleration_mps2", *array);
}

}  // namespace wakeline::python
