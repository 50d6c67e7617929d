// SPDX-License-Identifier: MIT
// The scene behind a handle of the C face.
#pragma once

#include <memory>

#include "core/evaluator.h"
#include "core/scene.h"

struct wh_scene {
  wholehand::Scene scene;
  std::unique_ptr<const wholehand::Evaluator> core;  // for single grips: made with the scene, used by any thread
};
