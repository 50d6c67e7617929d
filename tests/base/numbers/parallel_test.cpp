// SPDX-License-Identifier: MIT
// sanitizers: thread
#include "base/numbers/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace wholehand {
namespace {

TEST(Parallel, EachNumberOnce) {
  for (const int threads : {0, 1, 2, 7})
    for (const std::size_t count : {0, 1, 2, 1000}) {
      std::vector<std::atomic<int>> calls(count);
      in_parallel(count, threads, [&](std::size_t i) { ++calls[i]; });
      EXPECT_TRUE(std::all_of(calls.begin(), calls.end(), [](int n) { return n == 1; })) << threads << " " << count;
    }
}

TEST(Parallel, AsManyThreadsAsAreWished) {
  EXPECT_EQ(thread_count(3), 3);
  EXPECT_GE(thread_count(), 1);
  const std::thread::id caller = std::this_thread::get_id();
  in_parallel(10, 1, [&](std::size_t) { EXPECT_EQ(std::this_thread::get_id(), caller); });
  // three that wait for each other
  std::atomic<int> there{0};
  in_parallel(3, 3, [&](std::size_t) {
    for (++there; there < 3;) std::this_thread::yield();
  });
}

TEST(Parallel, TheCallerIsToldHowManyAreDone) {
  const std::thread::id caller = std::this_thread::get_id();
  for (const int threads : {1, 4}) {
    std::vector<std::size_t> reports;
    in_parallel(
        500, threads, [](std::size_t) {},
        [&](std::size_t done) {
          EXPECT_EQ(std::this_thread::get_id(), caller);
          reports.push_back(done);
        });
    EXPECT_TRUE(std::is_sorted(reports.begin(), reports.end()));
    if (threads == 1) {
      EXPECT_EQ(reports.size(), 500u);
    }
  }
}

// Whoever is faster: 20 always begins, and fails before all others that fail.
TEST(Parallel, TheSmallestFailureIsThrownOn) {
  for (int round = 0; round < 50; ++round) {
    std::atomic<int> begun{0};
    const auto work = [&](std::size_t i) {
      ++begun;
      if (i % 20 != 0 || i == 0) return;
      if (i == 20) std::this_thread::yield();
      throw std::runtime_error(std::to_string(i));
    };
    try {
      in_parallel(100000, 4, work);
      ADD_FAILURE() << "no failure";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "20");
    }
    EXPECT_LT(begun, 100000) << "it goes on after a failure";
  }
}

// The other thread waits until the caller has a number, or it could take all of them before the caller comes.
TEST(Parallel, AFailureOfTheCallersReportIsThrownOn) {
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<bool> has_begun{false};
  const auto work = [&](std::size_t) {
    if (std::this_thread::get_id() == caller) has_begun = true;
    while (!has_begun) std::this_thread::yield();
  };
  EXPECT_THROW(in_parallel(3, 2, work, [](std::size_t) { throw std::runtime_error("no further"); }), std::runtime_error);
}

}  // namespace
}  // namespace wholehand
