// SPDX-License-Identifier: MIT
// One line on the terminal while long work runs: how much is done, how fast, how long yet.
#pragma once

#include <cstdint>
#include <string>

#include "system/clock.h"

namespace wholehand {

// Shows a line on stderr over the last one, where that is a terminal; "" wipes it. For work that is not counted.
void show_status(const std::string& line);

// Shows nothing where stderr is not a terminal, nor in the first half second.
class Progress {
 public:
  // `total` and `done` count what `noun` says, which must outlive it; `done` of them were there before (a resumed sweep) and say
  // nothing about the rate.
  Progress(std::uint64_t total, std::uint64_t done, const char* noun = "grips");
  Progress(std::uint64_t total, std::uint64_t done, const char* noun, bool is_terminal);
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // Whether update would draw: for those whose words take long to put together.
  bool is_due() const;
  // Draws at most ten times a second.
  void update(const std::string& what, std::uint64_t done);
  // Wipes the line, before something else is printed.
  void clear();

  // "beaker2  45 %  12.3 thousand grips/s  1:05 left".
  static std::string line(const std::string& what, const char* noun, std::uint64_t total, std::uint64_t before, std::uint64_t done,
                          double seconds);

 private:
  std::uint64_t total_, before_;
  const char* noun_;
  bool shown_, drawn_ = false;
  double start_ = monotonic_now(), last_ = start_ + 0.4;  // s
};

}  // namespace wholehand
