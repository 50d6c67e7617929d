// SPDX-License-Identifier: MIT
// Progress of long work, with its rate and remaining time: a moving line on a terminal, log lines elsewhere.
#pragma once

#include <cstdint>
#include <string>

#include "base/system/clock.h"

namespace wholehand {

// Shows a line on stderr in place of the last one, if stderr is a terminal; "" clears it. For work that is not counted.
void show_status(const std::string& line);

// Announces the duration of work without a Progress, if it takes 5 s or more: "WHAT takes about 51 s".
void announce_time(const std::string& what, double seconds);

enum class ProgressSink {
  none,
  terminal,  // one line, redrawn in place, after half a second
  log,       // one line every ten seconds; the first after one second, if the work takes ten seconds more
};

// Returns terminal if stderr is one, else `otherwise`.
ProgressSink progress_sink(ProgressSink otherwise = ProgressSink::log);

// Writes to stderr.
class Progress {
 public:
  // `total` and `done` count `noun`, which must outlive this; `done` of them existed before (a resumed sweep) and do not count for the rate. `clock`
  // gives seconds.
  Progress(std::uint64_t total, std::uint64_t done, const char* noun, ProgressSink sink = progress_sink(),
           double (*clock)() = monotonic_now);
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  std::uint64_t total() const { return total_; }
  // Whether update would write, for callers whose text is slow to build.
  bool is_due() const;
  // Redraws a terminal's line at most ten times a second.
  void update(const std::string& what, std::uint64_t done);
  // Clears a terminal's line before other output.
  void clear();

  // "beaker2  45 %  12.3 thousand points/s  1:05 left".
  static std::string line(const std::string& what, const char* noun, std::uint64_t total, std::uint64_t before, std::uint64_t done,
                          double seconds);

 private:
  std::uint64_t total_, before_;
  const char* noun_;
  ProgressSink sink_;
  double (*clock_)();
  double start_, next_;  // s; next_: when update writes next
  bool drawn_ = false, logged_ = false;
};

}  // namespace wholehand
