// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/core/fields.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>

#include "wakeline/core/archive.hpp"

namespace wakeline::fields_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

enum class Colour { kRed, kGreen };
constexpr std::array<Word<Colour>, 2> words_of(Colour) {
  return {{{"red", Colour::kRed}, {"green", Colour::kGreen}}};
}

struct Inner {
  double weight_kg = 2.0;

  static constexpr auto fields() noexcept {
    return field_table(field("weight_kg", &Inner::weight_kg, kPositive, "kg", "Weight."));
  }
  friend bool operator==(const Inner&, const Inner&) = default;
};

struct Outer {
  double length_m = 1.0;
  int count = 3;
  bool open = false;
  Colour colour = Colour::kRed;
  Inner inner = {};

  static constexpr auto fields() noexcept {
    return field_table(field("length_m", &Outer::length_m, kNotNegative, "m", "Length."),
                       field("count", &Outer::count, between(1, 5), "pieces", "Pieces."),
                       field("open", &Outer::open, "Whether it is open."),
                       field("colour", &Outer::colour, "Colour."),
                       field("inner", &Outer::inner, "What is inside."));
  }
  friend bool operator==(const Outer&, const Outer&) = default;

  void validate() const {
    validate_fields(*this);
    require(count > 1 || !open, "count", "2 or more of an open one", count);
  }
};

std::string message_of(const Outer& outer) {
  try {
    validated(outer);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(Fields, RulesAreCheckedWhileCompiling) {
  static_assert(kPositive.holds(1e-300) && !kPositive.holds(0.0) && !kPositive.holds(kInfinity));
  static_assert(kNotNegative.holds(0.0) && !kNotNegative.holds(-1e-300));
  static_assert(kNotNegativeOrInfinite.holds(kInfinity) && !kNotNegativeOrInfinite.holds(-1.0));
  static_assert(kFinite.holds(-1e308) && !kFinite.holds(-kInfinity));
  static_assert(kProbability.holds(0.0) && kProbability.holds(1.0) && !kProbability.holds(1.01));
  static_assert(kTimeOrZero.holds(0.0) && !kTimeOrZero.holds(1e-4) && !kTime.holds(0.0));
  static_assert(inside(0, 1).holds(0.5) && !inside(0, 1).holds(0.0) && !inside(0, 1).holds(1.0));
  static_assert(from_to_below(0, 1).holds(0.0) && !from_to_below(0, 1).holds(1.0));
  static_assert(above_to(0, 1).holds(1.0) && !above_to(0, 1).holds(0.0));
  static_assert(between(1, 5).holds(5.0) && !between(1, 5).holds(5.1));
  static_assert(at_least(2).holds(2.0) && !at_least(2).holds(kInfinity));
}

TEST(Fields, NoRuleHoldsForNaN) {
  for (const Rule& rule : {kNumber, kFinite, kPositive, kNotNegative, kNotNegativeOrInfinite,
                           kProbability, kTime, kTimeOrZero, inside(0, 1), at_least(1)})
    EXPECT_FALSE(rule.holds(kNaN)) << to_words(rule);
}

TEST(Fields, RulesReadAsWhatMustBe) {
  EXPECT_EQ(to_words(kPositive), "finite and positive");
  EXPECT_EQ(to_words(between(1, 5)), "1 to 5");
  EXPECT_EQ(to_words(inside(0, 1)), "above 0 and below 1");
  EXPECT_EQ(to_words(from_to_below(0, 0.5)), "at least 0 and below 0.5");
  EXPECT_EQ(to_words(above_to(0, 1)), "above 0 and at most 1");
  EXPECT_EQ(to_words(at_least(2)), "at least 2");
  EXPECT_EQ(to_words(between(1.5e-12, 1e15)), "1.5e-12 to 1e15");
  EXPECT_EQ(choices<Colour>(), "'red' or 'green'");
}

TEST(Fields, ARuleWithoutABoundHasThatOfTheUnit) {
  for (const Rule& rule : {kFinite, kPositive, kNotNegative, at_least(3)})
    for (const char* unit : {"m", "rad", "m²/s³", "scans"}) {
      const Rule finite = within(rule, unit);
      EXPECT_LT(finite.high * finite.high, 1e30) << unit;
      EXPECT_GT(finite.low, -1e15) << unit;
      EXPECT_EQ(finite.holds(0.0), rule.holds(0.0)) << unit;
      EXPECT_TRUE(finite.holds(4.0)) << unit;
    }
  EXPECT_FALSE(within(kPositive, "m").holds(1e-300));
  EXPECT_EQ(within(between(1, 5), "m"), between(1, 5));
  EXPECT_TRUE(within(kNotNegativeOrInfinite, "sigma²").holds(kInfinity));
}

TEST(Fields, TheFirstWrongOneIsNamed) {
  EXPECT_EQ(message_of({}), "");
  EXPECT_EQ(message_of({.length_m = -2.5}), "length_m must be 0 to 1e9, got -2.5");
  EXPECT_EQ(message_of({.length_m = kNaN, .count = 9}), "length_m must be 0 to 1e9, got nan");
  EXPECT_EQ(message_of({.count = 9}), "count must be 1 to 5, got 9");
  EXPECT_EQ(message_of({.colour = Colour(7)}), "colour must be 'red' or 'green'");
  EXPECT_EQ(message_of({.inner = {0.0}}), "inner.weight_kg must be 1e-9 to 1e9, got 0");
}

TEST(Fields, RulesOfSeveralFieldsComeAfterThoseOfEach) {
  EXPECT_EQ(message_of({.count = 1, .open = true}),
            "count must be 2 or more of an open one, got 1");
  EXPECT_EQ(message_of({.count = 0, .open = true}), "count must be 1 to 5, got 0");
  EXPECT_THROW(validated(Inner{-1.0}), std::invalid_argument);  // a struct without validate()
}

TEST(Fields, EachIsVisitedInOrderWithItsValue) {
  Outer outer{.length_m = 4.0, .count = 2};
  std::string names;
  for_each_field(outer, [&](const auto& entry, auto& value) {
    names += std::string(entry.name) + ' ';
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, int>) value = 5;
  });
  EXPECT_EQ(names, "length_m count open colour inner ");
  EXPECT_EQ(outer, (Outer{.length_m = 4.0, .count = 5}));
}

TEST(Fields, AnArchiveOfOtherParametersFails) {
  const Outer saved{.length_m = 4.0, .inner = {3.0}};
  Archive out;
  out.rules(saved);
  const auto takes = [&](const Outer& own) {
    Archive in(out.bytes());
    in.rules(own);
    return in.ok() && in.at_end();
  };
  EXPECT_TRUE(takes(saved));
  EXPECT_FALSE(takes({.length_m = 4.0}));
  EXPECT_FALSE(takes({.inner = {3.0}}));
  EXPECT_FALSE(takes({.length_m = 4.0, .open = true, .inner = {3.0}}));
  EXPECT_FALSE(takes({.length_m = 4.0, .colour = Colour::kGreen, .inner = {3.0}}));
}

}  // namespace
}  // namespace wakeline::fields_test
