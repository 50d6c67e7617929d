// SPDX-License-Identifier: MIT
#include "evidence/studies/paper_sample.h"

#include <fmt/format.h>

#include "base/numbers/random_bits.h"
#include "base/text/error.h"

namespace wholehand {
namespace {

// In a scene with a task, people pour from the vessels with a liquid. What has none is only carried.
bool is_poured(const Scene& scene, const VesselData& vessel) { return !scene.task || !vessel.liquid_name.empty(); }

}  // namespace

std::vector<std::size_t> paper_vessels(const Scene& scene, SampleVessels which) {
  std::vector<std::size_t> places;
  for (std::size_t v = 0; v < scene.vessels.size() && places.size() < PAPER_GRASPS.size(); ++v) {
    const bool is_possible = which == SampleVessels::any || !scene.vessels[v].guidance.empty();
    if (is_possible && is_poured(scene, scene.vessels[v])) places.push_back(v);
  }
  return places;
}

void check_sample_name(const Scene& scene, const std::string& vessel) {
  if (vessel == ALL_VESSELS)
    throw usage_error(fmt::format("{}: a vessel has the name '{}', as the rows of all vessels together; give it another",
                                  scene.file.empty() ? "the scene" : scene.file, ALL_VESSELS));
}

std::uint64_t draw_below(std::uint64_t count, std::uint64_t& state) {
  return static_cast<std::uint64_t>(unit_interval(split_mix(state)) * static_cast<double>(count));
}

std::vector<std::size_t> draw_people(std::size_t count, std::size_t known, std::uint64_t& state) {
  std::vector<std::size_t> drawn;
  while (drawn.size() < count) {
    const std::size_t one = draw_below(known + drawn.size(), state);
    drawn.push_back(one < known ? one : drawn[one - known]);
  }
  return drawn;
}

}  // namespace wholehand
