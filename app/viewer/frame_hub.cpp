// SPDX-License-Identifier: MIT
#include "app/viewer/frame_hub.h"

#include <utility>

namespace wholehand {

std::optional<std::uint64_t> FrameHub::join() {
  const std::lock_guard lock(mutex_);
  if (viewers_ == most_viewers_) return {};
  ++viewers_;
  return number_;
}

void FrameHub::leave() {
  {
    const std::lock_guard lock(mutex_);
    --viewers_;
  }
  changed_.notify_all();
}

int FrameHub::viewers() const {
  const std::lock_guard lock(mutex_);
  return viewers_;
}

void FrameHub::publish(std::string frame) {
  auto shared = std::make_shared<const std::string>(std::move(frame));
  {
    const std::lock_guard lock(mutex_);
    if (is_over_) return;
    frame_ = std::move(shared);
    ++number_;
  }
  changed_.notify_all();
}

void FrameHub::close(const std::string& reason) {
  {
    const std::lock_guard lock(mutex_);
    if (is_over_) return;
    is_over_ = true;
    reason_ = reason;
  }
  changed_.notify_all();
}

FrameHub::Update FrameHub::wait(std::uint64_t seen, std::chrono::milliseconds most) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, most, [&] { return number_ > seen || is_over_; });
  return {number_ > seen ? frame_ : nullptr, number_, is_over_, reason_};
}

}  // namespace wholehand
