// SPDX-License-Identifier: MIT
#include "evidence/trials/grip_trial.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/joints.h"
#include "core/load.h"
#include "core/mirror.h"
#include "core/prepare.h"
#include "core/vectors.h"
#include "evidence/trials/squeeze.h"
#include "sweeps/grips/report.h"

namespace wholehand {
namespace {

using core_f64::Vec3;

constexpr int LOOK_STEPS = 5;    // between two checks of where the vessel is
constexpr int WEIGH_STEPS = 20;  // between two changes of its mass while it pours

double number_or(double number, double otherwise) { return std::isnan(number) ? otherwise : number; }

GripResult result_of(const Evaluator& evaluator, std::size_t vessel, const GripInput& grip) {
  GripResult result;
  evaluator.grip(vessel, grip, result);
  return result;
}

PosedHand mirrored_hand(PosedHand hand, Handedness handedness) {
  for (Triple& joint : hand) joint = mirrored(joint, handedness);
  return hand;
}

GraspContacts grasp_contacts(const Scene& scene, const Evaluator& evaluator, std::size_t vessel, const GripResult& result) {
  GraspContacts contacts;
  for (const GripContact& found : evaluator.contacts(vessel, result)) {
    const auto mirror = [&](const Triple& v) { return to_vec3(mirrored(v, scene.hand.handedness)); };
    contacts.points.push_back({mirror(found.point), mirror(found.normal), found.digit, found.is_tip});
    contacts.joints.push_back(found.joint);
    contacts.between.push_back(found.between);
  }
  contacts.strength = core_f64::load_strength(scene, result);
  return contacts;
}

// Radius of the sphere of the hand that presses, m.
std::vector<double> contact_radii(const HandData& data, const GraspContacts& contacts, double scale) {
  std::vector<double> radii;
  for (std::size_t i = 0; i < contacts.points.size(); ++i) {
    const int finger = finger_of(contacts.joints[i]), k = contacts.joints[i] - finger_start(finger);
    const auto& all = data.fingers[static_cast<std::size_t>(finger)].radii;
    const double outer = all[static_cast<std::size_t>(k)];
    const double share = static_cast<double>(contacts.between[i]) / (data.between + 1);
    const double radius = contacts.between[i] == 0 ? outer : all[static_cast<std::size_t>(k) - 1] * (1 - share) + outer * share;
    radii.push_back(scale * radius);
  }
  return radii;
}

// The right hand's scene differs from a left hand's in what is not symmetric.
RigidLoad mirrored_load(RigidLoad load, Handedness handedness) {
  if (handedness == Handedness::right) return load;
  load.center = mirrored(load.center, handedness);
  for (const std::size_t k : {1u, 2u, 3u, 6u}) load.inertia[k] = -load.inertia[k];
  return load;
}

}  // namespace

BodyForm trial_form(const Scene& scene, std::size_t vessel) {
  const VesselData& data = scene.vessels.at(vessel);
  VesselForm form = vessel_form(data, std::filesystem::path(scene.file).parent_path().string());
  for (ConvexPiece& piece : form.pieces)
    for (Triple& p : piece.vertices) p = mirrored(p, scene.hand.handedness);
  BodyForm body = body_form(form.pieces);
  body.error = form.error;
  if (data.mesh) body.text = form_text(form);
  return body;
}

GripTrial::GripTrial(const MujocoLibrary& library, const Scene& scene, const Evaluator& evaluator, const TrialSettings& settings,
                     std::size_t vessel, const BodyForm& form, const GripInput& grip, int most_contacts)
    : scene_(scene),
      settings_(settings),
      friction_(number_or(settings.friction, scene.force.friction)),
      torsion_(scene.force.torsion),
      result_(result_of(evaluator, vessel, grip)),
      vessel_load_(scene, evaluator, vessel, sweeps::pour_direction(scene, grip)),
      is_articulated_(settings.model == TrialModel::hand) {
  const Handedness side = scene.hand.handedness;
  posed_ = mirrored_hand(result_.posed, side);
  pour_ = mirrored(sweeps::pour_direction(scene, grip), side);
  contacts_ = grasp_contacts(scene, evaluator, vessel, result_);
  contacts_.strength.friction = friction_;
  contacts_.strength.torsion = torsion_;
  const PreparedHand hand = prepare_hand(scene.hand);
  const double scale = scene.hand.scale * grip.hand_scale;
  HeldSetup setup;
  setup.form = form;
  setup.grasp = is_articulated_ ? articulated_hand(hand, scene.hand, mirrored_hand(result_.joints, side), posed_, scale, contacts_)
                                : sliding_contacts(contact_radii(scene.hand, contacts_, scale), contacts_);
  setup.distance = [&evaluator, vessel, side, error = form.error](const Vec3& p) {
    return evaluator.distance(vessel, mirrored(to_triple(p), side)) - error;
  };
  setup.friction = friction_;
  setup.torsion = torsion_;
  setup.load = mirrored_load(vessel_load_.at(0, 0, settings.mass), side);
  setup.most_contacts = most_contacts;
  grasp_ = setup.grasp;
  try {
    body_.emplace(library, setup);
  } catch (const EngineError& error) {
    last_error_ = error.what();
  }
}

HeldBody& GripTrial::body() {
  if (!body_) throw EngineError(last_error_);
  return *body_;
}

Vec3 GripTrial::up_at(double tilt) const { return core_f64::up_direction(to_vec3(pour_), std::sin(tilt), std::cos(tilt)); }

std::vector<double> GripTrial::drives_for(const RigidLoad& load, const Vec3& force, double friction, double torsion) const {
  core_f64::HandStrength strength = contacts_.strength;
  strength.friction = friction;
  strength.torsion = torsion;
  const core_f64::Wrench wrench = core_f64::wrench_at(to_vec3(load.center), force);
  return grasp_.drives(squeeze_forces(contacts_.points, strength, wrench, settings_.squeeze).forces);
}

GripTrial::State GripTrial::state_at(double fill, double tilt) const {
  State state;
  state.load = mirrored_load(vessel_load_.at(fill, tilt, settings_.mass), scene_.hand.handedness);
  state.force = -state.load.mass * scene_.gravity * up_at(tilt);
  state.drives = drives_for(state.load, state.force, friction_, torsion_);
  return state;
}

void GripTrial::act(const State& state) {
  body_->set_load(state.load);
  body_->push(state.force);
  body_->drive(state.drives);
}

void GripTrial::act_between(const State& a, const State& b, double share, double tilt, bool with_load) {
  const RigidLoad load = load_between(a.load, b.load, share);
  if (with_load) body_->set_load(load);
  body_->push(-load.mass * scene_.gravity * up_at(tilt));
  std::vector<double> drives(a.drives.size());
  for (std::size_t j = 0; j < drives.size(); ++j) drives[j] = a.drives[j] + share * (b.drives[j] - a.drives[j]);
  body_->drive(drives);
}

TrialReason GripTrial::close(const State& state) {
  body().reset();
  act(state);
  body_->simulation().forward();
  if (body_->deepest_overlap() > settings_.start_overlap) return TrialReason::overlap;
  const int steps = static_cast<int>(std::lround((CLOSE_TIME + STILL_TIME) / TIME_STEP));
  std::vector<double> drives = state.drives;
  for (int k = 0; k < steps; ++k) {
    const double share = std::min(1.0, (k + 1) * TIME_STEP / CLOSE_TIME);
    for (std::size_t j = 0; j < drives.size(); ++j) drives[j] = share * state.drives[j];
    body_->drive(drives);
    body_->step();
  }
  if (body_->deepest_overlap() > settings_.buried) return TrialReason::buried;
  body_->set_rest_pose();
  body_->anchor();
  body_->release();
  watched_ = to_vec3(state.load.center);
  steps_ = 0;
  return TrialReason::none;
}

bool GripTrial::look(double tilt, TrialOutcome& outcome) {
  outcome.slip = std::max(outcome.slip, body_->slipped());
  outcome.move = std::max(outcome.move, glm::distance(body_->moved(watched_), watched_));
  outcome.turn = std::max(outcome.turn, body_->turned());
  if (outcome.move < settings_.largest_move && outcome.turn < settings_.largest_turn) return true;
  outcome.reason = outcome.turn >= settings_.largest_turn ? TrialReason::turned : TrialReason::moved;
  outcome.when = body_->time();
  outcome.tilt_lost = tilt;
  return false;
}

void GripTrial::keep_frame(double tilt, TrialTrack* track) {
  if (!track) return;
  const long every = std::max(1l, std::lround(track->interval / TIME_STEP));
  if (steps_ % every != 0) return;
  const Handedness side = scene_.hand.handedness;
  TrialFrame frame;
  frame.time = body_->time();
  frame.place = mirrored(to_triple(body_->place()), side);
  frame.rotation = body_->quaternion();
  if (side == Handedness::left)  // mirrored in x: turns about y and z change their sign
    for (const std::size_t k : {2u, 3u}) frame.rotation[k] = -frame.rotation[k];
  frame.up = mirrored(to_triple(up_at(tilt)), side);
  frame.joints = is_articulated_ ? mirrored_hand(moved_joints(posed_, body_->bones()), side) : result_.posed;
  track->frames.push_back(frame);
}

bool GripTrial::watch(double duration, double tilt, TrialOutcome& outcome, TrialTrack* track) {
  const long steps = std::lround(duration / TIME_STEP);
  for (long k = 0; k < steps; ++k) {
    body_->step();
    keep_frame(tilt, track);
    ++steps_;
    if (steps_ % LOOK_STEPS == 0 && !look(tilt, outcome)) return false;
  }
  return look(tilt, outcome);
}

// From a tilt to the next, load and forces at every whole STATE_STEP between them and at both ends: what comes later changes
// nothing.
bool GripTrial::turn(double fill, State& state, double from, double to, TrialOutcome& outcome, TrialTrack* track) {
  const bool pours = scene_.liquid && fill > 0;
  double at = from;
  while (at < to) {
    const double next = std::min(to, STATE_STEP * (std::floor(at / STATE_STEP + 1e-9) + 1));
    const State ahead = state_at(fill, next);
    const long steps = std::max(1l, std::lround((next - at) / settings_.tilt_rate / TIME_STEP));
    for (long k = 0; k < steps; ++k) {
      const double share = static_cast<double>(k + 1) / static_cast<double>(steps), tilt = at + share * (next - at);
      act_between(state, ahead, share, tilt, pours && (k % WEIGH_STEPS == 0 || k + 1 == steps));
      if (!watch(TIME_STEP, tilt, outcome, track)) return false;
    }
    state = ahead;
    at = next;
  }
  return true;
}

std::vector<TrialOutcome> GripTrial::tilt(double fill, const std::vector<double>& tilts, TrialTrack* track,
                                          std::vector<std::size_t>* ends) {
  std::vector<TrialOutcome> outcomes;
  TrialOutcome outcome;
  if (ends) ends->clear();
  try {
    State state = state_at(fill, 0);
    outcome.reason = close(state);
    outcome.discarded = outcome.reason != TrialReason::none;
    bool is_held = !outcome.discarded;
    if (is_held && !watch(SETTLE_TIME, 0, outcome, track)) {
      is_held = false;
      outcome.reason = TrialReason::release;
    }
    double at = 0;
    for (const double wanted : tilts) {
      is_held = is_held && turn(fill, state, at, wanted, outcome, track) && watch(settings_.hold_time, wanted, outcome, track);
      at = wanted;
      outcome.held = is_held;
      outcomes.push_back(outcome);
      if (ends) ends->push_back(track ? track->frames.size() : 0);
      if (!is_held && !outcome.discarded) outcome.reason = TrialReason::earlier;
    }
  } catch (const EngineError& error) {
    // the tilts that were held before stay held
    outcome.held = false;
    outcome.discarded = true;
    outcome.reason = TrialReason::diverged;
    outcome.detail = error.what();
    outcomes.resize(tilts.size(), outcome);
    if (ends) ends->resize(tilts.size(), track ? track->frames.size() : 0);
  }
  return outcomes;
}

TrialOutcome GripTrial::push(double fill, int direction, const TrialMaterial& material, TrialTrack* track) {
  TrialOutcome outcome;
  try {
    const double friction = number_or(material.friction, friction_), torsion = number_or(material.torsion, torsion_);
    State state;
    state.load = mirrored_load(vessel_load_.at(fill, 0, number_or(material.mass, settings_.mass)), scene_.hand.handedness);
    Triple along{};
    along[static_cast<std::size_t>(direction / 2)] = direction % 2 == 0 ? 1 : -1;
    state.force = state.load.mass * settings_.push_acceleration * to_vec3(mirrored(along, scene_.hand.handedness));
    state.drives = drives_for(state.load, state.force, friction, torsion);
    body().set_friction(friction, torsion);
    outcome.reason = close(state);
    outcome.discarded = outcome.reason != TrialReason::none;
    outcome.held = !outcome.discarded && watch(settings_.push_time, 0, outcome, track);
  } catch (const EngineError& error) {
    outcome = {};
    outcome.discarded = true;
    outcome.reason = TrialReason::diverged;
    outcome.detail = error.what();
  }
  if (body_) body_->set_friction(friction_, torsion_);
  return outcome;
}

}  // namespace wholehand
