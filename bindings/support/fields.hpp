// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A parameter struct as a Python class, from the table of its fields (`core/fields.hpp`).
#pragma once

#include <concepts>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "support/arguments.hpp"
#include "wakeline/core/fields.hpp"

namespace wakeline::python {

/// Whether a Python value could be taken for a field.
enum class Taken { kYes, kWrongType, kWrongValue };

/// What is done with the values of one C++ type, behind a pointer.
struct ValueKind {
  py::object (*get)(const void* value);
  Taken (*set)(void* value, py::handle from);
  std::string (*expected)();            ///< "a number"
  bool literal;                         ///< its `repr` is Python that can be read anywhere
  double (*number)(const void* value);  ///< null for what has no rule
  const char* annotation;               ///< "" where it is the type of the Python value
};

/// The types that a field takes where there are several.
template <class Value>
inline constexpr const char* kAnnotation = "";
template <>
inline constexpr const char* kAnnotation<ProcessNoise> =
    "wakeline._engine.motion.WhiteAcceleration | wakeline._engine.motion.PiecewiseAcceleration | "
    "wakeline._engine.motion.WhiteJerk";

template <class Value>
struct ValueOf {
  static py::object get(const void* value) {
    const Value& own = *static_cast<const Value*>(value);
    if constexpr (NamedEnum<Value>) {
      for (const auto& word : words_of(own))
        if (word.value == own) return py::str(word.text);
      return py::none();
    } else {
      return AsPython<Value>::of(own);
    }
  }

  static Taken set(void* value, py::handle from) {
    Value& own = *static_cast<Value*>(value);
    if constexpr (NamedEnum<Value>) {
      if (!py::isinstance<py::str>(from)) return Taken::kWrongType;
      const std::string text = from.cast<std::string>();
      for (const auto& word : words_of(own))
        if (text == word.text) return own = word.value, Taken::kYes;
      return Taken::kWrongValue;
    } else {
      py::detail::make_caster<Value> caster;
      constexpr bool kConvert = !std::same_as<Value, bool>;
      if (!caster.load(from, kConvert)) {
        constexpr bool kWhole = std::integral<Value> && !std::same_as<Value, bool>;
        return kWhole && PyIndex_Check(from.ptr()) ? Taken::kWrongValue : Taken::kWrongType;
      }
      own = py::detail::cast_op<const Value&>(caster);
      return Taken::kYes;
    }
  }

  static std::string expected() {
    if constexpr (NamedEnum<Value>)
      return choices<Value>();
    else if constexpr (std::same_as<Value, bool>)
      return "True or False";
    else if constexpr (std::integral<Value>)
      return "a whole number of at most " + std::to_string(std::numeric_limits<Value>::max());
    else if constexpr (std::floating_point<Value>)
      return "a number";
    else
      return "";  // its type
  }
};

template <class Value>
constexpr ValueKind value_kind() {
  constexpr bool kNumeric = std::is_arithmetic_v<Value> && !std::same_as<Value, bool>;
  ValueKind kind{&ValueOf<Value>::get,
                 &ValueOf<Value>::set,
                 &ValueOf<Value>::expected,
                 std::is_arithmetic_v<Value> || NamedEnum<Value>,
                 nullptr,
                 kAnnotation<Value>};
  if constexpr (kNumeric)
    kind.number = [](const void* value) {
      return static_cast<double>(*static_cast<const Value*>(value));
    };
  return kind;
}
template <class Value>
inline constexpr ValueKind kValueKind = value_kind<Value>();

/// One field of a struct, whatever its type.
struct FieldRow {
  const char* name;
  const char* unit;
  const char* sentence;
  Rule rule;
  std::ptrdiff_t offset;
  const ValueKind* kind;

  [[nodiscard]] const void* of(const void* one) const {
    return static_cast<const char*>(one) + offset;
  }
  [[nodiscard]] void* of(void* one) const { return static_cast<char*>(one) + offset; }
};

/// How a struct looks in Python.
struct StructLooks {
  int positional = 0;     ///< arguments that need no keyword
  bool writable = false;  ///< fields can be set
  bool called = false;    ///< the engine calls its methods: it cannot be derived from in Python
};

/// What Python needs of a struct, whatever its type.
struct StructTable {
  std::vector<FieldRow> rows;
  void* (*make)();
  void* (*copy)(const void* one);
  void (*destroy)(void* one);
  void (*validate)(const void* one);
  int positional = 0;
  bool writable = false;
  bool called = false;
};

template <HasFields Struct>
StructTable table_of(const StructLooks& looks) {
  StructTable table{
      {},
      []() -> void* { return new Struct(); },
      [](const void* one) -> void* { return new Struct(*static_cast<const Struct*>(one)); },
      [](void* one) { delete static_cast<Struct*>(one); },
      [](const void* one) { validated(*static_cast<const Struct*>(one)); },
      looks.positional,
      looks.writable,
      looks.called};
  const Struct one;
  for_each_field(one, [&]<class Value>(const auto& entry, const Value& value) {
    const auto offset = reinterpret_cast<const char*>(&value) - reinterpret_cast<const char*>(&one);
    table.rows.push_back(
        {entry.name, entry.unit, entry.sentence, entry.rule, offset, &kValueKind<Value>});
  });
  return table;
}

/// The docstring of a class with that table: `doc`, and its parameters.
std::string class_doc(const StructTable& table, const char* doc);

/// Gives a class its constructor, properties, `fields`, `as_dict`, `==`, copies, pickling and
/// `repr`. The table must outlive it.
void define_fields(py::handle type, const StructTable& table);

/// A parameter struct as a Python class; all it has to do with its fields comes from their table.
template <HasFields Struct>
py::class_<Struct> define_struct(py::handle scope, const char* name, const char* doc,
                                 const StructLooks& looks = {}) {
  static const StructTable table = table_of<Struct>(looks);
  py::class_<Struct> type(scope, name, class_doc(table, doc).c_str());
  define_fields(type, table);
  return type;
}

}  // namespace wakeline::python
