// SPDX-License-Identifier: MIT
// Passes messages of a running live session to the main thread: ticks from the recorder's thread, advice from the one that computes it.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "device/run/report.h"

namespace wholehand::device {

class Board {
 public:
  // `scene` must outlive it.
  explicit Board(const Scene& scene) : narrator_(scene), advice_narrator_(scene) {}
  // Takes ticks in order, from one thread.
  void look(std::span<const Tick> ticks);
  // Prints what is new; `quiet`: only the status, and only on a terminal. Throws Error as print does.
  void show(bool quiet);
  // Takes the newest advice, from one thread; null: there is none.
  void advise(const std::shared_ptr<const Advice>& advice);
  // The newest tick, and the number of ticks so far.
  Tick last();
  std::int64_t count();

 private:
  Narrator narrator_;
  AdviceNarrator advice_narrator_;
  std::shared_ptr<const Advice> newest_, narrated_;
  std::mutex mutex_;  // of all that follows
  Tick last_;
  std::int64_t count_ = 0;
  std::vector<std::string> lines_;
  std::string status_, advice_;
};

}  // namespace wholehand::device
