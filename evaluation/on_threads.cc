// SPDX-License-Identifier: BSD-3-Clause
// Threads take the next index from a counter. Whatever is thrown, on any thread and also where a thread
// cannot be had, ends the counting, waits for the calls under way and comes out on the caller's thread.
#include "touchdown/evaluation/on_threads.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace touchdown::evaluation {

void RunOnThreads(int count, int jobs, const std::function<void(int)>& run,
                  const std::function<void(int done, int all)>& progress) {
  std::atomic<int> next{0};
  std::mutex mutex;  // of failure
  std::mutex telling;
  std::exception_ptr failure;
  int done = 0;
  const auto stop = [&] {
    next = count;
    const std::lock_guard lock(mutex);
    if (!failure) failure = std::current_exception();
  };
  const auto work = [&] {
    try {
      for (int i = next++; i < count; i = next++) {
        run(i);
        const std::lock_guard lock(telling);
        progress(++done, count);
      }
    } catch (...) {
      stop();
    }
  };
  std::vector<std::jthread> threads;
  try {
    for (int j = 1; j < std::min(jobs, count); ++j) threads.emplace_back(work);
  } catch (...) {
    stop();
  }
  work();
  threads.clear();  // joins
  if (failure) std::rethrow_exception(failure);
}

}  // namespace touchdown::evaluation
