// SPDX-License-Identifier: MIT
// The scene of a recording, as its session had it.
#pragma once

#include "core/scene.h"
#include "recordings/recording.h"

namespace wholehand {

// Parses the recorded text, and gives the scene the hand of the virtual person who made the recording, if one did. Throws Error
// (usage) as parse_scene does. Meshes are not loaded.
Scene scene_of_recording(const RecordingInfo& info);

// Gives a scene the hand of a virtual person, by the scene's own [people].
void take_hand_of(Scene& scene, std::uint64_t seed, std::uint64_t person);

}  // namespace wholehand
