// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Options that Python knows by words.
#pragma once

#include <cstddef>
#include <string>

#include "support/types.hpp"

namespace wakeline::python {

/// What Python calls an option.
template <class Option>
struct Word {
  const char* text;
  Option option;
};

/// Throws ValueError for another word: "several must be 'all', 'nearest' or 'strongest', got
/// 'few'".
template <class Option, std::size_t N>
Option to_option(const char* name, const std::string& word, const Word<Option> (&words)[N]) {
  std::string wanted;
  for (std::size_t k = 0; k < N; ++k) {
    if (word == words[k].text) return words[k].option;
    wanted += (k == 0 ? "'" : k + 1 < N ? ", '" : " or '") + std::string(words[k].text) + "'";
  }
  throw py::value_error(std::string(name) + " must be " + wanted + ", got '" + word + "'");
}

template <class Option, std::size_t N>
std::string word_of(Option option, const Word<Option> (&words)[N]) {
  for (const Word<Option>& word : words)
    if (word.option == option) return word.text;
  return "";
}

}  // namespace wakeline::python
