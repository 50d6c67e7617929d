// SPDX-License-Identifier: MIT
// The scenes of examples/extreme, by their names, and their grips as the core answers them.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/evaluator.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "sweeps/plan/plan.h"
#include "tests/support/whole_parity.h"

namespace wholehand {

// Beside the shipped scenes, as tests also run where the sources are not.
inline std::string extreme_folder() { return scenes_dir() + "/../extreme/"; }

inline Scene extreme_scene(const std::string& name) { return read_scene_file(extreme_folder() + name + ".toml"); }

// Names of all extreme scenes, sorted.
inline std::vector<std::string> extreme_names() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(extreme_folder())) names.push_back(entry.path().stem());
  std::sort(names.begin(), names.end());
  EXPECT_FALSE(names.empty());
  return names;
}

// A case with every grip of its first vessel and of the others, answered.
struct AnsweredScene {
  explicit AnsweredScene(const Scene& asked) : scene(asked), core(make_core_evaluator(asked)), fields(all_fields(asked)) {
    const sweeps::Plan plan(scene, true);
    for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
      grips.emplace_back(plan.grips());
      plan.fill(v, 0, grips[v].size(), grips[v].data());
      planes.push_back(gather(*core, fields, v, grips[v]));
    }
  }

  std::uint32_t status(std::size_t v, std::size_t i) const { return planes[v].uint(FIELD_STATUS, i); }
  std::uint32_t reason(std::size_t v, std::size_t i) const { return status(v, i) & STATUS_REASON_MASK; }
  bool feasible(std::size_t v, std::size_t i) const { return reason(v, i) == REASON_NONE; }
  bool antipodal(std::size_t v, std::size_t i) const { return (status(v, i) & STATUS_ANTIPODAL) != 0; }
  double real(int field, std::size_t v, std::size_t i, std::size_t plane = 0) const {
    return planes[v].real(fields.plane[field] + static_cast<int>(plane), i);
  }
  GripResult result(std::size_t v, std::size_t i) const {
    GripResult answer;
    core->grip(v, grips[v][i], answer);
    return answer;
  }
  std::size_t states() const { return scene_fills(scene) * scene.tilts.size(); }

  // Every feasible grip, and in every state.
  void each(const std::function<void(std::size_t v, std::size_t i)>& look) const {
    for (std::size_t v = 0; v < grips.size(); ++v)
      for (std::size_t i = 0; i < grips[v].size(); ++i)
        if (feasible(v, i)) look(v, i);
  }
  void each_state(const std::function<void(std::size_t v, std::size_t i, std::size_t state)>& look) const {
    each([&](std::size_t v, std::size_t i) {
      for (std::size_t s = 0; s < states(); ++s) look(v, i, s);
    });
  }
  std::size_t count_feasible() const {
    std::size_t count = 0;
    each([&](std::size_t, std::size_t) { ++count; });
    return count;
  }

  Scene scene;
  std::unique_ptr<Evaluator> core;
  FieldSet fields;
  std::vector<std::vector<GripInput>> grips;
  std::vector<GatheredPlanes> planes;
};

}  // namespace wholehand
