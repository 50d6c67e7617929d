// SPDX-License-Identifier: MIT
#include "sweeps/grips/methods.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/numbers/nearest.h"
#include "base/text/error.h"
#include "core/capacity.h"
#include "core/counted_tilts.h"
#include "core/gather.h"
#include "host/open_backend.h"

namespace wholehand::sweeps {
namespace {

// At each of the fills that are asked for, how many of the tilts count.
std::vector<std::size_t> asked_tilts(const Scene& scene, std::size_t vessel, const StateAxes& axes) {
  if (axes.tilts == scene.tilts) return counted_tilts(scene, vessel, axes.fills);
  return std::vector<std::size_t>(axes.fills.size(), axes.tilts.size());
}

// Sets the values that the planes of a left-out state have.
void leave_out(GripState& state) {
  constexpr double NONE = std::numeric_limits<double>::quiet_NaN();
  StateResult& forces = state.state;
  forces.pivot_length = forces.torque = forces.exact_torque = NONE;
  forces.normal_force = forces.feedback_force = forces.hold_force = NONE;
  state.counts = false;
}

GripFindings answer_by_core(const Scene& scene, const Evaluator& evaluator, std::size_t vessel, const GripInput& grip,
                            const StateAxes& axes) {
  GripFindings answer;
  evaluator.grip(vessel, grip, answer.result);
  if (answer.result.reason != Reason::none) return answer;
  const std::vector<std::size_t> counted = asked_tilts(scene, vessel, axes);
  for (std::size_t f = 0; f < axes.fills.size(); ++f) {
    for (std::size_t t = 0; t < axes.tilts.size(); ++t) {
      const double fill = axes.fills[f], tilt = axes.tilts[t];
      GripState state{fill, tilt, {}, {}};
      if (scene.liquid) state.liquid = evaluator.liquid(vessel, fill, tilt);
      state.state = evaluator.state(vessel, grip, answer.result, state.liquid, tilt);
      if (t >= counted[f]) leave_out(state);
      answer.states.push_back(state);
    }
  }
  answer.score = evaluator.score(vessel, grip, answer.result);
  return answer;
}

// What a run over one grip leaves: its planes, copied, and the liquid's table. To be moved, not copied: the chunk points into it.
struct GripPlanes {
  FieldSet fields;
  PlaneChunk chunk;
  std::vector<double> reals;
  std::vector<std::uint32_t> uints;
  std::vector<LiquidResult> liquid;

  GripPlanes() = default;
  GripPlanes(GripPlanes&&) = default;
  GripPlanes& operator=(GripPlanes&&) = default;

  bool has(int field) const { return fields.has(field); }
  double real(int field, std::size_t k = 0) const { return reals[fields.plane[field] + k]; }
};

// The efforts over the scene's states, from the grip's planes by `value(field)`. Nothing for an implausible grip.
template <class FieldValue>
std::optional<GripHold> hold_of(const Scene& scene, std::size_t vessel, const FieldValue& value) {
  if (!has_effort(scene) || std::isnan(value(FIELD_WORST_EFFORT))) return std::nullopt;
  const StateAxes own = scene_axes(scene, vessel);
  GripHold hold;
  hold.worst = value(FIELD_WORST_EFFORT);
  hold.worst_fill = nearest_value(own.fills, value(FIELD_WORST_EFFORT_FILL));
  hold.worst_tilt = nearest_value(own.tilts, value(FIELD_WORST_EFFORT_TILT));
  hold.tips_worst = value(FIELD_TIPS_WORST_EFFORT);
  hold.push = value(FIELD_PUSH);
  hold.friction_needed = value(FIELD_FRICTION_NEEDED);
  return hold;
}

GripPlanes run_one(Backend& backend, std::size_t vessel, const GripInput& grip) {
  GripPlanes planes;
  planes.fields = backend.fields();
  RunRequest request;
  request.vessel = vessel;
  request.last = 1;
  request.grips = [&](std::size_t, std::uint64_t, std::size_t count, GripInput* out) { std::fill_n(out, count, grip); };
  request.sink = [&](const PlaneChunk& chunk) {
    for (int p = 0; p < planes.fields.real_kept; ++p) planes.reals.push_back(chunk.real(p, 0));
    for (int p = 0; p < planes.fields.uint_kept; ++p) planes.uints.push_back(chunk.uint(p, 0));
  };
  const RunResult run = backend.run(request);
  if (run.done != 1 || planes.reals.empty() || planes.uints.empty())
    throw failure_error(backend.info().device + ": the grip was not evaluated");
  planes.chunk.count = 1;
  planes.chunk.stride = 1;
  planes.chunk.vessel = vessel;
  planes.chunk.doubles = planes.reals.data();
  planes.chunk.uints = planes.uints.data();
  planes.liquid = backend.liquid(vessel);
  return planes;
}

GripScore score_of(const GripPlanes& planes, const Scene& scene) {
  GripScore score;
  score.score = planes.real(FIELD_SCORE);
  score.not_held = (planes.uints[static_cast<std::size_t>(planes.fields.plane[FIELD_STATUS])] & STATUS_NOT_HELD) != 0;
  const auto term = [&](std::size_t k) { return planes.real(FIELD_TERMS, k); };
  score.terms = {term(0), term(1), term(2), term(3), term(4), term(5)};
  if (!planes.has(FIELD_PEAK_FORCE)) return score;
  const auto tilt = [&](int field, std::size_t f) { return nearest_value(scene.tilts, planes.real(field, f)); };
  for (std::size_t f = 0; f < scene_fills(scene); ++f) {
    score.fills.push_back(
        {planes.real(FIELD_PEAK_FORCE, f), tilt(FIELD_PEAK_TILT, f), planes.real(FIELD_LARGEST_HOLD, f), tilt(FIELD_SAFE_TILT, f)});
  }
  return score;
}

// Planes hold what depends on the grip; mass and center of mass of a state are the core's for the same liquid.
GripState state_of(const GripPlanes& planes, const Evaluator& core, const Scene& scene, std::size_t vessel, const GripInput& grip,
                   const GripResult& result, std::size_t fill, std::size_t tilt) {
  const std::size_t place = fill * scene.tilts.size() + tilt;
  GripState state;
  state.fill = scene.liquid ? vessel_fills(scene, scene.vessels[vessel])[fill] : 0;
  state.tilt = scene.tilts[tilt];
  if (scene.liquid) state.liquid = planes.liquid.at(place);
  const StateResult loaded = core.state(vessel, grip, result, state.liquid, state.tilt);
  state.state.mass = loaded.mass;
  state.state.center_of_mass = loaded.center_of_mass;
  state.state.pivot_length = planes.real(FIELD_PIVOT_LENGTH, place);
  state.state.torque = planes.real(FIELD_TORQUE, place);
  state.state.exact_torque = planes.real(FIELD_EXACT_TORQUE, place);
  state.state.normal_force = planes.real(FIELD_NORMAL_FORCE, place);
  state.state.feedback_force = planes.real(FIELD_FEEDBACK_FORCE, place);
  // with efforts it is the core's, of implausible grips too
  state.state.hold_force = has_effort(scene) ? loaded.hold_force : planes.real(FIELD_HOLD_FORCE, place);
  return state;
}

std::vector<double> ascending(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

std::size_t index_of(const std::vector<double>& values, double value) {
  return static_cast<std::size_t>(std::lower_bound(values.begin(), values.end(), value) - values.begin());
}

// The scene with these states of a vessel. Its largest fill stays: the torque's reference is taken there.
Scene with_states(const Scene& scene, std::size_t vessel, const StateAxes& axes) {
  Scene changed = scene;
  changed.tilts = ascending(axes.tilts);
  if (axes.tilts != scene.tilts) changed.until_poured.reset();
  if (!scene.liquid) return changed;
  const double largest = vessel_fills(scene, scene.vessels[vessel]).back();
  std::vector<double> fills = axes.fills;
  fills.push_back(largest);
  changed.liquid->fills = ascending(fills);
  changed.liquid->volumes.clear();
  for (VesselData& other : changed.vessels) other.fills.clear();
  if (changed.liquid->fills.back() > largest) {
    throw usage_error(
        fmt::format("fill {} of the capacity (--fill, --fill-ml): a device takes at most the scene's largest fill, {}, which gives "
                    "the torque reference; use --on core",
                    changed.liquid->fills.back(), largest));
  }
  return changed;
}

}  // namespace

StateAxes scene_axes(const Scene& scene, std::size_t vessel) {
  StateAxes axes;
  if (scene.liquid) axes.fills = vessel_fills(scene, scene.vessels[vessel]);
  if (scene.liquid && !scene.liquid->volumes.empty() && scene.vessels[vessel].has_cavity())
    axes.capacity = capacity_of(scene.vessels[vessel]);
  axes.tilts = scene.tilts;
  return axes;
}

GripMethods core_grip_methods(const Scene& scene, std::shared_ptr<const Evaluator> evaluator, const std::string& device) {
  return {device, [scene, evaluator = std::move(evaluator)](std::size_t vessel, const GripInput& grip, const StateAxes& axes) {
            return answer_by_core(scene, *evaluator, vessel, grip, axes);
          }};
}

GripMethods backend_grip_methods(const Scene& scene, const BackendOpener& open) {
  std::shared_ptr<Backend> backend = open(scene, all_fields(scene));
  const BackendInfo info = backend->info();
  const std::string device = info.device + (info.backend == "vulkan" && info.is_cpu ? ", a CPU driver" : "") +
                             (info.precision == Precision::single ? ", float" : ", double");
  const std::shared_ptr<const Evaluator> angles = scene.arm ? make_core_evaluator(scene) : nullptr;
  return {device, [scene, open, backend, angles](std::size_t vessel, const GripInput& grip, const StateAxes& axes) {
            GripFindings answer;
            GripPlanes planes = run_one(*backend, vessel, grip);
            answer.result = decode_grip(planes.chunk, planes.fields, 0);
            if (angles) {  // a device keeps the share alone
              GripResult on_core;
              angles->grip(vessel, grip, on_core);
              answer.result.wrist_angles = on_core.wrist_angles;
            }
            answer.is_core_double = false;
            if (answer.result.reason != Reason::none) return answer;
            answer.score = score_of(planes, scene);
            answer.hold = hold_of(scene, vessel, [&](int field) { return planes.real(field); });
            if (axes.tilts.empty()) return answer;

            const StateAxes own = scene_axes(scene, vessel);
            const bool is_own = axes.fills == own.fills && axes.tilts == own.tilts;
            const Scene asked = is_own ? scene : with_states(scene, vessel, axes);
            if (!is_own) planes = run_one(*open(asked, all_fields(asked)), vessel, grip);
            const auto core = make_core_evaluator(asked);
            const std::vector<std::size_t> counted = counted_tilts(asked, vessel);
            for (const double fill : axes.fills) {
              const std::size_t fill_index = asked.liquid ? index_of(vessel_fills(asked, asked.vessels[vessel]), fill) : 0;
              for (const double tilt : axes.tilts) {
                const std::size_t tilt_index = index_of(asked.tilts, tilt);
                GripState state = state_of(planes, *core, asked, vessel, grip, answer.result, fill_index, tilt_index);
                if (tilt_index >= counted[fill_index]) leave_out(state);
                answer.states.push_back(state);
              }
            }
            return answer;
          }};
}

GripMethods open_grip_methods(const Scene& scene, const std::string& on, Precision precision) {
  if (on != "core") {
    return backend_grip_methods(scene, [on, precision](const Scene& opened, const FieldSet& fields) {
      return open_backend(opened, fields, on, precision, 0);
    });
  }
  if (precision == Precision::full) return core_grip_methods(scene, make_core_evaluator(scene), "core, double");
  const std::shared_ptr<const Evaluator> single = make_core_float_evaluator(scene);
  GripMethods methods = core_grip_methods(scene, single, "core, float");
  methods.answer = [scene, single, answer = methods.answer](std::size_t vessel, const GripInput& grip, const StateAxes& axes) {
    GripFindings found = answer(vessel, grip, axes);
    found.is_core_double = false;
    const FieldSet fields = make_field_set({FIELD_WORST_EFFORT, FIELD_WORST_EFFORT_FILL, FIELD_WORST_EFFORT_TILT,
                                            FIELD_TIPS_WORST_EFFORT, FIELD_PUSH, FIELD_FRICTION_NEEDED},
                                           scene);
    const GatheredPlanes planes = gather(*single, fields, vessel, {grip});
    found.hold = hold_of(scene, vessel, [&](int field) { return planes.real(fields.plane[field], 0); });
    return found;
  };
  return methods;
}

}  // namespace wholehand::sweeps
