// SPDX-License-Identifier: MIT
// Scenes as people write them, drawn by chance: every key within what people use.
#pragma once

#include <cstdint>

#include "core/scene.h"

namespace wholehand {

// A scene that the reader takes, the same for the same seed: one or two vessels for a hand (shapes, outlines, now and then a mesh of the same
// form), a person's hand, liquids, forces, strengths, tilts, table and deviations, and 100 to 500 grips of each vessel. Its `text` is
// the scene file, in which a mesh is still the form that the mesh is made of.
Scene natural_scene(std::uint64_t seed);

}  // namespace wholehand
