// SPDX-License-Identifier: MIT
// The facade of core/evaluator.h at this precision.
#include "core/evaluator.h"

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/contacts.h"
#include "core/counted_tilts.h"
#include "core/grip.h"
#include "core/grip_effort.h"
#include "core/load.h"
#include "core/mesh_body.h"
#include "core/mirror.h"
#include "core/prepare.h"
#include "core/remaining.h"
#include "core/scene_states.h"
#include "core/score.h"
#include "core/touch.h"
#include "core/trig.h"
#include "core/vectors.h"
#include "shaders/status.h"

namespace CORE_NS {

using wholehand::FieldSet;
using wholehand::FillTerms;
using wholehand::GripInput;
using wholehand::GripResult;
using wholehand::GripScore;
using wholehand::Handedness;
using wholehand::LiquidResult;
using wholehand::Scene;
using wholehand::StateResult;
using wholehand::to_triple;
using wholehand::to_vec3;
using wholehand::Triple;

namespace {

constexpr double NOT_A_NUMBER = std::numeric_limits<double>::quiet_NaN();

Grip to_grip(const GripInput& g) {
  return {Real(g.height), Real(g.azimuth), Real(g.obliquity), Real(g.roll), Real(g.offset), Real(g.hand_scale)};
}

Limits limits_of(const wholehand::EvaluatorOptions& options) {
  Limits limits;
  if (options.stop_tolerance > 0) limits.stop_tolerance = Real(options.stop_tolerance);
  if (options.trace_steps > 0) limits.trace_steps = options.trace_steps;
  if (options.advance_steps > 0) limits.advance_steps = options.advance_steps;
  if (options.gap_table > 0) limits.gap_steps = 0;
  return limits;
}

bool is_antipodal(const GripAnswer& answer) { return (answer.status & STATUS_ANTIPODAL) != 0; }
// From here on, gap and midpoint exist.
bool has_closed(const Closing& closing) { return closing.reason == REASON_NONE || closing.reason >= REASON_TOO_WIDE; }

// One grip's place in the planes.
struct PlaneRow {
  const FieldSet& fields;
  std::size_t stride;
  double* reals;
  std::uint32_t* uints;

  void clear() const {
    for (int p = 0; p < fields.real_planes; ++p) reals[p * stride] = NOT_A_NUMBER;
    for (int p = 0; p < fields.uint_planes; ++p) uints[p * stride] = 0;
  }
  void put(int field, int k, Real value) const {
    if (fields.has(field)) reals[(fields.plane[field] + k) * stride] = static_cast<double>(value);
  }
  void put_mask(int field, std::uint32_t value) const {
    if (fields.has(field)) uints[fields.plane[field] * stride] = value;
  }
};

class CoreEvaluator final : public wholehand::Evaluator {
 public:
  CoreEvaluator(const Scene& scene, const wholehand::EvaluatorOptions& options)
      : scene_(scene),
        hand_(
            load_hand(wholehand::prepare_hand(scene.hand, options.gap_table > 0 ? options.gap_table : GAP_TABLE_SIZE), scene.hand)),
        quadrature_(load_quadrature(wholehand::prepare_quadrature(options.quadrature_points))),
        states_(scene_) {
    hand_.limits = limits_of(options);
    if (options.effort_tolerance > 0) effort_tolerance_ = Real(options.effort_tolerance);
    const bool with_liquid = scene.liquid.has_value();
    for (const auto& data : scene.vessels) {
      VesselEntry entry;
      const wholehand::PreparedVessel prepared = wholehand::prepare_vessel(data, data.has_cavity());
      entry.vessel = load_vessel(prepared, data, quadrature_, with_liquid, scene.hand.handedness);
      if (data.mesh) {
        entry.lattice = mirror_(data.mesh->body->lattice);
      } else if (options.lattice_samples > 0) {
        entry.lattice = wholehand::prepare_lattice(prepared, options.lattice_samples, options.lattice_bits == 16,
                                                   wholehand::lattice_margin(scene));
      }
      if (entry.lattice) use_lattice(entry.vessel, load_lattice(*entry.lattice));
      entry.vessel.limits = hand_.limits;
      entry.vessel.on_table = scene.table.has_value();
      if (scene.table) entry.vessel.table_top = Real(wholehand::table_top(scene, data));
      entry.vessel.arm = load_arm(scene, data);
      entry.force = load_force(scene, data);
      entries_.push_back(std::move(entry));
      fill_states(entries_.size() - 1);
    }
  }

  void grip(std::size_t v, const GripInput& input, GripResult& result) const override {
    GripAnswer answer;
    evaluate(v, input, Wanted{true, true}, answer);
    const Closing& closing = answer.closing;
    result = GripResult{};
    result.status = answer.status;
    result.trace_steps = closing.steps;
    result.advance_steps = answer.advance_steps;
    result.reason = static_cast<wholehand::Reason>(closing.reason);
    if (has_closed(closing)) {
      result.gap = closing.gap;
      result.midpoint = mirror_.out(closing.midpoint);
    }
    if (closing.reason != REASON_NONE) return;
    result.plausible = wholehand::is_plausible(answer.status);
    result.antipodal = is_antipodal(answer);
    result.grazing = closing.grazing;
    result.contact_angles = {static_cast<double>(closing.thumb_angle), static_cast<double>(closing.index_angle)};
    result.closure = closing.closure;
    for (int j = 0; j < JOINTS; ++j) {
      result.joints[j] = mirror_.out(answer.joints[j]);
      result.posed[j] = mirror_.out(answer.posed[j]);
      result.proxies[j] = mirror_.out(answer.proxies[j]);
      result.separation[j] = answer.separation[j];
    }
    result.touch_mask = answer.touch_mask;
    result.tip_mask = answer.tip_mask;
    result.finger_mask = answer.finger_mask;
    result.inner_mask = answer.inner_mask;
    result.used_mask = answer.used_mask;
    result.phalanx_depth = answer.phalanx_depth;
    result.palm_depth = answer.palm_depth;
    result.bone_stretch = answer.bone_stretch;
    result.through_table = (answer.status & STATUS_THROUGH_TABLE) != 0;
    if (scene_.table) result.table_depth = answer.table_depth;
    result.beyond_wrist = (answer.status & STATUS_BEYOND_WRIST) != 0;
    if (scene_.arm) {
      result.wrist_share = answer.wrist.share;
      result.wrist_angles = {static_cast<double>(answer.wrist.flexion), static_cast<double>(answer.wrist.deviation),
                             static_cast<double>(answer.wrist.pronation)};
    }
    result.self_overlap = (answer.status & STATUS_SELF_OVERLAP) != 0;
    if (hand_.between > 0) result.self_depth = answer.self_depth;
  }

  LiquidResult liquid(std::size_t v, double fill, double tilt) const override {
    const Vessel& vessel = entries_[v].vessel;
    LiquidResult result;
    result.height = vessel.floor_height;
    if (vessel.lip_capacity.empty()) return result;
    const Real s = sine(Real(tilt)), c = cosine(Real(tilt));
    const Real filled = Real(fill) * vessel.capacity;
    const LiquidState state = liquid_at(vessel, quadrature_, remaining_volume(vessel, quadrature_, filled, tilt, s, c), s, c);
    result.volume = state.volume;
    result.mass = state.volume * Real(scene_.liquid->density);
    result.lean = state.lean;
    result.height = state.height;
    result.poured = filled - state.volume;
    return result;
  }

  StateResult state(std::size_t v, const GripInput& input, const GripResult& result, const LiquidResult& liquid, double tilt,
                    double opening) const override {
    const VesselEntry& entry = entries_[v];
    const Load load = load_of(entry, liquid);
    const TiltAngle angle{sine(Real(tilt)), cosine(Real(tilt))};
    const HeldForces forces = states_.forces(entry, pinch_of(input, result), load, angle, Real(opening));
    StateResult state;
    state.mass = load.mass;
    state.center_of_mass = mirror_.out(forces.center);
    state.pivot_length = forces.pivot_length;
    state.torque = forces.torque;
    state.exact_torque = forces.exact_torque;
    state.normal_force = forces.normal;
    state.feedback_force = forces.feedback;
    state.hold_force = has_effort_ ? tips_hold(entry, input, result, load, angle) : forces.hold;
    return state;
  }

  GripScore score(std::size_t v, const GripInput& input, const GripResult& result) const override {
    GripScore score;
    const VesselEntry& entry = entries_[v];
    if (result.reason != wholehand::Reason::none) return score;
    const Pinch pinch = pinch_of(input, result);
    LargestForces largest;
    std::vector<FillEffort> fill_efforts(states_.fills());
    if (has_effort_ && result.plausible) {
      const HeldHand hand = held_hand(entry, posed_of(result), result.touch_mask, Real(result.gap));
      largest.effort = effort_over_states(hand, true, states_.loads(entry, pinch), fill_efforts).worst;
    }
    for (std::size_t fill = 0; fill < states_.fills(); ++fill) {
      const FillEffort* effort = largest.effort ? &fill_efforts[fill] : nullptr;
      score.fills.push_back(states_.fill_terms(entry, fill, pinch, effort, [](std::size_t, const HeldForces&) {}));
      largest.add(score.fills.back());
    }
    if (has_effort_ && !largest.effort) largest.effort = std::numeric_limits<Real>::infinity();
    const ScoredHand hand{result.used_mask,           result.touch_mask,
                          Real(result.phalanx_depth), Real(result.palm_depth),
                          Real(result.closure),       scene_.arm ? std::optional(Real(result.wrist_share)) : std::nullopt};
    const auto terms = states_.score_terms(hand, largest, entry.force.max);
    score.terms = {terms[0], terms[1], terms[2], terms[3], terms[4], terms[5]};
    score.not_held = is_not_held(result.plausible, largest);
    score.score = result.plausible && !score.not_held ? states_.weighted(terms) : 0;
    return score;
  }

  std::vector<wholehand::GripContact> contacts(std::size_t v, const GripResult& result) const override {
    std::array<PressingJoint, JOINTS> pressing;
    const std::array<Vec3, JOINTS> posed = posed_of(result);
    const int count = find_contacts(hand_, entries_[v].vessel, posed, placed_scale(hand_, posed), result.touch_mask, pressing);
    std::vector<wholehand::GripContact> contacts;
    for (int i = 0; i < count; ++i) {
      const ContactPoint& contact = pressing[i].contact;
      contacts.push_back({pressing[i].joint, pressing[i].between, contact.digit, contact.is_tip, mirror_.out(contact.place),
                          mirror_.out(contact.normal)});
    }
    return contacts;
  }

  std::optional<wholehand::PosedHand> posed(std::size_t v, const GripInput& grip) const override {
    GripAnswer answer;
    evaluate(v, grip, {false, false}, answer);
    if (answer.closing.reason != REASON_NONE) return std::nullopt;
    wholehand::PosedHand hand;
    for (int j = 0; j < JOINTS; ++j) hand[j] = mirror_.out(answer.posed[j]);
    return hand;
  }

  void planes(std::size_t v, const GripInput* grips, std::size_t count, const FieldSet& fields, std::size_t stride, double* reals,
              std::uint32_t* uints, double least_score) const override {
    const Wanted wanted{fields.has(FIELD_JOINTS), fields.has(FIELD_PROXIES) || fields.has(FIELD_BONE_STRETCH)};
    GripAnswer answer;
    std::vector<FillEffort> fill_efforts(states_.fills());
    for (std::size_t i = 0; i < count; ++i) {
      const PlaneRow row{fields, stride, reals + i, uints + i};
      row.clear();
      evaluate(v, grips[i], wanted, answer);
      put_closing(row, answer);
      if (answer.closing.reason != REASON_NONE) continue;
      put_pose(row, answer);
      if (least_score > 0 && has_effort_ && wholehand::is_plausible(answer.status)) {
        LargestForces largest = put_states(row, entries_[v], answer, nullptr);
        largest.effort = Real(0);
        if (double(states_.weighted(score_terms(entries_[v], answer, largest))) < least_score) answer.status |= STATUS_UNJUDGED;
      }
      const std::optional<Real> effort = put_efforts(row, entries_[v], answer, fill_efforts);
      LargestForces largest = put_states(row, entries_[v], answer, effort ? fill_efforts.data() : nullptr);
      if (has_effort_) largest.effort = effort.value_or(std::numeric_limits<Real>::infinity());
      put_score(row, entries_[v], answer, largest);
    }
  }

  double distance(std::size_t v, const Triple& point) const override {
    return signed_distance(entries_[v].vessel, mirror_.in<Real>(point));
  }

  Triple gradient(std::size_t v, const Triple& point) const override {
    int element = -1;
    const Vec3 gradient = distance_gradient(entries_[v].vessel, mirror_.in<Real>(point), element);
    return mirror_.out(gradient);
  }

  wholehand::VesselConstants constants(std::size_t v) const override {
    const VesselEntry& entry = entries_[v];
    wholehand::VesselConstants result;
    result.capacity = entry.vessel.capacity;
    result.mass = entry.vessel.mass;
    result.center_of_mass = mirror_.out(entry.vessel.center_of_mass);
    result.torque_reference = entry.force.reference;
    result.largest_mass = entry.largest.mass;
    result.largest_share = entry.largest_share;
    result.largest_height = entry.largest.height;
    return result;
  }

  double pouring_tilt(std::size_t v, double fill) const override {
    const Vessel& vessel = entries_[v].vessel;
    const Real volume = Real(fill) * vessel.capacity;
    if (vessel.lip_capacity.empty() || !(volume > 0)) return NOT_A_NUMBER;
    int degree = 1;
    while (degree < WHOLE_DEGREES - 1 && vessel.lip_capacity[degree] >= volume) ++degree;
    double low = wholehand::radians(degree - 1), high = wholehand::radians(degree);
    while (high - low > 1e-12) {
      const double middle = 0.5 * (low + high);
      const bool holds = lip_capacity(vessel, quadrature_, sine(Real(middle)), cosine(Real(middle))) >= volume;
      (holds ? low : high) = middle;
    }
    return high;
  }

  double gap_at(double closure) const override { return hand_.scale * CORE_NS::gap_at(hand_, Real(closure)); }

  const wholehand::PreparedLattice* lattice(std::size_t v) const override {
    return entries_[v].lattice ? &*entries_[v].lattice : nullptr;
  }

  std::size_t table_bytes() const override {
    std::size_t bytes = sizeof hand_ + hand_.gap_table.size() * sizeof(Real) + 2 * quadrature_.count * sizeof(Real);
    for (const VesselEntry& entry : entries_) {
      bytes += entry.vessel.cavity.size() * sizeof(Element) + entry.vessel.lip_capacity.size() * sizeof(Real) +
               entry.loads.size() * sizeof(Load);
      bytes += entry.lattice ? entry.lattice->words->size() * sizeof(std::uint32_t) : entry.vessel.outline.size() * sizeof(Element);
    }
    return bytes;
  }

 private:
  void evaluate(std::size_t v, const GripInput& input, Wanted wanted, GripAnswer& answer) const {
    evaluate_grip(hand_, entries_[v].vessel, static_cast<PoseKind>(static_cast<int>(scene_.pose)), to_grip(mirror_(input)),
                  Real(scene_.force.friction), wanted, answer);
  }

  void put_points(const PlaneRow& row, int field, const Vec3* points, int count) const {
    if (!row.fields.has(field)) return;
    for (int j = 0; j < count; ++j) {
      const Triple p = mirror_.out(points[j]);
      for (int k = 0; k < 3; ++k) row.reals[(row.fields.plane[field] + 3 * j + k) * row.stride] = p[k];
    }
  }

  // What every grip has, feasible or not.
  void put_closing(const PlaneRow& row, const GripAnswer& answer) const {
    const Closing& closing = answer.closing;
    row.put_mask(FIELD_STATUS, answer.status);
    row.put(FIELD_SCORE, 0, 0);
    for (int k = 0; k < 6; ++k) row.put(FIELD_TERMS, k, 0);
    if (!has_closed(closing)) return;
    row.put(FIELD_T_INDEX, 0, closing.t_index);
    row.put(FIELD_T_THUMB, 0, closing.t_thumb);
    row.put(FIELD_GAP, 0, closing.gap);
    put_points(row, FIELD_MIDPOINT, &closing.midpoint, 1);
  }

  void put_pose(const PlaneRow& row, const GripAnswer& answer) const {
    const Closing& closing = answer.closing;
    row.put(FIELD_CLOSURE, 0, closing.closure);
    row.put(FIELD_CONTACT_ANGLES, 0, closing.thumb_angle);
    row.put(FIELD_CONTACT_ANGLES, 1, closing.index_angle);
    row.put(FIELD_PHALANX_DEPTH, 0, answer.phalanx_depth);
    row.put(FIELD_PALM_DEPTH, 0, answer.palm_depth);
    row.put(FIELD_BONE_STRETCH, 0, answer.bone_stretch);
    row.put(FIELD_TABLE_DEPTH, 0, answer.table_depth);
    row.put(FIELD_SELF_DEPTH, 0, answer.self_depth);
    row.put(FIELD_WRIST_SHARE, 0, answer.wrist.share);
    put_points(row, FIELD_JOINTS, answer.joints.data(), JOINTS);
    put_points(row, FIELD_POSED, answer.posed.data(), JOINTS);
    put_points(row, FIELD_PROXIES, answer.proxies.data(), JOINTS);
    for (int j = 0; j < JOINTS; ++j) row.put(FIELD_SEPARATION, j, answer.separation[j]);
    row.put_mask(FIELD_TOUCH_MASK, answer.touch_mask);
    row.put_mask(FIELD_TIP_MASK, answer.tip_mask);
    row.put_mask(FIELD_FINGER_MASK, answer.finger_mask);
    row.put_mask(FIELD_INNER_MASK, answer.inner_mask);
    row.put_mask(FIELD_USED_MASK, answer.used_mask);
  }

  // Contacts of a posed hand: all of it, and the tips of thumb and index finger alone.
  struct HeldHand {
    std::array<ContactPoint, JOINTS> contacts;
    std::array<ContactPoint, 2> tips;
    std::size_t count = 0, tip_count = 0;
    HandStrength strength;
    std::span<const ContactPoint> all() const { return {contacts.data(), count}; }
    std::span<const ContactPoint> pinch() const { return {tips.data(), tip_count}; }
  };

  std::array<Vec3, JOINTS> posed_of(const GripResult& result) const {
    std::array<Vec3, JOINTS> posed;
    for (std::size_t j = 0; j < JOINTS; ++j) posed[j] = mirror_.in<Real>(result.posed[j]);
    return posed;
  }

  HeldHand held_hand(const VesselEntry& entry, const std::array<Vec3, JOINTS>& posed, std::uint32_t touch_mask, Real gap) const {
    HeldHand hand;
    const Real scale = placed_scale(hand_, posed);
    std::array<PressingJoint, JOINTS> pressing;
    hand.count = static_cast<std::size_t>(find_contacts(hand_, entry.vessel, posed, scale, touch_mask, pressing));
    for (std::size_t i = 0; i < hand.count; ++i) {
      hand.contacts[i] = pressing[i].contact;
      if (pressing[i].contact.is_tip) hand.tips[hand.tip_count++] = pressing[i].contact;
    }
    hand.strength = load_strength(scene_, gap, scale);
    return hand;
  }

  GripEffort effort_over_states(const HeldHand& hand, bool of_tips, const GripLoads& loads, std::span<FillEffort> fills) const {
    return grip_effort(hand.all(), of_tips ? std::optional(hand.pinch()) : std::nullopt, hand.strength, loads, fills,
                       effort_tolerance_);
  }

  // The efforts of a plausible grip: the worst one, and `fills`. Nothing for any other grip, or in a scene without efforts.
  std::optional<Real> put_efforts(const PlaneRow& row, const VesselEntry& entry, const GripAnswer& answer,
                                  std::span<FillEffort> fills) const {
    if (!has_effort_ || !wholehand::is_judged(answer.status)) return std::nullopt;
    const HeldHand hand = held_hand(entry, answer.posed, answer.touch_mask, answer.closing.gap);
    const bool of_tips = row.fields.has(FIELD_TIPS_WORST_EFFORT) || row.fields.has(FIELD_LARGEST_HOLD);
    const GripLoads loads = states_.loads(entry, {answer.closing.direction, answer.closing.midpoint, is_antipodal(answer)});
    const GripEffort found = effort_over_states(hand, of_tips, loads, fills);
    const bool wet = scene_.liquid.has_value();
    const auto v = static_cast<std::size_t>(&entry - entries_.data());
    row.put(FIELD_WORST_EFFORT, 0, found.worst);
    row.put(FIELD_WORST_EFFORT_FILL, 0, wet ? Real(wholehand::vessel_fills(scene_, scene_.vessels[v])[found.fill]) : Real(0));
    row.put(FIELD_WORST_EFFORT_TILT, 0, Real(scene_.tilts[found.tilt]));
    row.put(FIELD_TIPS_WORST_EFFORT, 0, found.tips_worst);
    if (row.fields.has(FIELD_PUSH)) {
      const Wrench weight = loads.weight(entry.largest, {});
      const Vec3 at = load_center(entry.largest, loads.pour);
      row.put(FIELD_PUSH, 0, push_held(hand.all(), hand.strength, weight, at, effort_tolerance_));
    }
    if (row.fields.has(FIELD_FRICTION_NEEDED))
      row.put(FIELD_FRICTION_NEEDED, 0, friction_needed(hand.all(), hand.strength, loads, found, effort_tolerance_));
    put_state_efforts(row, hand, loads);
    return found.worst;
  }

  // State by state, on request.
  void put_state_efforts(const PlaneRow& row, const HeldHand& hand, const GripLoads& loads) const {
    const bool of_all = row.fields.has(FIELD_EFFORT) || row.fields.has(FIELD_EFFORT_LOW);
    const bool of_tips = row.fields.has(FIELD_TIPS_EFFORT) || row.fields.has(FIELD_HOLD_FORCE);
    if (!of_all && !of_tips) return;
    const Vec3 center = contacts_center(hand.all());
    EffortSolver whole(hand.all(), hand.strength, center), tips(hand.pinch(), hand.strength, center);
    for (std::size_t fill = 0; fill < states_.fills(); ++fill)
      for (std::size_t tilt = 0; tilt < loads.counted[fill]; ++tilt) {
        const int state = static_cast<int>(fill * states_.tilts() + tilt);
        const Wrench weight = loads.weight(fill, tilt);
        if (of_all) {
          const Effort found = whole.solve(weight, effort_tolerance_);
          row.put(FIELD_EFFORT, state, found.effort);
          row.put(FIELD_EFFORT_LOW, state, found.low);
        }
        if (!of_tips) continue;
        const Real effort = tips.solve(weight, effort_tolerance_).effort;
        row.put(FIELD_TIPS_EFFORT, state, effort);
        row.put(FIELD_HOLD_FORCE, state, effort * hand.strength.weaker_tip());
      }
  }

  // What each tip must press in a state of a feasible grip.
  Real tips_hold(const VesselEntry& entry, const GripInput& input, const GripResult& result, const Load& load,
                 TiltAngle tilt) const {
    const HeldHand hand = held_hand(entry, posed_of(result), result.touch_mask, Real(result.gap));
    const GripLoads loads = states_.loads(entry, pinch_of(input, result));
    EffortSolver tips(hand.pinch(), hand.strength, contacts_center(hand.pinch()));
    return tips.solve(loads.weight(load, tilt), effort_tolerance_).effort * hand.strength.weaker_tip();
  }

  LargestForces put_states(const PlaneRow& row, const VesselEntry& entry, const GripAnswer& answer,
                           const FillEffort* efforts) const {
    LargestForces largest;
    const Pinch pinch{answer.closing.direction, answer.closing.midpoint, is_antipodal(answer)};
    for (std::size_t fill = 0; fill < states_.fills(); ++fill) {
      const int k = static_cast<int>(fill);
      const auto put_state = [&](std::size_t tilt, const HeldForces& s) {
        const int state = static_cast<int>(fill * states_.tilts() + tilt);
        row.put(FIELD_PIVOT_LENGTH, state, s.pivot_length);
        row.put(FIELD_TORQUE, state, s.torque);
        row.put(FIELD_EXACT_TORQUE, state, s.exact_torque);
        row.put(FIELD_NORMAL_FORCE, state, s.normal);
        row.put(FIELD_FEEDBACK_FORCE, state, s.feedback);
        if (!has_effort_) row.put(FIELD_HOLD_FORCE, state, s.hold);
      };
      const FillTerms terms = states_.fill_terms(entry, fill, pinch, efforts ? efforts + fill : nullptr, put_state);
      row.put(FIELD_PEAK_FORCE, k, Real(terms.peak_force));
      row.put(FIELD_PEAK_TILT, k, Real(terms.peak_tilt));
      row.put(FIELD_LARGEST_HOLD, k, Real(terms.largest_hold));
      row.put(FIELD_SAFE_TILT, k, Real(terms.safe_tilt));
      largest.add(terms);
    }
    return largest;
  }

  std::array<Real, 6> score_terms(const VesselEntry& entry, const GripAnswer& answer, const LargestForces& largest) const {
    const ScoredHand hand{answer.used_mask,  answer.touch_mask,      answer.phalanx_depth,
                          answer.palm_depth, answer.closing.closure, scene_.arm ? std::optional(answer.wrist.share) : std::nullopt};
    return states_.score_terms(hand, largest, entry.force.max);
  }

  void put_score(const PlaneRow& row, const VesselEntry& entry, const GripAnswer& answer, const LargestForces& largest) const {
    const auto terms = score_terms(entry, answer, largest);
    for (int k = 0; k < 6; ++k) row.put(FIELD_TERMS, k, terms[k]);
    const std::uint32_t status = answer.status | (is_not_held(wholehand::is_judged(answer.status), largest) ? STATUS_NOT_HELD : 0u);
    row.put_mask(FIELD_STATUS, status);
    row.put(FIELD_SCORE, 0, wholehand::is_eligible(status) ? states_.weighted(terms) : Real(0));
  }

  // False in a scene without efforts and for an unjudged grip, where it is unknown.
  static bool is_not_held(bool is_judged, const LargestForces& largest) {
    return is_judged && largest.effort && !effort_holds(*largest.effort);
  }

  // How this result's grip holds its vessel, in the world of the right hand.
  Pinch pinch_of(const GripInput& input, const GripResult& result) const {
    const GripInput grip = mirror_(input);
    return {grip_direction(Real(grip.azimuth), Real(grip.obliquity)), mirror_.in<Real>(result.midpoint), result.antipodal};
  }

  static Load load_of(const VesselEntry& entry, const LiquidResult& liquid) {
    return load_with(entry.vessel, Real(liquid.mass), Real(liquid.lean), Real(liquid.height));
  }

  // Liquid and load of every state, which states count, and the torque's reference: upright at the largest fill.
  void fill_states(std::size_t v) {
    VesselEntry& entry = entries_[v];
    const bool wet = scene_.liquid.has_value();
    const std::size_t fills = wholehand::scene_fills(scene_);
    for (std::size_t f = 0; f < fills; ++f)
      for (const double tilt : scene_.tilts) {
        const LiquidResult state = wet ? liquid(v, wholehand::vessel_fills(scene_, scene_.vessels[v])[f], tilt) : LiquidResult{};
        entry.loads.push_back(load_of(entry, state));
      }
    entry.counted_tilts = wholehand::counted_tilts(scene_, v);
    const LiquidResult most = wet ? liquid(v, wholehand::vessel_fills(scene_, scene_.vessels[v]).back(), 0) : LiquidResult{};
    entry.largest = load_of(entry, most);
    entry.largest_share = entry.largest.mass > 0 ? Real(most.mass) / entry.largest.mass : Real(0);
    entry.force.reference =
        object_reference(entry.largest, entry.force.gravity, Real(scene_.vessels[v].base), Real(scene_.vessels[v].height));
  }

  Scene scene_;
  wholehand::Mirror mirror_{scene_.hand.handedness};
  Hand hand_;
  Quadrature quadrature_;
  SceneStates states_;
  Real effort_tolerance_ = EFFORT_TOLERANCE;
  bool has_effort_ = wholehand::has_effort(scene_);
  std::vector<VesselEntry> entries_;
};

}  // namespace

std::unique_ptr<wholehand::Evaluator> make_evaluator(const Scene& scene, const wholehand::EvaluatorOptions& options) {
  return std::make_unique<CoreEvaluator>(scene, options);
}

}  // namespace CORE_NS
