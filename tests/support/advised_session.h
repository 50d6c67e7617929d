// SPDX-License-Identifier: MIT
// A session that can be advised about: a beaker with liquid that is gripped, tilted and let go.
#pragma once

#include "base/text/error.h"
#include "core/core_backend.h"
#include "core/evaluator.h"
#include "device/advice/advice_loop.h"
#include "tests/support/live_script.h"
#include "tests/support/session_play.h"

namespace wholehand {

inline Scene advised_session_scene() {
  Scene scene = live_scene();
  scene.strength = StrengthData{};
  return scene;
}

// The first tick of a played session in which the tips are near the beaker and it is not yet held.
inline std::size_t last_free_tick(const std::vector<device::Tick>& record) {
  std::size_t k = 0;
  while (k + 1 < record.size() && !device::is_held(record[k + 1].state)) ++k;
  return k;
}

// The core, which after `good` runs is a device that does not work any more.
class DyingBackend final : public Backend {
 public:
  DyingBackend(const Scene& scene, const FieldSet& fields, int good)
      : core_(make_core_evaluator(scene), scene, fields, Precision::full, 1), good_(good) {}
  const BackendInfo& info() const override { return core_.info(); }
  const FieldSet& fields() const override { return core_.fields(); }
  RunResult run(const RunRequest& request) override {
    if (--good_ < 0) throw failure_error("the device is gone");
    return core_.run(request);
  }
  std::vector<LiquidResult> liquid(std::size_t vessel) override { return core_.liquid(vessel); }
  bool use_fills_of(const Scene& other) override { return core_.use_fills_of(other); }

 private:
  CoreBackend core_;
  int good_;
};

// An adviser whose device fails after `good` runs.
inline device::AdviceLoop::AdviserOpener dying_adviser(int good) {
  return [good](const Scene& own) {
    return std::make_unique<device::Adviser>(own, [good](const Scene& scene, const FieldSet& fields) -> std::unique_ptr<Backend> {
      return std::make_unique<DyingBackend>(scene, fields, good);
    });
  };
}

}  // namespace wholehand
