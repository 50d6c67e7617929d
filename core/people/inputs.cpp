// SPDX-License-Identifier: MIT
// A person's shares as the inputs of a model.
#include <initializer_list>
#include <string>
#include <vector>

#include "core/people/person.h"

namespace wholehand {
namespace {

std::vector<std::string> all_input_names() {
  std::vector<std::string> names{"sex", "hand_length", "hand_breadth"};
  for (int f = 0; f < FINGER_COUNT; ++f) {
    const std::string finger = FINGER_NAMES[f];
    for (const char* segment : {"metacarpal", "proximal", "middle", "distal"})
      if (f != 0 || segment != std::string("middle")) names.push_back(finger + "_" + segment);  // the thumb has three
  }
  for (const TraitFacts& trait : trait_facts()) names.emplace_back(trait.key);
  return names;
}

}  // namespace

std::vector<double> person_inputs(const Shares& shares) {
  std::vector<double> inputs{shares.sex, shares.length, shares.breadth};
  inputs.insert(inputs.end(), shares.segments.begin(), shares.segments.end());
  inputs.insert(inputs.end(), shares.traits.begin(), shares.traits.end());
  return inputs;
}

const std::vector<std::string>& person_input_names() {
  static const std::vector<std::string> names = all_input_names();
  return names;
}

}  // namespace wholehand
