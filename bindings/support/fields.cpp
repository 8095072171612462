// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "support/fields.hpp"

#include <cctype>
#include <memory>

#include "support/border.hpp"

namespace wakeline::python {
namespace {

/// "10.0", "0.0174533", "'probabilistic'", "OwnShip()".
std::string default_text(const py::object& value) {
  if (py::isinstance<py::float_>(value)) {
    const std::string exact = text_of(value);
    return exact.size() > 9 ? py::str("{:.6g}").format(value).cast<std::string>() : exact;
  }
  return text_of(value);
}

/// The type of a field for a docstring, in full for a signature.
std::string type_text(const FieldRow& row, const py::object& value, bool full) {
  const py::handle type = py::type::handle_of(value);
  if (*row.kind->annotation == '\0')
    return row.kind->literal || !full
               ? name_of(type)
               : type.attr("__module__").cast<std::string>() + "." + name_of(type);
  const py::str all(row.kind->annotation);
  return (full ? all : py::str(all.attr("replace")("wakeline._engine.motion.", "")))
      .cast<std::string>();
}

/// "In m, finite and positive."
std::string range_text(const FieldRow& row) {
  const std::string unit = row.unit;
  std::string text = unit.empty() || unit == "1" ? "" : "in " + unit;
  if (row.kind->number) text += (text.empty() ? "" : ", ") + to_words(row.rule);
  if (text.empty()) return text;
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text + ".";
}

/// An instance of T as long as it is not given away.
class Owned {
 public:
  Owned(const StructTable& table, void* one) : one_(one, table.destroy) {}
  [[nodiscard]] void* get() const { return one_.get(); }
  void* release() { return one_.release(); }

 private:
  std::unique_ptr<void, void (*)(void*)> one_;
};

py::detail::value_and_holder holder_of(const py::handle& self) {
  return reinterpret_cast<py::detail::instance*>(self.ptr())->get_value_and_holder();
}

/// The struct behind a Python object. Throws TypeError for one of another class.
void* value_of(const py::handle& type, const py::handle& self) {
  if (!py::isinstance(self, type))
    throw py::type_error("self must be " + name_of(type) + ", got " + quoted(self));
  void* one = holder_of(self).value_ptr();
  if (one == nullptr) throw py::type_error(name_of(type) + ".__init__ was not called");
  return one;
}

py::object get(const FieldRow& row, const void* one) { return row.kind->get(row.of(one)); }

/// A struct inside as a part of its owner, so that setting its fields sets those of the owner.
py::object part_of(const py::handle& owner, const void* value, const py::handle& type) {
  const auto* info = py::detail::get_type_info(reinterpret_cast<PyTypeObject*>(type.ptr()));
  return py::reinterpret_steal<py::object>(py::detail::type_caster_generic::cast(
      value, py::return_value_policy::reference_internal, owner, info, nullptr, nullptr));
}

void set(const FieldRow& row, void* one, const py::handle& value) {
  const Taken taken = row.kind->set(row.of(one), value);
  if (taken == Taken::kYes) return;
  std::string expected = row.kind->expected();
  if (expected.empty()) expected = type_text(row, get(row, one), false);
  const std::string message =
      std::string(row.name) + " must be " + expected + ", got " + quoted(value);
  if (taken == Taken::kWrongValue) throw py::value_error(message);
  throw py::type_error(message);
}

const FieldRow& row_of(const StructTable& table, const py::handle& type, const std::string& name) {
  std::string known;
  for (const FieldRow& row : table.rows) {
    if (name == row.name) return row;
    known += (known.empty() ? "" : ", ") + std::string(row.name);
  }
  throw py::type_error(name_of(type) + " has no parameter '" + name + "'; it has " + known);
}

/// The constructor.
void fill(const StructTable& table, const py::handle& type, void* one, const py::args& positional,
          const py::kwargs& named) {
  if (positional.size() > static_cast<std::size_t>(table.positional))
    throw py::type_error(name_of(type) + " takes " +
                         (table.positional == 0 ? "no" : std::to_string(table.positional)) +
                         " positional arguments, got " + std::to_string(positional.size()) +
                         "; give the others by name");
  for (std::size_t k = 0; k < positional.size(); ++k) set(table.rows[k], one, positional[k]);
  for (const auto& [key, value] : named) {
    const auto name = key.cast<std::string>();
    const FieldRow& row = row_of(table, type, name);
    if (static_cast<std::size_t>(&row - table.rows.data()) < positional.size())
      throw py::type_error(name_of(type) + " got two values for " + row.name);
    set(row, one, value);
  }
  table.validate(one);
}

py::dict as_dict(const StructTable& table, const void* one) {
  py::dict values;
  for (const FieldRow& row : table.rows) values[row.name] = get(row, one);
  return values;
}

std::string signature(const StructTable& table, const py::handle& type) {
  const Owned one(table, table.make());
  std::string text =
      "__init__(self: " + type.attr("__module__").cast<std::string>() + "." + name_of(type);
  for (std::size_t k = 0; k < table.rows.size(); ++k) {
    const FieldRow& row = table.rows[k];
    const py::object value = get(row, one.get());
    text += (k == static_cast<std::size_t>(table.positional) ? ", *, " : ", ") +
            std::string(row.name) + ": " + type_text(row, value, true) + " = " +
            (row.kind->literal ? text_of(value) : "...");
  }
  return text + ") -> None";
}

/// A new Python object that owns a copy of the struct.
py::object copied(const StructTable& table, const py::handle& type, const py::object& self) {
  engine_type(self);
  Owned copy(table, table.copy(value_of(type, self)));
  py::object made = type.attr("__new__")(type);
  holder_of(made).value_ptr() = copy.release();
  py::detail::get_type_info(Py_TYPE(made.ptr()))
      ->init_instance(reinterpret_cast<py::detail::instance*>(made.ptr()), nullptr);
  return made;
}

/// What `fields()` lists.
py::object field_type() {
  static const py::handle type = [] {
    py::dict options;
    options["module"] = "wakeline.core";
    return py::module_::import("collections")
        .attr("namedtuple")("Field", "name type default unit rule sentence", **options)
        .release();
  }();
  return py::reinterpret_borrow<py::object>(type);
}

py::tuple fields(const StructTable& table) {
  const Owned one(table, table.make());
  py::list list;
  for (const FieldRow& row : table.rows) {
    const py::object value = get(row, one.get());
    const std::string rule = row.kind->number ? to_words(row.rule) : row.kind->expected();
    list.append(field_type()(row.name, py::type::of(value), value, row.unit, rule, row.sentence));
  }
  return py::tuple(list);
}

void define_properties(const py::handle& type, const StructTable& table) {
  const Owned one(table, table.make());
  const py::object property = py::module_::import("builtins").attr("property");
  const std::string self =
      "(self: " + type.attr("__module__").cast<std::string>() + "." + name_of(type);
  for (const FieldRow& row : table.rows) {
    const py::object value = get(row, one.get());
    const std::string kind = type_text(row, value, true);
    std::string doc = row.sentence;
    if (const std::string range = range_text(row); !range.empty()) doc += " " + range;
    doc += " Default " + default_text(value) + ".";
    const py::handle inner = py::type::handle_of(value);
    const bool part = *row.kind->annotation == '\0' && py::hasattr(inner, "fields");
    const py::cpp_function getter(
        [type, &row, inner, part](const py::object& own) {
          const void* one = value_of(type, own);
          if (!part) return get(row, one);
          py::object inside = part_of(own, row.of(one), inner);
          if (is_copy(own)) make_copy(inside);
          return inside;
        },
        py::is_method(type), (self + ") -> " + kind).c_str());
    py::object setter = py::none();
    if (table.writable)
      setter = py::cpp_function(
          [type, &table, &row](const py::object& own, const py::object& to) {
            void* const now = value_of(type, own);
            if (is_copy(own))
              throw py::attribute_error(
                  std::string(row.name) + " cannot be set, because this " + name_of(type) +
                  " is a copy of one in use: set it in one of your own (copy.copy) and make a new "
                  "object with that");
            const Owned changed(table, table.copy(now));
            set(row, changed.get(), to);
            if (row.kind->number)
              require_rule(row.rule, row.name, row.kind->number(row.of(changed.get())));
            set(row, now, to);
          },
          py::is_method(type), (self + ", value: " + kind + ") -> None").c_str());
    type.attr(row.name) = property(getter, setter, py::none(), doc);
  }
}

}  // namespace

std::string class_doc(const StructTable& table, const char* doc) {
  const Owned one(table, table.make());
  std::string text = std::string(doc) + "\n\nParameters\n----------";
  for (const FieldRow& row : table.rows) {
    const py::object value = get(row, one.get());
    text.append("\n").append(row.name).append(" : ").append(type_text(row, value, false));
    text.append(", default ").append(default_text(value)).append("\n    ").append(row.sentence);
    if (const std::string range = range_text(row); !range.empty()) text.append(" ").append(range);
  }
  return text;
}

void define_fields(py::handle type, const StructTable& table) {
  py::options options;
  options.disable_function_signatures();
  const std::string self =
      "(self: " + type.attr("__module__").cast<std::string>() + "." + name_of(type);
  const auto method = [&](const char* name, const auto& function, const std::string& doc,
                          const auto&... extra) {
    type.attr(name) =
        py::cpp_function(function, py::name(name), py::is_method(type), doc.c_str(), extra...);
  };
  method(
      "__init__",
      [type, &table](py::detail::value_and_holder& holder, const py::args& positional,
                     const py::kwargs& named) {
        const py::handle made = reinterpret_cast<PyObject*>(Py_TYPE(holder.inst));
        if (table.called && !made.is(type))
          throw py::type_error(
              name_of(made) + " is derived in Python from " + name_of(type) +
              ", whose methods the engine calls in C++: it would ignore those of " + name_of(made) +
              " (custom models are structs of C++)");
        Owned one(table, table.make());
        fill(table, type, one.get(), positional, named);
        holder.value_ptr() = one.release();
      },
      signature(table, type), py::detail::is_new_style_constructor());
  method(
      "as_dict",
      [type, &table](const py::object& own) { return as_dict(table, value_of(type, own)); },
      "as_dict" + self + ") -> dict\n\nThe values by name.");
  method(
      "_arguments",
      [type, &table](const py::object& own) {
        return py::make_tuple(py::none(), as_dict(table, value_of(type, own)));
      },
      "_arguments" + self + ") -> tuple");
  method(
      "__eq__",
      [type, &table](const py::object& own, const py::object& other) -> py::object {
        if (!py::isinstance(other, type))
          return py::reinterpret_borrow<py::object>(Py_NotImplemented);
        return py::bool_(
            as_dict(table, value_of(type, own)).equal(as_dict(table, value_of(type, other))));
      },
      "__eq__" + self + ", other: object) -> bool");
  if (table.writable)
    type.attr("__hash__") = py::none();
  else
    method(
        "__hash__",
        [type, &table](const py::object& own) {
          return py::hash(py::tuple(as_dict(table, value_of(type, own)).attr("values")()));
        },
        "__hash__" + self + ") -> int");
  const auto copy = [type, &table](const py::object& own) { return copied(table, type, own); };
  method("__copy__", copy, "__copy__" + self + ") -> " + name_of(type));
  method(
      "__deepcopy__", [copy](const py::object& own, const py::object&) { return copy(own); },
      "__deepcopy__" + self + ", memo: dict) -> " + name_of(type));
  type.attr("fields") = py::staticmethod(py::cpp_function(
      [&table] { return fields(table); }, py::name("fields"), py::scope(type),
      "fields() -> tuple\n\nThe table of its fields: name, type, default, unit, rule and a "
      "sentence on each."));
  define_properties(type, table);
  if (table.writable) note_writable(type);
  define_arguments(type);
}

}  // namespace wakeline::python
