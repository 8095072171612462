// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include "wakeline/core/environment.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

namespace wakeline {

/// Threads that share the work of one call: the calling one and others created for the call, up to
/// the number wanted.
///
/// A host's own pool has the same interface for `run_batch`: `pool(count, work)` calls `work(k)`
/// once for each k from 0 to count - 1, in any order and on any thread, and returns when all are
/// done. `work` does not throw.
struct Threads {
  int count = 1;

  template <class Work>
  void operator()(std::size_t works, const Work& work) const {
    std::atomic<std::size_t> next{0};
    const auto go_on = [&] {
      for (std::size_t k = next++; k < works; k = next++) work(k);
    };
    const std::size_t helpers = std::min<std::size_t>(static_cast<std::size_t>(std::max(count, 1)),
                                                      std::max<std::size_t>(works, 1)) -
                                1;
    std::vector<std::thread> others;
    others.reserve(helpers);
    while (others.size() < helpers)
      if (!start(others, go_on)) break;
    go_on();
    for (std::thread& other : others) other.join();
  }

 private:
  /// Adds a thread; false when the system cannot create one.
  template <class Work>
  static bool start(std::vector<std::thread>& threads, const Work& work) {
#if defined(__cpp_exceptions)
    try {
      threads.emplace_back(work);
    } catch (const std::exception&) {
      return false;
    }
#else
    threads.emplace_back(work);
#endif
    return true;
  }
};

}  // namespace wakeline
