// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "support/tests_dir.hpp"

namespace wakeline::test {

/// tests/golden: results of independent references, read by both the C++ and the Python tests.
inline const std::filesystem::path kGoldenDir = tests_dir() / "golden";
/// tests/data: inputs of tests.
inline const std::filesystem::path kDataDir = tests_dir() / "data";

/// A file of tests/golden, for example `golden("multiple_models.json")`.
inline nlohmann::json golden(const std::string& name) {
  std::ifstream file(kGoldenDir / name);
  if (!file) throw std::runtime_error("cannot open " + (kGoldenDir / name).string());
  return nlohmann::json::parse(file);
}

/// A list of numbers as a vector. `null` is NaN.
inline Eigen::VectorXd to_vector(const nlohmann::json& list) {
  Eigen::VectorXd vector(static_cast<Eigen::Index>(list.size()));
  for (std::size_t i = 0; i < list.size(); ++i) {
    vector(static_cast<Eigen::Index>(i)) =
        list[i].is_null() ? std::numeric_limits<double>::quiet_NaN() : list[i].get<double>();
  }
  return vector;
}

/// A list of equally long lists of numbers as a matrix, one inner list a row.
inline Eigen::MatrixXd to_matrix(const nlohmann::json& rows) {
  const std::size_t cols = rows.empty() ? 0 : rows[0].size();
  Eigen::MatrixXd matrix(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(cols));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].size() != cols)
      throw std::runtime_error("the rows of a golden matrix differ in length");
    matrix.row(static_cast<Eigen::Index>(i)) = to_vector(rows[i]).transpose();
  }
  return matrix;
}

}  // namespace wakeline::test
