// SPDX-License-Identifier: MIT
// sweeps/lists/different_grips.h: a list of grips of which no two hold the hand at nearly the same place.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "core/evaluator.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "sweeps/lists/different_grips.h"

using namespace wholehand;

static GripInput at_height(std::uint64_t number) {
  GripInput grip;
  grip.height = 30e-3 + 1e-3 * static_cast<double>(number);
  return grip;
}

// The longest way of a joint from one hand to the other, m.
static double largest_step(const PosedHand& a, const PosedHand& b) {
  double largest = 0;
  for (std::size_t joint = 0; joint < a.size(); ++joint)
    largest = std::max(largest, std::hypot(a[joint][0] - b[joint][0], a[joint][1] - b[joint][1], a[joint][2] - b[joint][2]));
  return largest;
}

int main() {
  const Scene scene = read_scene_file(find_scene("three_beakers"));
  const auto evaluator = make_core_evaluator(scene);
  constexpr double APART = 25e-3;  // m
  sweeps::DifferentGrips list(3, APART);
  // a grip each millimeter up the glass: nearly all are twins of the one before
  for (std::uint64_t number = 0; number < 60 && !list.is_full(); ++number) {
    list.offer({0, number}, evaluator->posed(0, at_height(number)));
  }
  std::vector<PosedHand> hands;
  for (const Candidate& grip : list.chosen()) {
    std::printf("grip %llu, at %llu mm\n", static_cast<unsigned long long>(grip.index),
                static_cast<unsigned long long>(30 + grip.index));
    hands.push_back(*evaluator->posed(0, at_height(grip.index)));
  }
  const bool are_apart = largest_step(hands[0], hands[1]) > APART && largest_step(hands[1], hands[2]) > APART;
  return list.is_full() && are_apart ? 0 : 1;
}
