// SPDX-License-Identifier: MIT
#include "device/run/board.h"

#include <utility>

#include "base/system/output.h"
#include "base/system/progress.h"
#include "device/advice/words.h"

namespace wholehand::device {

void Board::look(std::span<const Tick> ticks) {
  std::vector<std::string> lines;
  for (const Tick& tick : ticks) {
    for (std::string& line : narrator_.look(tick)) lines.push_back(std::move(line));
  }
  const std::string status = narrator_.status(ticks.back());
  const std::lock_guard lock(mutex_);
  for (std::string& line : lines) lines_.push_back(std::move(line));
  status_ = status;
  last_ = ticks.back();
  count_ += static_cast<std::int64_t>(ticks.size());
}

void Board::advise(const std::shared_ptr<const Advice>& advice) {
  if (advice == newest_) return;
  newest_ = advice;
  std::string words = advice ? advice_words(*advice) : "";
  std::optional<std::string> line;
  if (advice && advice != narrated_) line = advice_narrator_.narrate(*advice);
  if (advice) narrated_ = advice;
  const std::lock_guard lock(mutex_);
  if (line) lines_.push_back(std::move(*line));
  advice_ = std::move(words);
}

Tick Board::last() {
  const std::lock_guard lock(mutex_);
  return last_;
}

std::int64_t Board::count() {
  const std::lock_guard lock(mutex_);
  return count_;
}

void Board::show(bool quiet) {
  std::vector<std::string> lines;
  std::string status;
  {
    const std::lock_guard lock(mutex_);
    lines.swap(lines_);
    status = status_;
    if (!status.empty() && !advice_.empty()) status += "  " + advice_;
  }
  if (!lines.empty() && !quiet) {
    show_status("");
    for (const std::string& line : lines) print(line + "\n");
  }
  show_status(status);
}

}  // namespace wholehand::device
