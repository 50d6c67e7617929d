// SPDX-License-Identifier: MIT
// The remaining grips of a sweep as one row of numbers, from which ranks take pieces.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace wholehand::sweeps {

// Grips [first, last) of a vessel.
struct GripRange {
  std::size_t vessel = 0;
  std::uint64_t first = 0, last = 0;
  bool operator==(const GripRange&) const = default;
};

class WorkRange {
 public:
  // `left`: one after the other, in the order of distribution.
  explicit WorkRange(std::vector<GripRange> left);

  std::uint64_t size() const { return size_; }
  // The grips of the numbers first .. first + count - 1; fewer at the end.
  std::vector<GripRange> piece(std::uint64_t first, std::uint64_t count) const;

 private:
  std::vector<GripRange> left_;
  std::uint64_t size_ = 0;
};

// How many grips a rank takes at a time: few at first, while its speed is unknown; then as many as it does in some seconds; towards the end no more
// than a part of what is left, so that nobody waits long for the last.
class PieceSize {
 public:
  // `all`: grips of all ranks; `seconds`: the least duration of a piece while much is left.
  PieceSize(int ranks, std::uint64_t all, double seconds) : ranks_(ranks), all_(all), seconds_(seconds) {}
  // `left`: remaining grips of all ranks, as far as this rank knows; `elapsed`: s since the work began.
  std::uint64_t next(std::uint64_t left, double elapsed) const;
  void done(std::uint64_t grips, double seconds);

 private:
  int ranks_;
  std::uint64_t all_;
  double seconds_;
  double rate_ = 0;  // grips a second
};

}  // namespace wholehand::sweeps
