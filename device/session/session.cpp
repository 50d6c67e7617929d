// SPDX-License-Identifier: MIT
#include "device/session/session.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/quaternion.hpp>

#include "core/closure.h"
#include "core/liquid.h"
#include "core/mesh_body.h"
#include "core/trig.h"
#include "core/vectors.h"

namespace wholehand::device {

using core_f64::Mat3;
using core_f64::Vec3;

namespace {

constexpr double THINNEST_SOLID = 1e-3;  // m: a hull has no wall, and what it has that is thinner is no way in

std::array<double, 2> gap_of(const core_f64::Hand& hand) { return {hand.scale * hand.gap_closed, hand.scale * hand.gap_open}; }

std::vector<double> volumes_of(const LiveScene& live) {
  std::vector<double> volumes;
  for (const LiveVessel& vessel : live.vessels) volumes.push_back(vessel.volume);
  return volumes;
}

}  // namespace

Session::Session(const Scene& scene, std::array<double, 2> device_gap)
    : live_(std::make_unique<const LiveScene>(scene)),
      workspace_(scene, device_gap, gap_of(live_->hand)),
      pouring_(volumes_of(*live_), scene.task, scene.gravity, scene.live.rate),
      vessels_(live_->scene),
      period_(1 / scene.live.rate),
      radii_{live_->hand.scale * live_->hand.radius[0][3], live_->hand.scale * live_->hand.radius[1][4]} {
  for (const LiveVessel& vessel : live_->vessels) obstacles_.standing[obstacles_.count++] = {&vessel.vessel, vessel.home, false};
  obstacles_.thinnest = THINNEST_SOLID;
  for (const VesselData& data : live_->scene.vessels) {
    if (data.surface == Surface::shell) obstacles_.thinnest = std::min(obstacles_.thinnest, data.wall);
    if (data.mesh)
      obstacles_.thinnest = std::min(obstacles_.thinnest, data.mesh->body->lattice.spacing);  // thinner walls it does not hold
  }
}

// A tick: where the hand is; then what holds, comes back or is touched; then the forces.
void Session::step(const GripperState& state, std::int64_t number, Tick& tick) noexcept {
  const core_f64::Hand& hand = live_->hand;
  seconds_ = period_ * static_cast<double>(number_ < 0 ? 1 : std::max<std::int64_t>(1, number - number_));
  const HandPose pose = workspace_.map(state);
  const double closure = core_f64::closure_of_gap(hand, pose.gap / hand.scale, hand.limits.stop_tolerance / hand.scale);
  const Vec3 half = 0.5 * pose.gap * pose.rotation[0];
  tips_ = {pose.middle - half, pose.middle + half};
  if (number_ < 0) {
    tips_before_ = tips_;
    for (int k = 0; k < 2; ++k) proxies_[k].place = tips_[k];
  }
  tick = Tick{};
  tick.number = number;
  fill_hand(pose, closure, tick);
  pouring_.land(number);
  if (is_held(state_)) {
    hold(pose, state.gap, seconds_, tick);
  } else {
    if (is_returning(state_)) come_back(tick);
    settle_vessels();
    approach(pose, tick);
    if (!is_returning(state_) && grasp(pose, state.gap, tick)) hold(pose, state.gap, 0, tick);
  }
  tick.state = state_;
  tick.vessel = vessel_;
  for (int v = 0; v < obstacles_.count; ++v) {
    tick.volume[v] = pouring_.volume(v);
    tick.arrived[v] = pouring_.arrived(v);
    tick.spilled[v] = pouring_.spilled(v);
  }
  const int done = tasks_done();
  tick.guidance = live_->scene.task ? done : -1;
  tick.task_done =
      live_->scene.task && done == static_cast<int>(live_->scene.task->amounts.size()) + (live_->tutorial >= 0 ? 1 : 0);
  tick.grasps = grasps_;
  tick.lost = lost_;
  tick.destinations = destinations_;
  vessels_.follow(tick);
  tips_before_ = tips_;
  number_ = number;
}

// A vessel is felt once both tips and their proxies have left it: at the start, and after it was held.
void Session::settle_vessels() noexcept {
  for (int v = 0; v < obstacles_.count; ++v) {
    auto& standing = obstacles_.standing[v];
    if (!standing.is_solid && !(is_returning(state_) && v == vessel_)) standing.is_solid = is_left(standing);
  }
}

bool Session::is_left(const Obstacles::Standing& standing) const noexcept {
  bool left = true;
  for (int k = 0; k < 2; ++k) {
    left = left && vessel_separation(standing, tips_[k], radii_[k]) > 0 &&
           vessel_separation(standing, proxies_[k].place, radii_[k]) > 0;
  }
  return left;
}

// Before the grasp: the coupling of both tips to their proxies.
void Session::approach(const HandPose& pose, Tick& tick) noexcept {
  const LiveData& live = live_->scene.live;
  const double friction = live_->scene.force.friction;
  if (!is_returning(state_)) {
    state_ = SessionState::free;
    vessel_ = -1;
  }
  std::array<Vec3, 2> forces{};
  for (int k = 0; k < 2; ++k) {
    proxies_[k] = carry_proxy(obstacles_, proxies_[k], tips_[k], radii_[k], friction);
    const Proxy& proxy = proxies_[k];
    const NearestVessel nearest = nearest_vessel(obstacles_, tips_[k], radii_[k]);
    const bool touches = proxy.vessel >= 0 || nearest.separation <= live_->hand.contact_tolerance;
    if (touches && !is_returning(state_)) {
      state_ = SessionState::touching;
      vessel_ = proxy.vessel >= 0 ? proxy.vessel : nearest.vessel;
      fill_vessel({obstacles_.standing[vessel_].place, Mat3(1)}, tick);
    }
    if (proxy.vessel >= 0 && !workspace_.is_clutched()) {
      const Vec3 velocity = (tips_[k] - tips_before_[k]) / seconds_;
      forces[k] = core_f64::coupling_force(tips_[k], proxy.place, proxy.normal, velocity, live.stiffness, live.damping);
    }
    tick.coupling[k] = live_->mirror.out(forces[k]);
    tick.proxies[k] = live_->mirror.out(proxy.place);
  }
  tick.wanted.arm = workspace_.to_device(forces[0] + forces[1]);
  // what moves both tips apart by one meter of gap moves each by half of it
  const Vec3 apart = 0.5 * (forces[1] - forces[0]);
  tick.wanted.grip = glm::dot(apart, pose.rotation[0]);
  tick.wanted.across = workspace_.across_to_device(apart - tick.wanted.grip * pose.rotation[0]);
  tick.feedback = tick.wanted.grip;
  tick.user_force = tick.feedback;
}

// Both tips on the same vessel, one from each side, neither on its lid, at a possible gap: held from now on.
bool Session::grasp(const HandPose& pose, double device_gap, Tick& tick) noexcept {
  const std::optional<Touch> touch = touch_of_both_tips();
  if (!touch) return false;
  const std::optional<core_f64::Closing> closing = close_on(*touch, pose);
  if (!closing) return false;
  core_f64::GripAnswer answer;
  core_f64::rest_hand(live_->hand, live_->vessels[touch->vessel].vessel,
                      static_cast<core_f64::PoseKind>(static_cast<int>(live_->scene.pose)), *closing, live_->scene.force.friction,
                      {false, false}, answer);
  vessel_ = touch->vessel;
  keep_grasp(*touch, pose, answer);
  grasp_.device_gap = device_gap;
  obstacles_.standing[vessel_].is_solid = false;
  state_ = SessionState::lift;
  is_turning_ = false;
  rest_ = SessionState::lift;
  rested_at_ = turn_from_ = turn_time_ = 0;
  ++grasps_;
  tick.coupling = {};
  return true;
}

std::optional<Session::Touch> Session::touch_of_both_tips() const noexcept {
  Touch touch;
  for (int k = 0; k < 2; ++k) {
    // a tip that is pressed through a thin wall still touches what its proxy rests on
    const NearestVessel nearest = nearest_vessel(obstacles_, tips_[k], radii_[k]);
    const bool is_near = nearest.vessel >= 0 && nearest.separation <= live_->hand.contact_tolerance;
    const int touched = proxies_[k].vessel >= 0 ? proxies_[k].vessel : is_near ? nearest.vessel : -1;
    if (touched < 0) return std::nullopt;
    const auto& standing = obstacles_.standing[touched];
    int element = -1;
    touch.normals[k] = core_f64::distance_gradient(*standing.vessel, proxies_[k].place - standing.place, element);
    if (standing.vessel->lid >= 0 && element == standing.vessel->lid) return std::nullopt;
    if (k > 0 && touched != touch.vessel) return std::nullopt;
    touch.vessel = touched;
  }
  return touch;
}

// The hand closed on the proxies: none if it cannot, or if they lie on one side of the vessel.
std::optional<core_f64::Closing> Session::close_on(const Touch& touch, const HandPose& pose) const noexcept {
  const core_f64::Hand& hand = live_->hand;
  const Vec3 apart = proxies_[1].place - proxies_[0].place;
  const double gap = glm::length(apart);
  // an open hand holds nothing, because it could not let go
  const double widest = hand.scale * hand.gap_open - 2 * hand.contact_tolerance,
               narrowest = std::max(hand.scale * hand.gap_closed, radii_[0] + radii_[1]);
  if (!(gap > narrowest && gap <= widest)) return std::nullopt;
  const Vec3 direction = apart / gap;
  const double thumb = glm::dot(touch.normals[0], -direction), index = glm::dot(touch.normals[1], direction);
  if (!(thumb > GRAZING_COSINE && index > GRAZING_COSINE)) return std::nullopt;
  double e1_x = 0;
  core_f64::Closing closing =
      close_live_hand(hand, {proxies_[0].place, proxies_[1].place}, obstacles_.standing[touch.vessel].place, pose.rotation, e1_x);
  closing.thumb_angle = core_f64::angle_between(touch.normals[0], -direction);
  closing.index_angle = core_f64::angle_between(touch.normals[1], direction);
  if (std::abs(e1_x) > LARGEST_E1_X) return std::nullopt;
  return closing;
}

void Session::keep_grasp(const Touch& touch, const HandPose& pose, const core_f64::GripAnswer& answer) noexcept {
  const LiveVessel& live = live_->vessels[touch.vessel];
  const Vec3 place = obstacles_.standing[touch.vessel].place;
  grasp_ = Grasp{};
  grasp_.is_antipodal = (answer.status & STATUS_ANTIPODAL) != 0;
  grasp_.midpoint = answer.closing.midpoint;
  grasp_.direction = answer.closing.direction;
  grasp_.touch_mask = answer.touch_mask;
  grasp_.used_mask = answer.used_mask;
  grasp_.height = grasp_.midpoint.y;
  for (int k = 0; k < 2; ++k) grasp_.proxies[k] = proxies_[k].place - place;
  grasp_.turn = glm::transpose(pose.rotation);
  grasp_.offset = grasp_.turn * (place - pose.middle);
  begin_slide(answer);
  if (live_->scene.task && !live.guidance.empty()) {
    const Vec3 shown = live.guidance[tasks_done() % live.guidance.size()];
    grasp_.guidance_distance = std::min(glm::length(grasp_.proxies[0] - radii_[0] * touch.normals[0] - shown),
                                        glm::length(grasp_.proxies[1] - radii_[1] * touch.normals[1] - shown));
  }
}

// In the hand: the vessel goes with it, its liquid runs, and the gripper feels kernel 7.
void Session::hold(const HandPose& pose, double device_gap, double seconds, Tick& tick) noexcept {
  const LiveVessel& live = live_->vessels[vessel_];
  // the vessel keeps the place and the turn that it had in the gripper's axes at the grasp
  const Stance vessel{pose.middle + pose.rotation * grasp_.offset, pose.rotation * grasp_.turn};
  const Leaning leaning = leaning_of(vessel);
  tick.tilt = std::atan2(leaning.sine, leaning.cosine);
  // what runs out in this tick no longer weighs
  const core_f64::Load load = run_liquid(vessel, leaning, seconds, tick);
  // the opening since the grasp counts in the device's own gap
  const core_f64::HeldForces held =
      core_f64::held_forces(live.force, load, live.largest, grasp_.direction, grasp_.midpoint, leaning.lean, leaning.sine,
                            leaning.cosine, grasp_.is_antipodal, grasp_.device_gap - device_gap);
  if (seconds == 0) grasp_.normal = held.normal;  // the moment of grasp
  // lift, tilt or maintain, and whether the tutorial's vessel has arrived
  state_ = turning(tick.tilt);
  note_delivery(vessel.place);
  fill_held(vessel, load.mass, held, tick);
  const bool keeps_contact = !live_->scene.live.slide || slide(pose, lifted_share(vessel), load, held, seconds, tick);
  tick.wanted.across = workspace_.across_to_device(carried_across(pose, held.center, workspace_.to_world(tick.wanted.arm)));
  // an open hand lets go in this very tick: nothing of the vessel is felt any more
  if (is_open(device_gap) || !keeps_contact) leave(vessel);
  if (is_returning(state_)) {
    tick.wanted = {};
    tick.feedback = tick.user_force = 0;
    tick.weight = 0;
    tick.safety_margin = Tick::NONE;
    tick.slip_speed = 0;
  }
}

Session::Leaning Session::leaning_of(const Stance& vessel) const noexcept {
  const Vec3 up = glm::transpose(vessel.rotation) * Vec3(0, 1, 0);
  const double sine = std::sqrt(up.x * up.x + up.z * up.z), cosine = up.y;
  const bool is_upright = sine < core_f64::UPRIGHT_SINE;
  const double off_axis = std::hypot(grasp_.direction.x, grasp_.direction.z);
  const double sense = live_->scene.liquid && live_->scene.liquid->pour == Pour::towards ? -1 : 1;
  const Vec3 across = off_axis > DEGENERATE_SINE_F64 ? core_f64::pour_direction(grasp_.direction, sense) : Vec3(1, 0, 0);
  return {is_upright ? across : Vec3(-up.x / sine, 0, -up.z / sine), sine, cosine};
}

// Pours out what runs over; returns the weight of the vessel with the rest.
core_f64::Load Session::run_liquid(const Stance& vessel, const Leaning& leaning, double seconds, Tick& tick) noexcept {
  const LiveVessel& live = live_->vessels[vessel_];
  const auto& [lean, sine, cosine] = leaning;
  core_f64::LiquidState liquid;
  liquid.height = live.vessel.floor_height;
  double density = 0;
  if (pouring_.volume(vessel_) > 0) {
    density = live_->scene.liquid->density;
    const double held_back = core_f64::lip_capacity(live.vessel, live_->quadrature, sine, cosine);
    const Vec3 lip = vessel.outward(live.vessel.mouth_radius * lean + Vec3(0, live.vessel.mouth_height, 0));
    tick.flow = pouring_.pour(vessel_, held_back, live_->mirror(lip), tick.number, seconds);
    liquid = core_f64::liquid_at(live.vessel, live_->quadrature, std::min(pouring_.volume(vessel_), held_back), sine, cosine);
  }
  return core_f64::load_with(live.vessel, density * pouring_.volume(vessel_), liquid.lean, liquid.height);
}

// Only with a task.
bool Session::is_at_destination(Vec3 place) const noexcept {
  return glm::length(place - live_->mirror.in(live_->scene.task->destination)) <= DESTINATION_RADIUS;
}

// The tutorial's vessel at its destination, once.
void Session::note_delivery(Vec3 place) noexcept {
  if (vessel_ == live_->tutorial && !is_tutored_ && is_at_destination(place)) {
    grasp_.is_delivered = true;
    is_tutored_ = true;
    ++destinations_;
  }
}

void Session::fill_held(const Stance& vessel, double mass, const core_f64::HeldForces& held, Tick& tick) const noexcept {
  tick.weight = mass * live_->vessels[vessel_].force.gravity * lifted_share(vessel);
  tick.torque = held.torque;
  tick.exact_torque = held.exact_torque;
  tick.normal_force = held.normal;
  tick.opening_force = held.opening;
  tick.feedback = held.feedback;
  tick.hold_force = held.hold;
  tick.user_force = held.feedback - (held.normal - grasp_.normal);
  tick.wanted.arm = workspace_.to_device(Vec3(0, -tick.weight, 0));
  tick.wanted.grip = held.feedback;
  tick.touch_mask = grasp_.touch_mask;
  tick.used_mask = grasp_.used_mask;
  tick.grasp_height = grasp_.height;
  tick.guidance_distance = grasp_.guidance_distance;
  for (int k = 0; k < 2; ++k) tick.proxies[k] = live_->mirror.out(vessel.outward(grasp_.proxies[k]));
  fill_vessel(vessel, tick);
}

// Half the difference of what the two contacts carry across the line of the tips: it balances the torque of what acts at the center about their middle,
// apart from the part along the line, which torsion carries.
Vec3 Session::carried_across(const HandPose& pose, Vec3 center, Vec3 carried) const noexcept {
  const Vec3 middle = 0.5 * (grasp_.proxies[0] + grasp_.proxies[1]);
  const Vec3 torque = glm::cross(pose.rotation * (grasp_.turn * (center - middle)), carried);
  return glm::cross(torque, pose.rotation[0]) / glm::length(grasp_.proxies[1] - grasp_.proxies[0]);
}

bool Session::is_open(double device_gap) const noexcept {
  const std::array<double, 2> range = workspace_.device_gap();
  // a vessel that the hand can hardly span gets half of the remaining gap, so that noise does not open the fingers
  const double open = std::max(range[1] - OPEN_MARGIN * (range[1] - range[0]), 0.5 * (grasp_.device_gap + range[1]));
  return device_gap - grasp_.device_gap > live_->scene.live.slip || (device_gap >= open && device_gap > grasp_.device_gap);
}

// lift, tilt or maintain: the vessel turns from when the tilt has changed by the step since it came to rest, until it has changed by less than a
// fifth of that within the window. The state at rest is decided then, so that a slow beginning belongs to the earlier state.
SessionState Session::turning(double tilt) noexcept {
  if (!is_turning_ && std::abs(tilt - rested_at_) >= TURN_STEP) {
    is_turning_ = true;
    turn_from_ = tilt;
    turn_time_ = 0;
  }
  turn_time_ += seconds_;
  if (is_turning_ && std::abs(tilt - turn_from_) >= TURN_REST) {
    turn_from_ = tilt;
    turn_time_ = 0;
  } else if (is_turning_ && turn_time_ >= TURN_WINDOW) {
    is_turning_ = false;
    rested_at_ = tilt;
    rest_ = tilt < TURN_STEP ? SessionState::lift : SessionState::maintain;
  }
  return is_turning_ ? SessionState::tilt : rest_;
}

// Put down where it stood or at its destination, or lost.
void Session::leave(const Stance& pose) noexcept {
  Vec3& home = obstacles_.standing[vessel_].place;
  state_ = SessionState::let_go;
  if (grasp_.is_delivered && is_at_destination(pose.place)) {
    home = live_->mirror.in(live_->scene.task->destination);
  } else if (glm::length(pose.place - home) > PUT_DOWN) {
    ++lost_;
    state_ = SessionState::slipped;
  }
  left_at_ = pose;
  left_for_ = 0;
  for (int k = 0; k < 2; ++k) proxies_[k] = {tips_[k], {}, -1, -1};
  // a holding hand passes through other vessels: those that it is in now are felt once it has left them
  for (int v = 0; v < obstacles_.count; ++v)
    obstacles_.standing[v].is_solid = obstacles_.standing[v].is_solid && is_left(obstacles_.standing[v]);
}

// Back to where it stood, upright; then it waits there until the fingers have left it.
void Session::come_back(Tick& tick) noexcept {
  left_for_ += seconds_;
  const double way = minimum_jerk(left_for_ / RETURN_TIME);
  const auto& standing = obstacles_.standing[vessel_];
  Stance pose;
  pose.place = glm::mix(left_at_.place, standing.place, way);
  if (way < 1) {
    const auto upright = glm::identity<glm::dquat>();
    pose.rotation = glm::mat3_cast(glm::slerp(glm::quat_cast(left_at_.rotation), upright, way));
  }
  fill_vessel(pose, tick);
  tick.tilt = std::acos(std::clamp(pose.rotation[1].y, -1.0, 1.0));
  if (way >= 1 && is_left(standing)) state_ = SessionState::free;
}

int Session::tasks_done() const noexcept {
  const Scene& scene = live_->scene;
  if (!scene.task) return 0;
  int done = is_tutored_ ? 1 : 0;
  for (const auto& [name, amount] : scene.task->amounts) {
    double arrived = 0;
    for (std::size_t v = 0; v < scene.vessels.size(); ++v)
      if (scene.vessels[v].liquid_name == name) arrived += pouring_.arrived(static_cast<int>(v));
    if (std::abs(arrived - amount) <= scene.task->tolerance) ++done;
  }
  return done;
}

void Session::fill_hand(const HandPose& pose, double closure, Tick& tick) const noexcept {
  tick.middle = live_->mirror.out(pose.middle);
  tick.hand_rotation = live_->mirror.out(pose.rotation);
  tick.gap = pose.gap;
  tick.closure = closure;
  for (int k = 0; k < 2; ++k) tick.tips[k] = live_->mirror.out(tips_[k]);
}

void Session::fill_vessel(const Stance& pose, Tick& tick) const noexcept {
  tick.vessel_place = live_->mirror.out(pose.place);
  tick.vessel_rotation = live_->mirror.out(pose.rotation);
}

}  // namespace wholehand::device
