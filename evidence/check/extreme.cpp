// SPDX-License-Identifier: MIT
#include "evidence/check/extreme.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>

#include "base/files/csv.h"
#include "base/text/error.h"
#include "core/core_backend.h"
#include "core/fields.h"
#include "host/grip_backend.h"
#include "shaders/status.h"
#include "sweeps/plan/plan.h"

namespace wholehand {
namespace {

// What follows `head` in the text's line that begins with it.
std::string line_after(const Scene& scene, const std::string& head) {
  for (std::size_t at = 0; at < scene.text.size();) {
    const std::size_t end = std::min(scene.text.find('\n', at), scene.text.size());
    if (scene.text.compare(at, head.size(), head) == 0) return scene.text.substr(at + head.size(), end - at - head.size());
    at = end + 1;
  }
  throw usage_error(fmt::format("{}: lacks the line '{}..', which every extreme scene has", scene.file, head));
}

std::vector<GripInput> spread_grips(const sweeps::Plan& plan, std::size_t vessel, std::size_t most) {
  const std::uint64_t all = plan.grips(), count = std::min<std::uint64_t>(all, most);
  std::vector<GripInput> grips;
  for (std::uint64_t i = 0; i < count; ++i) grips.push_back(plan.grip(vessel, count == all ? i : (i * 2654435761u) % all));
  return grips;
}

// The largest difference of a field over the grips that are compared, infinities of one sign being the same.
double largest_difference(int field, const Scene& scene, const GatheredPlanes& a, const GatheredPlanes& b,
                          const std::vector<char>& compared) {
  double largest = 0;
  if (!a.fields.has(field)) return largest;
  const int planes = field_planes(field, scene_fills(scene), scene.tilts.size());
  for (int p = 0; p < planes; ++p) {
    for (std::size_t i = 0; i < a.count; ++i) {
      const double x = a.real(a.fields.plane[field] + p, i), y = b.real(b.fields.plane[field] + p, i);
      if (compared[i] != 0) largest = std::max(largest, figure_difference(x, y));
    }
  }
  return largest;
}

// One backend's answer to a case, vessel by vessel, beside the core's in double.
class ExtremeTally {
 public:
  // `is_truth`: the backend is the core in double itself
  ExtremeTally(const ExtremeCase& extreme, const Evaluator& truth, const BackendInfo& info, bool is_truth)
      : scene_(extreme.scene), truth_(truth) {
    if (!is_truth) comparer_.emplace(scene_, truth, allowance(info.precision));
    row_.name = extreme.name;
    row_.backend = info.backend;
    row_.device = info.device;
    row_.driver = info.driver;
    row_.precision = info.precision;
  }

  // Iterations, which only an evaluator that is called grip by grip reports.
  void count_steps(const Evaluator& core, std::size_t vessel, const std::vector<GripInput>& grips) {
    for (const GripInput& grip : grips) {
      GripResult result;
      core.grip(vessel, grip, result);
      row_.trace_steps = std::max(row_.trace_steps, result.trace_steps);
      row_.advance_steps = std::max(row_.advance_steps, result.advance_steps);
    }
  }

  void add(std::size_t vessel, const std::vector<GripInput>& grips, const GatheredPlanes& own, const GatheredPlanes& full) {
    std::vector<char> compared(grips.size(), 1);
    for (std::size_t i = 0; i < grips.size(); ++i) {
      const std::uint32_t status = own.uint(FIELD_STATUS, i), true_status = full.uint(FIELD_STATUS, i);
      count(status);
      const auto differs = [&](int field) { return own.uint(field, i) != full.uint(field, i); };
      const bool same = ((status ^ true_status) & ~std::uint32_t(STATUS_CONTACT_UNDECIDED)) == 0 && !differs(FIELD_TOUCH_MASK) &&
                        !differs(FIELD_USED_MASK);
      const bool feasible = is_feasible(true_status);
      compared[i] = same && feasible && ((status | true_status) & STATUS_GRAZING) == 0 ? 1 : 0;
    }
    const Misplaced misplaced =
        misplaced_values(scene_, vessel, own.fields, own.count, own.count, own.reals.data(), own.uints.data());
    if (row_.misplaced == 0) row_.first_misplaced = describe(misplaced);
    row_.misplaced += misplaced.count;
    if (!comparer_) return;
    const std::size_t before = comparer_->flips().size();
    comparer_->add(vessel, grips, own, full);
    for (std::size_t k = before; k < comparer_->flips().size(); ++k) count_flip(comparer_->flips()[k], own, full);
    const auto largest = [&](double& to, int field) { to = std::max(to, largest_difference(field, scene_, own, full, compared)); };
    largest(row_.gap, FIELD_GAP);
    largest(row_.separation, FIELD_SEPARATION);
    largest(row_.posed, FIELD_POSED);
    largest(row_.proxy, FIELD_PROXIES);
    largest(row_.torque, FIELD_TORQUE);
    largest(row_.torque, FIELD_EXACT_TORQUE);
    largest(row_.feedback, FIELD_FEEDBACK_FORCE);
    largest(row_.hold, FIELD_HOLD_FORCE);
    // those of the whole hand, as far as there are fields of them
    const auto named = [&](double& to, const char* variable) {
      if (const int field = field_of_variable(variable); field >= 0) largest(to, field);
    };
    named(row_.table_depth, "table_depth");
    named(row_.self_depth, "self_depth");
    named(row_.effort, "worst_effort");
    named(row_.push, "push");
    named(row_.friction_needed, "friction_needed");
  }

  // Liquid over fills and tilts; `vessel_by` is what the backend knows of the empty vessel.
  void add_liquid(std::size_t vessel, const std::vector<LiquidResult>& own, const std::vector<LiquidResult>& full,
                  const VesselConstants& vessel_by) {
    if (comparer_) comparer_->add_liquid(vessel, own, full);
    const VesselConstants truth = truth_.constants(vessel);
    for (std::size_t s = 0; s < own.size(); ++s) {
      for (const double value : {own[s].volume, own[s].mass, own[s].lean, own[s].height, own[s].poured}) {
        if (std::isfinite(value)) continue;
        if (row_.misplaced++ == 0) row_.first_misplaced = fmt::format("liquid of state {} is {}", s, value);
      }
      row_.volume = std::max(row_.volume, std::abs(own[s].volume - full[s].volume));
      const auto a = loaded_center(vessel_by, own[s]), b = loaded_center(truth, full[s]);
      row_.center_of_mass = std::max(row_.center_of_mass, std::hypot(a[0] - b[0], a[1] - b[1]));
    }
  }

  ExtremeRow finished() {
    if (comparer_) {
      row_.holds = comparer_->holds();
      row_.comparisons = comparer_->rows();
    }
    return row_;
  }

 private:
  void count(std::uint32_t status) {
    const std::uint32_t reason = status & STATUS_REASON_MASK;
    ++row_.grips;
    ++row_.reasons[reason];
    if (reason != REASON_NONE) return;
    ++row_.feasible;
    const std::uint32_t fingers = (1u << FINGERS) - 1;
    row_.implausible += (status & STATUS_PLAUSIBLE) == 0 ? 1 : 0;
    row_.grazing += (status & STATUS_GRAZING) != 0 ? 1 : 0;
    row_.blocked += ((status >> STATUS_BLOCKED_SHIFT) & fingers) != 0 ? 1 : 0;
    row_.unsettled_fingers += ((status >> STATUS_UNSETTLED_SHIFT) & fingers) != 0 ? 1 : 0;
    row_.unsettled_proxies += (status & STATUS_PROXY_UNSETTLED) != 0 ? 1 : 0;
  }

  void count_flip(const Flip& flip, const GatheredPlanes& own, const GatheredPlanes& full) {
    const std::uint64_t outside = flip.inside ? 0 : 1;
    if (is_feasible(own.uint(FIELD_STATUS, flip.grip)) != is_feasible(full.uint(FIELD_STATUS, flip.grip))) {
      ++row_.feasible_flips;
      row_.feasible_flips_outside += outside;
    } else if (own.uint(FIELD_TOUCH_MASK, flip.grip) != full.uint(FIELD_TOUCH_MASK, flip.grip)) {
      ++row_.touch_flips;
      row_.touch_flips_outside += outside;
    }
  }

  const Scene& scene_;
  const Evaluator& truth_;
  std::optional<Comparer> comparer_;
  ExtremeRow row_;
};

}  // namespace

ExtremeCase extreme_case(const Scene& scene) {
  std::string name = scene.file.substr(scene.file.rfind('/') + 1);
  if (name.ends_with(".toml")) name.resize(name.size() - 5);
  return {name, line_after(scene, "# Hard: "), line_after(scene, "# Comes out: "), scene};
}

std::vector<ExtremeRow> evaluate_extreme(const ExtremeCase& extreme, const ExtremeOptions& options) {
  const Scene& scene = extreme.scene;
  const FieldSet fields = all_fields(scene);
  const sweeps::Plan plan(scene, true);
  const std::shared_ptr<const Evaluator> full = make_core_evaluator(scene), single = make_core_float_evaluator(scene);
  std::vector<std::vector<GripInput>> grips;
  std::vector<GatheredPlanes> truth;
  std::vector<std::vector<LiquidResult>> true_liquid;
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    grips.push_back(spread_grips(plan, v, options.grips));
    truth.push_back(gather(*full, fields, v, grips[v]));
    true_liquid.push_back(core_liquid(scene, *full, v));
  }
  std::vector<ExtremeRow> rows;
  for (const auto& [core, precision] : {std::pair{full, Precision::full}, {single, Precision::single}}) {
    const BackendInfo info = core_info(precision, 1);
    ExtremeTally tally(extreme, *full, info, precision == Precision::full);
    for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
      tally.count_steps(*core, v, grips[v]);
      tally.add(v, grips[v], gather(*core, fields, v, grips[v]), truth[v]);
      tally.add_liquid(v, core_liquid(scene, *core, v), true_liquid[v], core->constants(v));
    }
    rows.push_back(tally.finished());
  }
  if (options.on == "core") return rows;
  host::GripBackendOptions device;
  device.device = options.device;
  for (const Precision precision : {Precision::single, Precision::full}) {
    device.precision = precision;
    host::GripBackend backend(scene, full, fields, options.on, device);
    ExtremeTally tally(extreme, *full, backend.info(), false);
    for (std::size_t v = 0; v < scene.vessels.size(); ++v) tally.add(v, grips[v], gather(backend, v, grips[v]), truth[v]);
    rows.push_back(tally.finished());
    rows.back().volume = rows.back().center_of_mass = std::numeric_limits<double>::quiet_NaN();  // the core's: nothing to compare
    if (!backend.device().float64) break;
  }
  return rows;
}

std::string extreme_csv(const std::vector<ExtremeRow>& rows) {
  std::string text =
      "case,backend,precision,grips,feasible,degenerate,not_converged,misses,too_wide,too_narrow,on_mouth,implausible,grazing,"
      "blocked,"
      "unsettled_fingers,unsettled_proxies,trace_steps,advance_steps,gap_um,separation_um,posed_um,proxy_um,volume_ml,com_um,"
      "torque_Nm,"
      "feedback_N,hold_N,table_depth_um,self_depth_um,worst_effort,push_N,friction_needed,touch_flips,touch_flips_outside,feasible_"
      "flips,feasible_flips_outside,misplaced,holds,device,driver\n";
  for (const ExtremeRow& row : rows) {
    text += fmt::format("{},{},{},{},{}", row.name, row.backend, row.precision == Precision::single ? "float" : "double", row.grips,
                        row.feasible);
    for (std::size_t k = 1; k < row.reasons.size(); ++k) text += fmt::format(",{}", row.reasons[k]);
    for (const std::uint64_t number : {row.implausible, row.grazing, row.blocked, row.unsettled_fingers, row.unsettled_proxies})
      text += fmt::format(",{}", number);
    for (const int steps : {row.trace_steps, row.advance_steps}) text += steps < 0 ? "," : fmt::format(",{}", steps);
    for (const double difference : {row.gap * 1e6, row.separation * 1e6, row.posed * 1e6, row.proxy * 1e6, row.volume * 1e6,
                                    row.center_of_mass * 1e6, row.torque, row.feedback, row.hold, row.table_depth * 1e6,
                                    row.self_depth * 1e6, row.effort, row.push, row.friction_needed})
      text += std::isnan(difference) ? "," : fmt::format(",{:.4g}", difference);
    for (const std::uint64_t number :
         {row.touch_flips, row.touch_flips_outside, row.feasible_flips, row.feasible_flips_outside, row.misplaced})
      text += fmt::format(",{}", number);
    text += fmt::format(",{},{},{}\n", row.holds ? "yes" : "no", csv_text(row.device), csv_text(row.driver));
  }
  return text;
}

}  // namespace wholehand
