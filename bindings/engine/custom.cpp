// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "custom.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <type_traits>
#include <utility>

#include "wakeline/catalog/custom_filter.hpp"

namespace wakeline::python {
namespace {

using State = AnyBelief::Mean;
using Matrix = AnyBelief::Covariance;

constexpr std::array<std::pair<const char*, Component>, 7> kNamed{
    {{"x", Component::kNorth},
     {"vx", Component::kVnorth},
     {"ax", Component::kAnorth},
     {"y", Component::kEast},
     {"vy", Component::kVeast},
     {"ay", Component::kAeast},
     {"omega", Component::kTurnRate}}};
constexpr auto kFirstNamed = static_cast<int>(Component::kUser);

/// The other names that models of this process have used.
std::vector<std::string>& other_names() {
  static std::vector<std::string> names;
  return names;
}

Component component_of(const std::string& name) {
  for (const auto& [known, component] : kNamed)
    if (name == known) return component;
  auto& names = other_names();
  const auto found = std::find(names.begin(), names.end(), name);
  const auto index = static_cast<int>(found - names.begin());
  if (found == names.end()) names.push_back(name);
  return Component(kFirstNamed + index);
}

StateRows to_rows(const char* argument, const std::vector<std::string>& names) {
  if (names.empty() || names.size() > kMaxStates)
    throw py::value_error(std::string(argument) + " must be 1 to " + std::to_string(kMaxStates) +
                          " names, got " + std::to_string(names.size()));
  StateRows rows{.states = static_cast<int>(names.size())};
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (std::count(names.begin(), names.end(), names[k]) > 1)
      throw py::value_error(std::string(argument) + " must be different names, got '" + names[k] +
                            "' twice");
    rows.components[k] = component_of(names[k]);
  }
  const bool kinematics =
      rows.states == 4 && std::all_of(kKinematics.begin(), kKinematics.end(),
                                      [&](Component one) { return rows.row_of(one) >= 0; });
  if (kinematics && rows != StateRows::of(kKinematics))
    throw py::value_error(std::string(argument) +
                          " of position and velocity alone must be in the order x, vx, y, vy");
  return rows;
}

std::vector<std::string> names_in(const StateRows& rows) {
  std::vector<std::string> names;
  for (int k = 0; k < rows.states; ++k)
    names.push_back(name_of(rows.components[static_cast<std::size_t>(k)]));
  return names;
}

/// "transition of FunctionMotion (cruise)": a function in messages.
std::string described(const char* role, const char* type, const py::object& function) {
  const py::object name = py::getattr(function, "__qualname__", py::none());
  return std::string(role) + " of " + type +
         (name.is_none() ? "" : " (" + py::str(name).cast<std::string>() + ")");
}

py::object or_none(const std::optional<py::function>& function) {
  return function ? py::object(*function) : py::none();
}

/// The finite numbers of a Python object, row-major. Throws unless they have that shape.
DoubleArray numbers_of(const std::string& what, const py::object& result,
                       const std::vector<py::ssize_t>& shape) {
  const DoubleArray array = DoubleArray::ensure(result);
  if (!array || shape_of(array) != shape)
    throw py::value_error(
        what + " must return an array of shape " + shape_text(shape) + ", got " +
        (array && array.ndim() > 0 ? "shape " + shape_text(shape_of(array)) : quoted(result)));
  for (py::ssize_t k = 0; k < array.size(); ++k)
    if (!std::isfinite(array.data()[k]))
      throw py::value_error(what + " must return finite numbers, got " +
                            number_text(array.data()[k]));
  return array;
}

State to_state(const DoubleArray& array) {
  return Eigen::Map<const Eigen::VectorXd>(array.data(), array.size());
}

/// A matrix of numbers row by row.
template <class Result>
Result from_rows(const double* numbers, Eigen::Index rows, Eigen::Index columns) noexcept {
  Result matrix(rows, columns);
  for (Eigen::Index i = 0; i < rows; ++i)
    for (Eigen::Index j = 0; j < columns; ++j) matrix(i, j) = numbers[columns * i + j];
  return matrix;
}

template <class Result = Matrix>
Result to_rows_and_columns(const DoubleArray& array) {
  return from_rows<Result>(array.data(), array.shape(0), array.shape(1));
}

/// m x, as loops; see `product`.
template <class Result = State, class Given>
Result product_of(const Given& m, const State& x) noexcept {
  Result result(m.rows());
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    result[i] = m(i, 0) * x[0];
    for (Eigen::Index k = 1; k < x.size(); ++k) result[i] += m(i, k) * x[k];
  }
  return result;
}

/// Throws ValueError unless a matrix is a covariance: symmetric, and positive definite or, for a
/// noise, semidefinite.
template <class Given>
void require_covariance(const std::string& what, const Given& matrix, bool definite) {
  const auto rows = static_cast<int>(matrix.rows());
  if (const auto found = asymmetry(rows, matrix)) {
    const auto [i, j] = *found;
    throw py::value_error(what + " must be symmetric, got " + number_text(matrix(i, j)) + " at (" +
                          std::to_string(i) + ", " + std::to_string(j) + ") and " +
                          number_text(matrix(j, i)) + " at (" + std::to_string(j) + ", " +
                          std::to_string(i) + ")");
  }
  if (!definite && matrix.isZero(0.0)) return;
  const double rounding =
      definite ? 0.0 : std::max(rounding_of(rows, matrix), std::numeric_limits<double>::min());
  const RuntimeCholesky root(
      rows, [&](int i, int j) { return matrix(i, j) + (i == j ? rounding : 0.0); });
  if (!root.ok)
    throw py::value_error(what + " must be positive " + (definite ? "" : "semi") +
                          "definite, got " + text_of(to_array(matrix)));
}

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// What `call()` returns, which calls Python; `otherwise`, and the exception kept, where it throws.
template <class Result, class Call>
Result guarded(Fault& fault, const Result& otherwise, const Call& call) noexcept {
  if (fault.there_is()) return otherwise;
  const py::gil_scoped_acquire gil;
  try {
    return call();
  } catch (...) {
    fault.keep(std::current_exception());
    return otherwise;
  }
}

/// Python functions that may be given away without the GIL.
class Functions {
 public:
  explicit Functions(std::vector<py::object> functions) : functions_(std::move(functions)) {}
  Functions(const Functions&) = delete;
  Functions& operator=(const Functions&) = delete;
  ~Functions() {
    const py::gil_scoped_acquire gil;
    functions_.clear();
  }
  const py::object& operator[](std::size_t k) const { return functions_[k]; }

 private:
  std::vector<py::object> functions_;
};

/// Numbers in and out of a compiled function, matrices row by row: of a motion model with the step.
using MotionPointer = void (*)(const double* x, double dt_s, double* result);
using SensorPointer = void (*)(const double* x, double* result);

/// The address of a compiled function, of `numba.cfunc` or `ctypes`; null of another one. Throws
/// ValueError where it is compiled for other arguments.
template <class Pointer>
Pointer compiled(const char* role, const char* type, const py::object& function) {
  constexpr bool kSteps = std::is_same_v<Pointer, MotionPointer>;
  const py::object pointer = py::getattr(function, "ctypes", function);
  if (!py::hasattr(pointer, "argtypes")) return nullptr;
  const py::module_ ctypes = py::module_::import("ctypes");
  const py::object number = ctypes.attr("c_double");
  const py::object numbers = ctypes.attr("POINTER")(number);
  const py::tuple wanted = kSteps ? py::tuple(py::make_tuple(numbers, number, numbers))
                                  : py::tuple(py::make_tuple(numbers, numbers));
  const py::object given = pointer.attr("argtypes");
  if (!pointer.attr("restype").is_none() || given.is_none() || !py::tuple(given).equal(wanted))
    throw py::value_error(
        described(role, type, function) + " must be compiled as void(" +
        (kSteps ? "double* x, double dt_s, double* result" : "double* x, double* result") +
        "), got the arguments " + py::str(given).cast<std::string>() + " and the result " +
        py::str(pointer.attr("restype")).cast<std::string>());
  return reinterpret_cast<Pointer>(
      ctypes.attr("cast")(pointer, ctypes.attr("c_void_p")).attr("value").cast<std::uintptr_t>());
}

/// What a compiled function writes, NaN where it writes nothing; `call` calls it.
template <class Result, class Call>
Result written(int rows, int columns, const Call& call) noexcept {
  double numbers[kMaxStates * kMaxStates];
  std::fill_n(numbers, rows * columns, kNaN);
  call(numbers);
  return from_rows<Result>(numbers, rows, columns);
}

/// Standard deviations by component, of those that a start over [x, vx, y, vy] does not give.
class Priors {
 public:
  Priors(const StateRows& rows, const std::map<std::string, double>& std_of) : std_of_(std_of) {
    for (const auto& [name, deviation] : std_of) {
      if (rows.row_of(component_of(name)) < 0)
        throw py::value_error("prior_std must be of the states " + names_of(rows) + ", got '" +
                              name + "'");
      require_positive("prior_std", deviation);
      variance_[component_of(name)] = deviation * deviation;
    }
  }
  [[nodiscard]] double variance(Component component) const noexcept {
    const auto found = variance_.find(component);
    return found == variance_.end() ? 1.0 : found->second;
  }
  [[nodiscard]] const std::map<std::string, double>& std_of() const noexcept { return std_of_; }

 private:
  std::map<std::string, double> std_of_;
  std::map<Component, double> variance_;
};

/// A motion model of Python functions.
class MotionOfFunctions : public PyMotion {
 public:
  MotionOfFunctions(std::vector<py::object> functions, const StateRows& rows,
                    const std::map<std::string, double>& prior_std)
      : PyMotion(rows), functions_(std::move(functions)), priors_(rows, prior_std) {}

  [[nodiscard]] double prior_variance(Component component) const noexcept override {
    return priors_.variance(component);
  }
  [[nodiscard]] const py::object& function(std::size_t k) const { return functions_[k]; }
  [[nodiscard]] const Priors& priors() const { return priors_; }

 private:
  Functions functions_;
  Priors priors_;
};

class LinearMotion : public MotionOfFunctions {
 public:
  LinearMotion(const py::function& matrix, const py::function& noise, const StateRows& rows,
               const std::map<std::string, double>& prior_std)
      : MotionOfFunctions({matrix, noise}, rows, prior_std) {
    (void)of_step(1.0);  // so that an error is raised where the model is made
    fault().raise();
  }

  [[nodiscard]] const char* type() const noexcept override { return "LinearMotion"; }
  [[nodiscard]] bool linear() const noexcept override { return true; }
  [[nodiscard]] bool calls() const noexcept override { return false; }  // but for a new step
  [[nodiscard]] State transition(const State& x, double dt_s) const noexcept override {
    return product_of(of_step(dt_s).f, x);
  }
  [[nodiscard]] Matrix jacobian(const State&, double dt_s) const noexcept override {
    return of_step(dt_s).f;
  }
  [[nodiscard]] Matrix process_noise(const State&, double dt_s) const noexcept override {
    return of_step(dt_s).q;
  }

  /// F(dt) and Q(dt), of which the last ones are kept.
  struct Step {
    Matrix f, q;
  };
  [[nodiscard]] Step of_step(double dt_s) const noexcept {
    {
      const std::lock_guard hold(mutex_);
      if (const auto found = kept_.find(dt_s); found != kept_.end()) return found->second;
    }
    const Matrix unknown = Matrix::Constant(states(), states(), kNaN);
    return guarded<Step>(fault(), Step{unknown, unknown}, [&] {
      const std::vector<py::ssize_t> square{states(), states()};
      const auto named = [&](const char* role, std::size_t k) {
        return described(role, type(), function(k));
      };
      const Step step{
          to_rows_and_columns(numbers_of(named("matrix", 0), function(0)(dt_s), square)),
          to_rows_and_columns(numbers_of(named("process_noise", 1), function(1)(dt_s), square))};
      require_covariance(named("process_noise", 1), step.q, false);
      const std::lock_guard hold(mutex_);
      if (kept_.size() >= kMostKept) kept_.clear();
      kept_.emplace(dt_s, step);
      return step;
    });
  }

 private:
  static constexpr std::size_t kMostKept = 1024;
  mutable std::mutex mutex_;  // never held while Python runs
  mutable std::map<double, Step> kept_;
};

class FunctionMotion : public MotionOfFunctions {
 public:
  FunctionMotion(const py::function& transition, const py::function& noise, const StateRows& rows,
                 const std::optional<py::function>& jacobian,
                 const std::map<std::string, double>& prior_std)
      : MotionOfFunctions({transition, noise, or_none(jacobian)}, rows, prior_std) {
    for (std::size_t k = 0; k < kRoles.size(); ++k)
      compiled_[k] = compiled<MotionPointer>(kRoles[k], type(), function(k));
  }

  [[nodiscard]] const char* type() const noexcept override { return "FunctionMotion"; }
  [[nodiscard]] bool linear() const noexcept override { return false; }
  [[nodiscard]] bool calls() const noexcept override {
    for (std::size_t k = 0; k < kRoles.size(); ++k)
      if (compiled_[k] == nullptr && !function(k).is_none()) return true;
    return false;
  }
  [[nodiscard]] State transition(const State& x, double dt_s) const noexcept override {
    if (compiled_[0] != nullptr)
      return written<State>(states(), 1, [&](double* to) { compiled_[0](x.data(), dt_s, to); });
    return guarded<State>(fault(), State::Constant(states(), kNaN),
                          [&] { return to_state(called(0, x, dt_s, {states()})); });
  }
  [[nodiscard]] Matrix jacobian(const State& x, double dt_s) const noexcept override {
    if (function(2).is_none()) return CustomMotion::jacobian(x, dt_s);
    return square(2, x, dt_s);
  }
  [[nodiscard]] Matrix process_noise(const State& x, double dt_s) const noexcept override {
    return square(1, x, dt_s);
  }

 private:
  static constexpr std::array kRoles{"transition", "process_noise", "jacobian"};

  [[nodiscard]] std::string named(std::size_t k) const {
    return described(kRoles[k], type(), function(k));
  }
  [[nodiscard]] DoubleArray called(std::size_t k, const State& x, double dt_s,
                                   const std::vector<py::ssize_t>& shape) const {
    return numbers_of(named(k), function(k)(to_array(x), dt_s), shape);
  }
  [[nodiscard]] Matrix square(std::size_t k, const State& x, double dt_s) const noexcept {
    if (compiled_[k] != nullptr)
      return written<Matrix>(states(), states(),
                             [&](double* to) { compiled_[k](x.data(), dt_s, to); });
    return guarded<Matrix>(fault(), Matrix::Constant(states(), states(), kNaN), [&] {
      const Matrix matrix = to_rows_and_columns(called(k, x, dt_s, {states(), states()}));
      if (k == 1) require_covariance(named(k), matrix, false);
      return matrix;
    });
  }

  std::array<MotionPointer, kRoles.size()> compiled_;
};

ReadingMatrix to_noise(const DoubleArray& covariance) {
  const py::ssize_t numbers = covariance.ndim() == 2 ? covariance.shape(0) : 0;
  require_shape(numbers >= 1 && numbers <= kMostNumbers && covariance.shape(1) == numbers,
                "covariance", "(M, M), M 1 to " + std::to_string(kMostNumbers), covariance);
  const auto noise = to_rows_and_columns<ReadingMatrix>(covariance);
  require_covariance("covariance", noise, true);
  return noise;
}

class LinearSensor : public PySensor {
 public:
  LinearSensor(const DoubleArray& matrix, const DoubleArray& covariance, const StateRows& reads)
      : reads_(reads), noise_(to_noise(covariance)) {
    const std::vector<py::ssize_t> shape{numbers(), reads.states};
    require_shape(shape_of(matrix) == shape, "matrix", shape_text(shape), matrix);
    for (py::ssize_t k = 0; k < matrix.size(); ++k) require_finite("matrix", matrix.data()[k]);
    matrix_ = to_rows_and_columns<ReadingJacobian>(matrix);
  }

  [[nodiscard]] int numbers() const noexcept override { return static_cast<int>(noise_.rows()); }
  [[nodiscard]] const StateRows& reads() const noexcept override { return reads_; }
  [[nodiscard]] bool linear() const noexcept override { return true; }
  [[nodiscard]] bool calls() const noexcept override { return false; }
  [[nodiscard]] ReadingVector measure(const State& x) const noexcept override {
    return product_of<ReadingVector>(matrix_, x);
  }
  [[nodiscard]] ReadingJacobian jacobian(const State&) const noexcept override { return matrix_; }
  [[nodiscard]] ReadingVector residual(const ReadingVector& a,
                                       const ReadingVector& b) const noexcept override {
    return a - b;
  }
  [[nodiscard]] const ReadingMatrix& noise() const noexcept override { return noise_; }

  [[nodiscard]] const ReadingJacobian& matrix() const { return matrix_; }

 private:
  StateRows reads_;
  ReadingMatrix noise_;
  ReadingJacobian matrix_;
};

class FunctionSensor : public PySensor {
 public:
  FunctionSensor(const py::function& measure, const DoubleArray& covariance, const StateRows& reads,
                 const std::optional<py::function>& jacobian, const std::vector<int>& angles)
      : reads_(reads),
        noise_(to_noise(covariance)),
        angles_(angles),
        functions_({measure, or_none(jacobian)}) {
    for (std::size_t k = 0; k < kRoles.size(); ++k)
      compiled_[k] = compiled<SensorPointer>(kRoles[k], kType, functions_[k]);
    for (const int angle : angles)
      require(angle >= 0 && angle < numbers(), "angles",
              ("indices from 0 to " + std::to_string(numbers() - 1)).c_str(), angle);
  }

  [[nodiscard]] int numbers() const noexcept override { return static_cast<int>(noise_.rows()); }
  [[nodiscard]] const StateRows& reads() const noexcept override { return reads_; }
  [[nodiscard]] bool linear() const noexcept override { return false; }
  [[nodiscard]] bool calls() const noexcept override {
    return compiled_[0] == nullptr || (compiled_[1] == nullptr && !functions_[1].is_none());
  }
  [[nodiscard]] ReadingVector measure(const State& x) const noexcept override {
    if (compiled_[0] != nullptr)
      return written<ReadingVector>(numbers(), 1, [&](double* to) { compiled_[0](x.data(), to); });
    return guarded<ReadingVector>(fault(), ReadingVector::Constant(numbers(), kNaN), [&] {
      return ReadingVector(to_state(called(0, x, {numbers()})));
    });
  }
  [[nodiscard]] ReadingJacobian jacobian(const State& x) const noexcept override {
    if (functions_[1].is_none()) {
      const ReadingVector centre = measure(x);  // near which an angle does not jump
      return CustomMotion::central_differences<ReadingJacobian>(
          x, [&](const State& at) { return residual(measure(at), centre); });
    }
    if (compiled_[1] != nullptr)
      return written<ReadingJacobian>(numbers(), reads_.states,
                                      [&](double* to) { compiled_[1](x.data(), to); });
    return guarded<ReadingJacobian>(
        fault(), ReadingJacobian::Constant(numbers(), reads_.states, kNaN), [&] {
          return to_rows_and_columns<ReadingJacobian>(called(1, x, {numbers(), reads_.states}));
        });
  }
  [[nodiscard]] ReadingVector residual(const ReadingVector& a,
                                       const ReadingVector& b) const noexcept override {
    ReadingVector difference = a - b;
    for (const int angle : angles_) difference[angle] = wrap_angle(difference[angle]);
    return difference;
  }
  [[nodiscard]] const ReadingMatrix& noise() const noexcept override { return noise_; }

  [[nodiscard]] const Functions& functions() const { return functions_; }
  [[nodiscard]] const std::vector<int>& angles() const { return angles_; }

 private:
  static constexpr auto kType = "FunctionSensor";
  static constexpr std::array kRoles{"measure", "jacobian"};

  [[nodiscard]] DoubleArray called(std::size_t k, const State& x,
                                   const std::vector<py::ssize_t>& shape) const {
    return numbers_of(described(kRoles[k], kType, functions_[k]), functions_[k](to_array(x)),
                      shape);
  }

  StateRows reads_;
  ReadingMatrix noise_;
  std::vector<int> angles_;
  Functions functions_;
  std::array<SensorPointer, kRoles.size()> compiled_;
};

/// An immutable object that copies share.
template <class Class, class... Options>
void define_shared(py::class_<Class, Options...>& type) {
  type.def("__copy__", [](const std::shared_ptr<Class>& one) { return one; })
      .def(
          "__deepcopy__", [](const std::shared_ptr<Class>& one, const py::dict&) { return one; },
          py::arg("memo"));
  define_arguments(type);
}

State to_state(const PyMotion& motion, const DoubleArray& x) {
  return to_vector("x", x, motion.states());
}

double time_step(double dt_s) {
  require_not_negative("dt_s", dt_s);
  return dt_s;
}

/// What a function of the model returns, or the error that it raised.
template <class Model, class Result>
py::array_t<double> result_of(const Model& model, const Result& result) {
  model.fault().raise();
  return to_array(result);
}

const char* const kStateDoc = R"(state : sequence of N names, optional
    The components of the state: x, vx, ax (north), y, vy, ay (east), omega (turn rate), or any other
    name, N 1 to 9. Default: x, vx, y, vy.)";

void define_motions(py::module_& m) {
  py::class_<PyMotion, std::shared_ptr<PyMotion>> motion(
      m, "CustomMotion", "Common base of LinearMotion and FunctionMotion.");
  motion.def_property_readonly("states", &PyMotion::states, "number of states N")
      .def_property_readonly(
          "state", [](const PyMotion& one) { return names_in(rows_of(one.layout())); },
          "names of the components of the state");

  const std::vector<std::string> kinematics{"x", "vx", "y", "vy"};
  py::class_<LinearMotion, PyMotion, std::shared_ptr<LinearMotion>> linear(
      m, "LinearMotion",
      (R"(A linear motion model by its matrices: x' = F(dt) x + w, w ~ N(0, Q(dt)).

A new step calls both functions once; their results are kept for the steps after it. One recording
takes about twice as long as with a model of the engine; many run side by side as those do where the
state is that of a linear model of the engine and F has its zeros, or the sensor is a LinearSensor
(`RunResult.lanes`).

Parameters
----------
matrix : function of dt_s
    Returns F(dt), (N, N).
process_noise : function of dt_s
    Returns Q(dt), (N, N), symmetric positive semidefinite.
)" + std::string(kStateDoc) +
       R"(
prior_std : dict, optional
    Standard deviations, by name, of states that a start over [x, vx, y, vy] does not give; 1 where
    left out, about 0.

Raises
------
ValueError
    When a matrix has another shape or is not finite, or Q is no covariance; in a later step, from
    the call that made the step.

References
----------
Bar-Shalom, Li, Kirubarajan, 5.2.1.)")
          .c_str(),
      py::is_final());  // an overridden method would not be called
  linear
      .def(py::init([](const py::function& matrix, const py::function& noise,
                       const std::vector<std::string>& state,
                       const std::map<std::string, double>& prior_std) {
             return std::make_shared<LinearMotion>(matrix, noise, to_rows("state", state),
                                                   prior_std);
           }),
           py::arg("matrix"), py::arg("process_noise"), py::arg("state") = kinematics,
           py::arg("prior_std") = std::map<std::string, double>())
      .def(
          "matrix",
          [](const LinearMotion& one, double dt_s) {
            return result_of(one, one.of_step(time_step(dt_s)).f);
          },
          py::arg("dt_s"), "F(dt), (N, N).")
      .def(
          "process_noise",
          [](const LinearMotion& one, double dt_s) {
            return result_of(one, one.of_step(time_step(dt_s)).q);
          },
          py::arg("dt_s"), "Q(dt), (N, N).")
      .def("_arguments", [](const LinearMotion& one) {
        return Arguments()
            .with("matrix", one.function(0))
            .with("process_noise", one.function(1))
            .with("state", names_in(rows_of(one.layout())))
            .with("prior_std", one.priors().std_of());
      });
  define_shared(linear);

  py::class_<FunctionMotion, PyMotion, std::shared_ptr<FunctionMotion>> function(
      m, "FunctionMotion",
      (R"(A motion model by Python functions: x' = f(x, dt) + w, w ~ N(0, Q(x, dt)), for Ekf and Ukf.

Each step calls the functions, so that a run takes as long as they do (`RunResult.lanes` is 0): some
10 µs a step. A linear model is quicker as LinearMotion. A compiled function, of `numba.cfunc` or
`ctypes`, is called without Python: void(double* x, double dt_s, double* result), a matrix row by
row. Its result is not checked; a step whose belief is not finite fails with `Status.not_finite`.

Parameters
----------
transition : function of x and dt_s
    Returns f(x, dt), (N,).
process_noise : function of x and dt_s
    Returns Q(x, dt), (N, N), symmetric positive semidefinite.
)" + std::string(kStateDoc) +
       R"(
jacobian : function of x and dt_s, optional
    Returns df/dx, (N, N); by central differences when left out. Used by Ekf.
prior_std : dict, optional
    As of LinearMotion.

Raises
------
ValueError
    From the call that made a step, when a result has another shape or is not finite, or Q is no
    covariance. What a function raises is raised by that call.

References
----------
Bar-Shalom, Li, Kirubarajan, 10.3.1.)")
          .c_str(),
      py::is_final());
  function
      .def(py::init([](const py::function& transition, const py::function& noise,
                       const std::vector<std::string>& state,
                       const std::optional<py::function>& jacobian,
                       const std::map<std::string, double>& prior_std) {
             return std::make_shared<FunctionMotion>(transition, noise, to_rows("state", state),
                                                     jacobian, prior_std);
           }),
           py::arg("transition"), py::arg("process_noise"), py::arg("state") = kinematics,
           py::arg("jacobian") = py::none(), py::arg("prior_std") = std::map<std::string, double>())
      .def(
          "transition",
          [](const FunctionMotion& one, const DoubleArray& x, double dt_s) {
            return result_of(one, one.transition(to_state(one, x), time_step(dt_s)));
          },
          py::arg("x"), py::arg("dt_s"), "f(x, dt), (N,).")
      .def(
          "jacobian",
          [](const FunctionMotion& one, const DoubleArray& x, double dt_s) {
            return result_of(one, one.jacobian(to_state(one, x), time_step(dt_s)));
          },
          py::arg("x"), py::arg("dt_s"), "df/dx, (N, N).")
      .def(
          "process_noise",
          [](const FunctionMotion& one, const DoubleArray& x, double dt_s) {
            return result_of(one, one.process_noise(to_state(one, x), time_step(dt_s)));
          },
          py::arg("x"), py::arg("dt_s"), "Q(x, dt), (N, N).")
      .def("_arguments", [](const FunctionMotion& one) {
        return Arguments()
            .with("transition", one.function(0))
            .with("process_noise", one.function(1))
            .with("state", names_in(rows_of(one.layout())))
            .with("jacobian", one.function(2))
            .with("prior_std", one.priors().std_of());
      });
  define_shared(function);
}

const char* const kReadsDoc = R"(reads : sequence of names, optional
    The components x_r that it reads, as a motion model's `state` names them. Default: x, vx, y, vy.)";

void define_sensors(py::module_& m) {
  py::class_<PySensor, std::shared_ptr<PySensor>> sensor(
      m, "CustomSensor", "Common base of LinearSensor and FunctionSensor.");
  sensor.def_property_readonly("measurements", &PySensor::numbers, "numbers per reading, M")
      .def_property_readonly(
          "reads", [](const PySensor& one) { return names_in(one.reads()); },
          "names of the components that it reads")
      .def_property_readonly(
          "covariance", [](const PySensor& one) { return to_array(one.noise()); }, "R, (M, M)")
      .def(
          "measure",
          [](const PySensor& one, const DoubleArray& x) {
            return result_of(one, one.measure(to_vector("x", x, one.reads().states)));
          },
          py::arg("x"), "h of the components that the sensor reads, (M,).")
      .def(
          "jacobian",
          [](const PySensor& one, const DoubleArray& x) {
            return result_of(one, one.jacobian(to_vector("x", x, one.reads().states)));
          },
          py::arg("x"), "dh/dx of those components.");

  const std::vector<std::string> kinematics{"x", "vx", "y", "vy"};
  py::class_<LinearSensor, PySensor, std::shared_ptr<LinearSensor>> linear(
      m, "LinearSensor",
      (R"(A linear sensor by its matrix: z = H x_r + v, v ~ N(0, R), of 1 to 4 numbers.

Parameters
----------
matrix : (M, n) array
    H.
covariance : (M, M) array
    R, symmetric positive definite.
)" + std::string(kReadsDoc) +
       R"(

Raises
------
ValueError
    When a shape does not fit, a number is not finite or R is no covariance.

References
----------
Bar-Shalom, Li, Kirubarajan, 5.2.1.)")
          .c_str(),
      py::is_final());  // an overridden method would not be called
  linear
      .def(py::init([](const DoubleArray& matrix, const DoubleArray& covariance,
                       const std::vector<std::string>& reads) {
             return std::make_shared<LinearSensor>(matrix, covariance, to_rows("reads", reads));
           }),
           py::arg("matrix"), py::arg("covariance"), py::arg("reads") = kinematics)
      .def("_arguments", [](const LinearSensor& one) {
        return Arguments()
            .with("matrix", one.matrix())
            .with("covariance", one.noise())
            .with("reads", names_in(one.reads()));
      });
  define_shared(linear);

  py::class_<FunctionSensor, PySensor, std::shared_ptr<FunctionSensor>> function(
      m, "FunctionSensor",
      (R"(A sensor by Python functions: z = h(x_r) + v, v ~ N(0, R), of 1 to 4 numbers, for Ekf and Ukf.

Each update calls the functions, so that a run takes as long as they do (`RunResult.lanes` is 0). A
compiled function, as of FunctionMotion, is void(double* x, double* result).

Parameters
----------
measure : function of x_r
    Returns h(x_r), (M,).
covariance : (M, M) array
    R, symmetric positive definite.
)" + std::string(kReadsDoc) +
       R"(
jacobian : function of x_r, optional
    Returns dh/dx_r, (M, n); by central differences when left out. Used by Ekf.
angles : sequence of int, optional
    Which numbers are angles in rad, whose differences are wrapped to -pi .. pi.

Raises
------
ValueError
    When a shape does not fit or R is no covariance; from the call that made an update, when a
    result has another shape or is not finite. What a function raises is raised by that call.

References
----------
Bar-Shalom, Li, Kirubarajan, 10.3.1.)")
          .c_str(),
      py::is_final());
  function
      .def(
          py::init([](const py::function& measure, const DoubleArray& covariance,
                      const std::vector<std::string>& reads,
                      const std::optional<py::function>& jacobian, const std::vector<int>& angles) {
            return std::make_shared<FunctionSensor>(measure, covariance, to_rows("reads", reads),
                                                    jacobian, angles);
          }),
          py::arg("measure"), py::arg("covariance"), py::arg("reads") = kinematics,
          py::arg("jacobian") = py::none(), py::arg("angles") = std::vector<int>())
      .def_property_readonly("angles", &FunctionSensor::angles, "which numbers are angles")
      .def("_arguments", [](const FunctionSensor& one) {
        return Arguments()
            .with("measure", one.functions()[0])
            .with("covariance", one.noise())
            .with("reads", names_in(one.reads()))
            .with("jacobian", one.functions()[1])
            .with("angles", one.angles());
      });
  define_shared(function);
}

}  // namespace

std::string name_of(Component component) {
  for (const auto& [name, known] : kNamed)
    if (known == component) return name;
  return other_names().at(static_cast<std::size_t>(static_cast<int>(component) - kFirstNamed));
}

std::string names_of(const StateRows& rows) {
  std::string text = "[";
  for (const std::string& name : names_in(rows)) text += (text.size() > 1 ? ", " : "") + name;
  return text + "]";
}

void define_custom(py::module_& parent) {
  py::module_ motion = parent.attr("motion");
  py::module_ measurement = parent.attr("measurement");
  define_motions(motion);
  define_sensors(measurement);
}

}  // namespace wakeline::python
