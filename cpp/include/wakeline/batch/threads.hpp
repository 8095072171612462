// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace wakeline {

/// Threads that share the work of one call: this one, and others that live as long as it.
///
/// What `run_batch` asks of a host's own pool is the same: `pool(count, work)` calls `work(k)` once
/// for each k from 0 to count - 1, in any order and on any thread, and returns when all are done.
/// `work` does not throw.
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
    for (std::size_t k = 0; k < helpers; ++k) others.emplace_back(go_on);
    go_on();
    for (std::thread& other : others) other.join();
  }
};

}  // namespace wakeline
