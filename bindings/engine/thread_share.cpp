// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "thread_share.hpp"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <thread>

#if defined(__linux__)
#include <sched.h>
#endif

namespace wakeline::python {
namespace {

/// To start a thread takes about as long as so many steps.
constexpr std::size_t kWorthThread_steps = 500;

int processors() noexcept {
#if defined(__linux__)
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  if (sched_getaffinity(0, sizeof allowed, &allowed) == 0) return CPU_COUNT(&allowed);
#endif
  return static_cast<int>(std::thread::hardware_concurrency());
}

int initial_limit() noexcept {
  for (const char* name : {"WAKELINE_THREADS", "OMP_NUM_THREADS"})
    if (const char* value = std::getenv(name))
      if (const int threads = std::atoi(value); threads > 0) return threads;
  return std::max(processors(), 1);
}

std::atomic<int>& limit() noexcept {
  static std::atomic<int> threads{initial_limit()};
  return threads;
}

std::atomic<int> others_of_all{0};

}  // namespace

int thread_limit() noexcept { return limit(); }
void set_thread_limit(int threads) noexcept { limit() = std::max(threads, 1); }

ThreadShare::ThreadShare(std::size_t steps) noexcept {
  const int worth = static_cast<int>(std::min<std::size_t>(steps / kWorthThread_steps, 1024));
  int taken = others_of_all;
  do {
    others_ = std::clamp(thread_limit() - 1 - taken, 0, worth);
  } while (!others_of_all.compare_exchange_weak(taken, taken + others_));
}

ThreadShare::~ThreadShare() { others_of_all -= others_; }

}  // namespace wakeline::python
