// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Calls on one object from several threads.
#pragma once

#include <pybind11/pybind11.h>

#include <mutex>
#include <utility>
#include <variant>

namespace wakeline::python {

/// Serialises the calls on an object of which some release the GIL: each call holds the lock from
/// its first access to the object until its results are copied.
class ThreadLock {
 public:
  using Hold = std::unique_lock<std::recursive_mutex>;

  ThreadLock() = default;
  ThreadLock(const ThreadLock& /*of another object*/) noexcept {}
  ThreadLock& operator=(const ThreadLock&) noexcept { return *this; }

  /// Waits without the GIL, which the thread that has the lock needs in order to finish.
  [[nodiscard]] Hold hold() const {
    Hold hold(mutex_, std::try_to_lock);
    if (hold) return hold;
    if (PyGILState_Check()) {
      const pybind11::gil_scoped_release release;
      hold.lock();
    } else {
      hold.lock();
    }
    return hold;
  }

 private:
  mutable std::recursive_mutex mutex_;
};

/// One of several objects, chosen at run time, whose calls are serialised.
template <class... Objects>
class LockedVariant {
 public:
  using Variant = std::variant<Objects...>;

  explicit LockedVariant(Variant&& object) : object_(std::move(object)) {}

  /// Calls a function with the object.
  template <class Function>
  auto visit(const Function& function) {
    const auto hold = lock();
    return std::visit(function, object_);
  }
  template <class Function>
  auto visit(const Function& function) const {
    const auto hold = lock();
    return std::visit(function, object_);
  }

  [[nodiscard]] ThreadLock::Hold lock() const { return lock_.hold(); }

 protected:
  Variant object_;

 private:
  ThreadLock lock_;
};

}  // namespace wakeline::python
