// SPDX-License-Identifier: MIT
// Vessels read from mesh files that the test writes.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/text/error.h"
#include "core/meshes/vessel.h"
#include "tests/support/files.h"
#include "tests/support/meshes.h"
#include "tests/support/refusal.h"
#include "tests/support/whole_parity.h"

namespace wholehand {

class MeshVessel : public testing::Test {
 protected:
  // A vessel whose file holds that mesh, not yet read.
  VesselData of_file(const std::string& name, const TriangleMesh& mesh, double spacing) {
    std::ofstream((folder_ / (name + ".glb")).string(), std::ios::binary) << glb_text(mesh);
    VesselData vessel;
    vessel.name = name;
    vessel.mesh.emplace();
    vessel.mesh->place = "scene.toml:3:8";
    vessel.mesh->file = name + ".glb";
    if (spacing > 0) vessel.mesh->lattice_spacing = spacing;
    return vessel;
  }

  // Seconds that each look at the clock takes; 0: the machine's clock.
  double seconds_a_look_ = 0;

  // Read, in a scene with everything that a vessel can be asked.
  Scene loaded(std::vector<VesselData> vessels, const HandData& hand = paper_hand()) {
    Scene scene = wet_scene(std::move(vessels), Pose::articulated, hand);
    scene.file = (folder_ / "scene.toml").string();
    said_.clear();
    MeshOptions options;
    options.cache_folder = folder_.string();
    if (seconds_a_look_ > 0) options.clock = [this, now = 0.0]() mutable { return now += seconds_a_look_; };
    options.say = [this](const std::string& line) { said_ += line + "\n"; };
    load_meshes(scene, options);
    return scene;
  }

  std::string refusal(const VesselData& vessel) {
    return refusal_line([&] { loaded({vessel}); });
  }

  TemporaryFolder temporary_;  // its cache of lattices is no other process's
  std::filesystem::path folder_{temporary_.path()};
  std::string said_;
};

// The cavity of an outline with a wall as an inner outline.
inline std::vector<OutlineElement> inner_outline_of(const VesselData& vessel) {
  const PreparedVessel prepared = prepare_vessel(vessel, true);
  std::vector<OutlineElement> inner{{false, {0, prepared.floor_height}, {}, 0, 0}};
  std::array<double, 2> at{0, prepared.floor_height};
  for (const PreparedElement& piece : prepared.cavity) {
    if (piece.a != at) inner.push_back({false, piece.a, {}, 0, 0});
    inner.push_back({piece.side != 0, piece.b, piece.center, 0, 0});
    at = piece.b;
  }
  return inner;
}

}  // namespace wholehand
