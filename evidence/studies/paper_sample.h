// SPDX-License-Identifier: MIT
// The paper's sample: its people, vessels and grasps, and how samples of its size are drawn from a population.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/scene.h"

namespace wholehand {

// The paper's people, and its grasps of each of the three vessels.
constexpr std::size_t PAPER_PEOPLE = 17;
constexpr std::array<std::size_t, 3> PAPER_GRASPS{22, 32, 18};

// The vessel name of rows for all of the paper's vessels together.
inline constexpr const char* ALL_VESSELS = "all";

// Which vessels of a scene can stand for the paper's. The plan of contacts needs guidance points; a session does not.
enum class SampleVessels { with_guidance, any };

// Indices in the scene of the vessels that stand for the paper's first, second and third: up to three, in the scene's order. With a task, these are
// the first from which something is poured; otherwise the first.
std::vector<std::size_t> paper_vessels(const Scene& scene, SampleVessels which);

// Throws Error (usage) if the name is ALL_VESSELS.
void check_sample_name(const Scene& scene, const std::string& vessel);

// `count` people of a repetition, by their numbers below `known`, which is at least 1. The known people are a sample of all people themselves, so
// their own error is drawn too: whoever is drawn goes back twice (Polya's urn, the predictive distribution of Rubin's Bayesian bootstrap, 1981). The
// mean of a trait in a repetition has the variance (1 / count + 1 / known) of the trait's, but for a factor (known - 1) / (known + 1); drawn without
// replacement it would have (1 / count - 1 / known), although the people of a repetition are none of the known.
std::vector<std::size_t> draw_people(std::size_t count, std::size_t known, std::uint64_t& state);

// The next number below `count`, which is at least 1.
std::uint64_t draw_below(std::uint64_t count, std::uint64_t& state);

}  // namespace wholehand
