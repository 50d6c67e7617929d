// SPDX-License-Identifier: MIT
// The scene behind a handle of the C face.
#pragma once

#include <memory>

#include "app/c/status.h"
#include "core/evaluator.h"
#include "core/reader/asked_grip.h"
#include "core/scene.h"

namespace wholehand {

// A scene prepared for single grips; immutable, and usable by any number of threads.
struct ReadyScene {
  Scene scene;  // with its meshes
  std::shared_ptr<const Evaluator> core;
  AskedGrips allowed;
};

// Reports what is wrong with a grip that `place` asks for, as a line; WH_OK if nothing is.
wh_status check_grip(const AskedGrips& allowed, const GripInput& grip, const char* place) noexcept;

}  // namespace wholehand

struct wh_scene {
  std::shared_ptr<const wholehand::ReadyScene> ready;  // shared with the batches opened on it
};

namespace wholehand {

// Whether the scene has a vessel of this number; `call` begins the failure's line.
inline wh_status check_vessel(const wh_scene* scene, size_t vessel, const char* call) noexcept {
  if (!scene) return fail(WH_ARGUMENT, "%s: the scene is null", call);
  if (vessel < scene->ready->scene.vessels.size()) return WH_OK;
  return fail(WH_ARGUMENT, "%s: the scene has %zu vessels, and none of number %zu", call, scene->ready->scene.vessels.size(),
              vessel);
}

}  // namespace wholehand
