// SPDX-License-Identifier: MIT
#include "device/recordings/recorder.h"

#include <algorithm>
#include <utility>

#include "base/system/block_signals.h"

namespace wholehand::device {
namespace {

constexpr std::size_t BLOCK = 1024;  // ticks

}  // namespace

Recorder::Recorder(TickRing& ring, std::unique_ptr<RecordingWriter> writer, Observer observer, std::chrono::microseconds interval)
    : ring_(ring), writer_(std::move(writer)), observer_(std::move(observer)), interval_(interval) {
  block_.reserve(BLOCK);
  const BlockSignals inherited;
  thread_ = std::thread([this] { run(); });
}

Recorder::~Recorder() { stop({}); }

// Takes up to a block out of the ring and writes it down; false: there was nothing.
bool Recorder::drain() {
  block_.clear();
  Tick tick;
  while (block_.size() < BLOCK && ring_.pop(tick)) block_.push_back(tick);
  if (block_.empty()) return false;
  if (observer_) observer_(block_);
  // after trouble the writer takes nothing, and what comes is let go
  if (writer_) writer_->append(block_);
  keep_error();
  return true;
}

void Recorder::keep_error() {
  if (!writer_ || writer_->last_error() == reported_) return;
  reported_ = writer_->last_error();
  const std::lock_guard lock(mutex_);
  last_error_ = reported_;
}

void Recorder::run() {
  using Clock = std::chrono::steady_clock;
  auto next = Clock::now() + interval_;
  for (bool is_last = false; !is_last; next = std::max(next + interval_, Clock::now())) {
    {
      std::unique_lock lock(mutex_);
      wake_.wait_until(lock, next, [this] { return is_stopping_; });
      is_last = is_stopping_;
    }
    while (drain()) {
    }
  }
}

std::optional<std::string> Recorder::take_error() {
  const std::lock_guard lock(mutex_);
  return std::exchange(last_error_, std::nullopt);
}

bool Recorder::stop(const RecordingEnd& end) {
  if (!thread_.joinable()) return is_whole_;
  {
    const std::lock_guard lock(mutex_);
    is_stopping_ = true;
  }
  wake_.notify_one();
  thread_.join();
  if (writer_) {
    writer_->finish(end);
    is_whole_ = writer_->is_whole();
    keep_error();
  }
  return is_whole_;
}

}  // namespace wholehand::device
