// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "wakeline/core/fields.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline {

/// Writes or reads the state of an object, field by field, in the byte representation of this
/// machine.
///
/// An object lists its fields once, in `archive(Archive&)`, for both directions. Reading past the
/// end fails and leaves the remaining fields unchanged; check `ok()` at the end.
class Archive {
 public:
  /// An archive to write to.
  Archive() = default;
  /// An archive to read from.
  explicit Archive(std::span<const std::byte> bytes)
      : bytes_(bytes.begin(), bytes.end()), loading_(true) {}

  [[nodiscard]] bool loading() const noexcept { return loading_; }
  [[nodiscard]] bool ok() const noexcept { return ok_; }
  /// True when all bytes have been read.
  [[nodiscard]] bool at_end() const noexcept { return position_ == bytes_.size(); }
  [[nodiscard]] const std::vector<std::byte>& bytes() const noexcept { return bytes_; }

  /// A number, an enumeration or a plain struct of them.
  template <class T>
  requires(std::is_trivially_copyable_v<T>) void operator()(T& value) { raw(&value, sizeof(T)); }

  /// A `bool`; a byte other than 0 or 1 fails.
  void operator()(bool& value) {
    auto byte = static_cast<std::uint8_t>(value);
    raw(&byte, 1);
    if (byte > 1)
      ok_ = false;
    else
      value = byte != 0;
  }

  /// An Eigen vector or matrix; one of dynamic size must already have its size.
  template <class Scalar, int Rows, int Cols, int Options, int MaxRows, int MaxCols>
  void operator()(Eigen::Matrix<Scalar, Rows, Cols, Options, MaxRows, MaxCols>& matrix) {
    raw(matrix.data(), sizeof(Scalar) * static_cast<std::size_t>(matrix.size()));
  }

  /// A vector of plain values, preceded by its length; a length greater than `capacity` fails.
  template <class T>
  requires(std::is_trivially_copyable_v<T>) void operator()(std::vector<T>& values,
                                                            std::size_t capacity) {
    auto size = static_cast<std::uint64_t>(values.size());
    (*this)(size);
    if (loading_) {
      if (!ok_ || size > capacity) {
        ok_ = false;
        return;
      }
      values.resize(static_cast<std::size_t>(size));
    }
    raw(values.data(), sizeof(T) * values.size());
  }

  /// Parameters of an object, numbers or structs with a table of fields: reading others fails.
  template <class... Rules>
  void rules(const Rules&... own) {
    (same(own), ...);
  }

  /// Marks the bytes read as invalid.
  void fail() noexcept { ok_ = false; }

 private:
  template <class Value>
  void same(const Value& own) {
    if constexpr (HasFields<Value>) {
      for_each_field(own, [this](const auto&, const auto& value) { this->same(value); });
    } else {
      Value read = own;
      (*this)(read);
      if (read != own) fail();
    }
  }

  void raw(void* data, std::size_t size) {
    if (!loading_) {
      const auto* begin = static_cast<const std::byte*>(data);
      bytes_.insert(bytes_.end(), begin, begin + size);
      return;
    }
    if (!ok_ || bytes_.size() - position_ < size) {
      ok_ = false;
      return;
    }
    if (size > 0) std::memcpy(data, bytes_.data() + position_, size);
    position_ += size;
  }

  std::vector<std::byte> bytes_;
  std::size_t position_ = 0;
  bool loading_ = false;
  bool ok_ = true;
};

/// 64-bit FNV-1a checksum, to detect damaged bytes.
inline std::uint64_t checksum(std::span<const std::byte> bytes) noexcept {
  std::uint64_t sum = 0xCBF29CE484222325u;
  for (const std::byte byte : bytes)
    sum = (sum ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001B3u;
  return sum;
}

}  // namespace wakeline
