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
// A population large enough for this many samples: a sample draws none twice. Samples of a smaller one would be too alike, and are drawn with
// replacement.
constexpr std::size_t MANY_SAMPLES = 10;
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

// `count` members out of `population`, none twice, in the order drawn. The population has at least as many.
std::vector<std::size_t> draw_different(std::size_t count, std::size_t population, std::uint64_t& state);
// The same for a large population (MANY_SAMPLES); for a smaller one, of at least one member, with replacement.
std::vector<std::size_t> draw_members(std::size_t count, std::size_t population, std::uint64_t& state);

// The next number below `count`, which is at least 1.
std::uint64_t draw_below(std::uint64_t count, std::uint64_t& state);

}  // namespace wholehand
