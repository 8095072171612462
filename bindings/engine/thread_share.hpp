// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// The threads that calls of this process share.
#pragma once

#include <cstddef>

namespace wakeline::python {

/// Threads that all calls at one time may use together: `WAKELINE_THREADS` or `OMP_NUM_THREADS` of
/// the environment, else the processors that the process may run on, unless set.
int thread_limit() noexcept;
void set_thread_limit(int threads) noexcept;

/// The part of the threads that one call gets: all that no other call has, at least its own, and no
/// more than its work is worth. Given back at its end.
class ThreadShare {
 public:
  /// For so many steps of an estimator.
  explicit ThreadShare(std::size_t steps) noexcept;
  ~ThreadShare();
  ThreadShare(const ThreadShare&) = delete;
  ThreadShare& operator=(const ThreadShare&) = delete;

  [[nodiscard]] int count() const noexcept { return 1 + others_; }

 private:
  int others_ = 0;
};

}  // namespace wakeline::python
