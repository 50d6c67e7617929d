// SPDX-License-Identifier: MIT
// Stand-ins for the kernels: cheap values that depend on every bit of a grip, so that a grip in the wrong place is seen.
#pragma once

#include <functional>

#include "core/backend.h"
#include "core/evaluator.h"

namespace wholehand {

// A scene of two vessels with liquid and tilts: azimuth 3 x height 7 x obliquity 5 x roll 4 x offset 2 x hand scale 1.
Scene fake_scene();

// `count` values from `from` to `to`.
Axis range_axis(double from, double to, int count);

// What the stand-ins give for plane `plane` of a field; NaN where the grip is infeasible (score and terms: 0).
double fake_real(std::size_t vessel, const GripInput& grip, int field, int plane);
// Status and masks. One grip in five is infeasible, for each of the reasons; one in four of the others is implausible.
std::uint32_t fake_uint(std::size_t vessel, const GripInput& grip, int field);

// A hand that is moved as a whole: (height, obliquity, roll) as a place, the offset added to the height; nothing of an infeasible
// grip.
std::optional<PosedHand> fake_hand(std::size_t vessel, const GripInput& grip);

class FakeEvaluator : public Evaluator {
 public:
  explicit FakeEvaluator(const Scene& scene) : scene_(scene) {}
  void grip(std::size_t, const GripInput&, GripResult& result) const override { result = {}; }
  LiquidResult liquid(std::size_t vessel, double fill, double tilt) const override;
  StateResult state(std::size_t, const GripInput&, const GripResult&, const LiquidResult&, double, double) const override {
    return {};
  }
  GripScore score(std::size_t, const GripInput&, const GripResult&) const override { return {}; }
  void planes(std::size_t vessel, const GripInput* grips, std::size_t count, const FieldSet& fields, std::size_t stride,
              double* reals, std::uint32_t* uints, double least_score) const override;
  double distance(std::size_t, const Triple&) const override { return 0; }
  Triple gradient(std::size_t, const Triple&) const override { return {}; }
  VesselConstants constants(std::size_t vessel) const override {
    const double k = static_cast<double>(vessel + 1);
    return {1e-4 * k, 0.1 * k, {0, 0.05 * k, 0}, 0, 0, 0, 0};
  }
  double pouring_tilt(std::size_t, double fill) const override;
  std::optional<PosedHand> posed(std::size_t vessel, const GripInput& grip) const override;
  double gap_at(double closure) const override { return 0.1 * (1 - closure); }

  // Called before every chunk, from any thread: to wait, or to throw.
  std::function<void()> before_chunk;

 private:
  Scene scene_;
};

// One chunk after the other on the calling thread, at either precision; only the kept planes exist.
class FakeBackend : public Backend {
 public:
  FakeBackend(const Scene& scene, const FieldSet& fields, Precision precision, std::size_t chunk);
  const BackendInfo& info() const override { return info_; }
  const FieldSet& fields() const override { return fields_; }
  RunResult run(const RunRequest& request) override;
  std::vector<LiquidResult> liquid(std::size_t vessel) override;

  BackendInfo info_;
  std::function<void()> before_run, before_chunk;
  std::uint64_t evaluated = 0;  // grips

 private:
  Scene scene_;
  FieldSet fields_;
  std::size_t chunk_;
  FakeEvaluator evaluator_;
};

}  // namespace wholehand
