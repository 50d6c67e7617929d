// SPDX-License-Identifier: MIT
// The newest frame of a live view, from the one who makes them to all who watch.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

namespace wholehand {

// Frames are made once for all viewers. Who is slow gets the newest when he comes again, and nobody waits for him. From any thread.
class FrameHub {
 public:
  explicit FrameHub(int most_viewers) : most_viewers_(most_viewers) {}

  // Number of the newest frame at that moment (0: none yet): who joins waits for the one after it, and misses none that is published from
  // then on. Nothing: there are as many viewers as there may be. Who joined leaves.
  std::optional<std::uint64_t> join();
  void leave();
  int viewers() const;

  void publish(std::string frame);
  // No more frames; the first reason stays.
  void close(const std::string& reason);

  struct Update {
    std::shared_ptr<const std::string> frame;  // null: none since
    std::uint64_t number = 0;                  // of it
    bool is_over = false;                      // and `frame` is the last
    std::string reason;
  };
  // What is newer than the frame of that number (0: any), waited for so long at most.
  Update wait(std::uint64_t seen, std::chrono::milliseconds most);

 private:
  const int most_viewers_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  int viewers_ = 0;
  std::uint64_t number_ = 0;
  std::shared_ptr<const std::string> frame_;
  bool is_over_ = false;
  std::string reason_;
};

}  // namespace wholehand
