// SPDX-License-Identifier: MIT
// The contact forces in a grip's line drawing, as arrows where the hand presses on the vessel.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "sweeps/grips/report.h"
#include "sweeps/grips/view.h"

namespace wholehand::sweeps {

// Lengths and places are mm of the vessel; `unit`: mm of the vessel per mm of paper.
class DrawnForces {
 public:
  // Draws the state of the largest effort. Empty if the report has no holds, or no force of the hand holds that state.
  explicit DrawnForces(const GripReport& report);

  bool empty() const { return arrows_.empty(); }
  // Extends an extent along a unit vector to include the arrows' tails.
  void widen(std::array<double, 2>& extent, const Triple& axis, double unit) const;
  // From the tail outside to the head at the contact; an arrow that is too short in this view is left out.
  void draw(std::string& svg, const DrawnView& view, double unit) const;
  // An arrow as long as the largest force, level from `tail` to the right. Returns its head.
  static Flat draw_longest(std::string& svg, const Flat& tail, double unit);
  // The size of that force, and its state.
  const std::string& words() const { return words_; }
  // The style-sheet rule that the arrows need, in one line.
  static std::string style(double line);

 private:
  struct Arrow {
    Triple head{};   // m
    Triple along{};  // the force as a share of the largest
  };
  std::vector<Arrow> arrows_;  // the largest first, so that it covers none
  std::string words_;
};

}  // namespace wholehand::sweeps
