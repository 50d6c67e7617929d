// SPDX-License-Identifier: MIT
// Random scenes of every kind that a scene file can describe, for unforeseen combinations.
#pragma once

#include <cstdint>
#include <string>

#include "core/scene.h"

namespace wholehand {

// A scene that the reader takes, the same for the same seed: one to three vessels of any shape, outlines of segments and arcs,
// solid or shell, hands of any size and proportion, all poses, tolerances, limits, liquids, forces, tilts and axes of grips. Most
// of it is drawn about what people use, some from the whole of a range and some from its ends. No meshes, which are files. Its
// `text` is the scene file.
Scene random_scene(std::uint64_t seed);

}  // namespace wholehand
