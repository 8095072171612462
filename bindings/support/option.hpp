// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Options that Python knows by words.
#pragma once

#include <string>

#include "support/arguments.hpp"
#include "support/types.hpp"
#include "wakeline/core/fields.hpp"

namespace wakeline::python {

/// The option of that word. Throws ValueError for another word: "several must be 'all', 'nearest'
/// or 'strongest', got 'few'".
template <NamedEnum Option>
Option to_option(const char* name, const std::string& given) {
  for (const auto& word : words_of(Option{}))
    if (given == word.text) return word.value;
  throw py::value_error(std::string(name) + " must be " + choices<Option>() + ", got " +
                        quoted(given));
}

template <NamedEnum Option>
std::string word_of(Option option) {
  for (const auto& word : words_of(option))
    if (word.value == option) return word.text;
  return "";
}

}  // namespace wakeline::python
