// SPDX-License-Identifier: MIT
// How much of long work is done, how fast it goes and how long it takes yet: a line that moves on a terminal, lines of a log elsewhere.
#pragma once

#include <cstdint>
#include <string>

#include "base/system/clock.h"

namespace wholehand {

// Shows a line on stderr over the last one, where that is a terminal; "" wipes it. For work that is not counted.
void show_status(const std::string& line);

// Announces how long work takes that is not shown by a Progress yet, where that is 5 s or more: "WHAT takes about 51 s".
void announce_time(const std::string& what, double seconds);

enum class ProgressSink {
  none,
  terminal,  // one line that is drawn over, after half a second
  log,       // a line every ten seconds; the first after one second, if the work takes ten seconds more
};

// terminal where stderr is one, else `otherwise`.
ProgressSink progress_sink(ProgressSink otherwise = ProgressSink::log);

// Writes to stderr.
class Progress {
 public:
  // `total` and `done` count what `noun` says, which must outlive it; `done` of them were there before (a resumed sweep) and say
  // nothing about the rate. `clock` counts seconds.
  Progress(std::uint64_t total, std::uint64_t done, const char* noun, ProgressSink sink = progress_sink(),
           double (*clock)() = monotonic_now);
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  std::uint64_t total() const { return total_; }
  // Whether update may write: for those whose words take long to put together.
  bool is_due() const;
  // Draws at most ten times a second on a terminal.
  void update(const std::string& what, std::uint64_t done);
  // Wipes a terminal's line, before something else is printed.
  void clear();

  // "beaker2  45 %  12.3 thousand points/s  1:05 left".
  static std::string line(const std::string& what, const char* noun, std::uint64_t total, std::uint64_t before, std::uint64_t done,
                          double seconds);

 private:
  std::uint64_t total_, before_;
  const char* noun_;
  ProgressSink sink_;
  double (*clock_)();
  double start_, next_;  // s; next_: when update writes
  bool drawn_ = false, logged_ = false;
};

}  // namespace wholehand
