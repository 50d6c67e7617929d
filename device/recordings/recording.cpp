// SPDX-License-Identifier: MIT
#include "device/recordings/recording.h"

#include <algorithm>

#include "core/people/person.h"
#include "core/reader/reader.h"

namespace wholehand::device {

Scene scene_of_recording(const RecordingInfo& info) {
  Scene scene = parse_scene(info.scene_text, info.scene_file);
  if (info.person) take_hand_of(scene, info.seed, *info.person);
  return scene;
}

bool has_same_vessels(const RecordingInfo& a, const RecordingInfo& b) {
  return std::equal(a.vessels.begin(), a.vessels.end(), b.vessels.begin(), b.vessels.end(),
                    [](const RecordedVessel& x, const RecordedVessel& y) { return x.name == y.name && x.liquid == y.liquid; });
}

void take_hand_of(Scene& scene, std::uint64_t seed, std::uint64_t person) {
  scene.hand = hand_of(scene.hand, draw_person(scene.people, seed, person));
}

}  // namespace wholehand::device
