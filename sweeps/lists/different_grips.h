// SPDX-License-Identifier: MIT
// Filters similar grips: a list takes a grip only if its hand differs from every earlier hand.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "core/backend.h"
#include "core/result.h"

namespace wholehand::sweeps {

// Whether some joint of one posed hand is more than `apart` (m) away from the same joint of the other. A grip without a hand, infeasible on the core,
// differs from every other. With `apart` 0 any two grips differ.
bool are_different(const std::optional<PosedHand>& a, const std::optional<PosedHand>& b, double apart);

// The first `size` of the offered grips that differ from every earlier one. Offer them in the order of is_better.
class DifferentGrips {
 public:
  DifferentGrips(std::size_t size, double apart) : size_(size), apart_(apart) {}

  bool is_full() const { return chosen_.size() >= size_; }
  bool differs(const std::optional<PosedHand>& hand) const;  // from every chosen one
  void offer(const Candidate& candidate, const std::optional<PosedHand>& hand);
  const std::vector<Candidate>& chosen() const { return chosen_; }

 private:
  using Cell = std::array<std::int64_t, 3>;
  Cell cell_of(const PosedHand& hand) const;

  std::size_t size_;
  double apart_;
  std::vector<Candidate> chosen_;
  // Keyed by the cell of one of their joints: similar hands have neighboring cells.
  std::map<Cell, std::vector<PosedHand>> hands_;
};

}  // namespace wholehand::sweeps
