// SPDX-License-Identifier: MIT
#include "base/numbers/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace wholehand {

int thread_count(int requested) {
  return requested > 0 ? requested : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

void in_parallel(std::size_t count, int threads, const std::function<void(std::size_t)>& work,
                 const std::function<void(std::size_t)>& after) {
  std::atomic<std::size_t> next{0}, done{0};
  std::mutex failing;
  std::exception_ptr failure;
  std::size_t failed = count;
  const auto take = [&](bool is_caller) {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        work(i);
        const std::size_t so_far = ++done;
        if (is_caller && after) after(so_far);
      } catch (...) {
        // all smaller numbers have begun, so the smallest failure does not depend on thread speed
        next = count;
        const std::lock_guard lock(failing);
        if (i < failed) {
          failed = i;
          failure = std::current_exception();
        }
      }
    }
  };
  {
    std::vector<std::jthread> others;
    try {
      for (std::size_t w = 1; w < std::min<std::size_t>(thread_count(threads), count); ++w) others.emplace_back(take, false);
    } catch (const std::system_error&) {
      // the machine has no further thread; the existing ones do all the work
    }
    take(true);
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace wholehand
