// SPDX-License-Identifier: MIT
// Passes the newest frame of a live view from its maker to all viewers.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

namespace wholehand {

// Each frame is made once for all viewers. A slow viewer gets the newest one on return, and nobody waits for it. From any thread.
class FrameHub {
 public:
  explicit FrameHub(int most_viewers) : most_viewers_(most_viewers) {}

  // Joins as a viewer. Returns the newest frame's number at that moment (0: none yet); a viewer who waits for the next one misses nothing published
  // later. Nothing: there are as many viewers as allowed. Every viewer who joined must leave.
  std::optional<std::uint64_t> join();
  void leave();
  int viewers() const;

  void publish(std::string frame);
  // Ends the frames; the first reason stays.
  void close(const std::string& reason);

  struct Update {
    std::shared_ptr<const std::string> frame;  // null: none since
    std::uint64_t number = 0;                  // of it
    bool is_over = false;                      // and `frame` is the last
    std::string reason;
  };
  // A frame newer than that number (0: any), waiting at most so long.
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
