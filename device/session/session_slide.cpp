// SPDX-License-Identifier: MIT
// The part of a Session in which a held vessel slides.
#include <algorithm>
#include <cmath>

#include <glm/gtc/quaternion.hpp>

#include "core/grip.h"
#include "device/session/line_contacts.h"
#include "device/session/session.h"

namespace wholehand::device {

using core_f64::Mat3;
using core_f64::Vec2;
using core_f64::Vec3;

namespace {

// About the parallel to `axis` through the center of both: the wall as it is, the liquid as a point at its center, since it does not turn with the
// wall. Vessel frame.
double sliding_inertia(const LiveVessel& live, double mass, Vec3 center, Vec3 axis) {
  const core_f64::Vessel& glass = live.vessel;
  const double liquid = mass - glass.mass;
  Vec3 apart = center - glass.center_of_mass;
  apart -= glm::dot(apart, axis) * axis;
  double inertia = glm::dot(axis, live.inertia * axis) + glass.mass * glm::dot(apart, apart);
  if (liquid > 0) inertia += glass.mass * glass.mass / liquid * glm::dot(apart, apart);
  return std::max(inertia, LEAST_GYRATION * LEAST_GYRATION * mass);
}

// The whole hand's friction has the form of the tips', and the load reaches it where the grip is all that holding takes: `grip` is the share of that.
SlideFriction hand_friction(const SlidingBody& body, Vec2 load, double grip, double mu, double gamma) {
  const SlideFriction unit = slide_friction(1, 0, mu, gamma);
  const double share = friction_share(body, load, unit);
  return slide_friction(std::isfinite(share) ? std::max(0.0, grip) * share : 0, 0, mu, gamma);
}

}  // namespace

// Without strengths, as the two tips.
bool Session::slides_by_hand() const noexcept {
  const LiveData& live = live_->scene.live;
  return live.slide && live.slide_by == SlideBy::hand && live_->scene.strength;
}

void Session::begin_slide(const core_f64::GripAnswer& answer) noexcept {
  sliding_ = Sliding{};
  take_posed(answer);
  const Vec3 line = grasp_.turn * grasp_.direction;
  sliding_.u = glm::normalize(glm::cross(line, std::abs(line.y) < 0.7 ? Vec3(0, 1, 0) : Vec3(0, 0, 1)));
  sliding_.v = glm::cross(line, sliding_.u);
}

double Session::lifted_share(const Stance& vessel) const noexcept {
  return minimum_jerk((vessel.place.y - obstacles_.standing[vessel_].place.y) / FULL_WEIGHT);
}

// A table carries what is not lifted; so the same share of the weight loads the grip and the arm.
bool Session::slide(const HandPose& pose, double lifted, const core_f64::Load& load, const core_f64::HeldForces& held,
                    double seconds, Tick& tick) noexcept {
  const LiveVessel& live = live_->vessels[vessel_];
  const bool by_hand = slides_by_hand();
  const Vec3 falls = glm::transpose(pose.rotation * grasp_.turn) * Vec3(0, -load.mass * live.force.gravity, 0);
  const double hold = by_hand ? sliding_.hand.hold_force(held.center, falls) : held.hold;
  const double needed = lifted > 0 ? lifted * hold : 0;
  const double grip = still_grip(grasp_.normal, held.opening, live.force.max);
  tick.safety_margin = grip - needed;
  tick.slip_distance = sliding_.distance;
  tick.slip_angle = sliding_.angle;
  if (!(lifted > 0)) sliding_.motion = {};
  if (!(lifted > 0) || !(seconds > 0) || (sliding_.motion.is_rest() && tick.safety_margin >= 0)) return true;

  const Vec3 line = grasp_.turn * grasp_.direction, middle = grasp_.offset + grasp_.turn * grasp_.midpoint,
             center = grasp_.offset + grasp_.turn * held.center;
  const Vec3 weight = lifted * (grasp_.turn * falls);
  const auto across = [this](Vec3 x) { return Vec2(glm::dot(x, sliding_.u), glm::dot(x, sliding_.v)); };
  const SlidingBody body{load.mass, sliding_inertia(live, load.mass, held.center, grasp_.direction), across(center - middle)};
  const double mu = live.force.friction, gamma = live.force.torsion, along = glm::dot(weight, line);
  SlideFriction friction;
  if (by_hand)
    friction = hand_friction(body, across(weight), grip / needed, mu, gamma);
  else if (grasp_.is_antipodal)
    friction = slide_friction(grip, along, mu, gamma);
  const Vec2 before = sliding_.motion.velocity;
  const SlideStep step = slide_step(body, across(weight), friction, seconds, sliding_.motion);
  // the arm carries what friction carries: the weight less what accelerates the vessel
  const Vec2 gained = load.mass / seconds * (sliding_.motion.velocity - before);
  tick.wanted.arm = workspace_.to_device(pose.rotation * (weight - gained.x * sliding_.u - gained.y * sliding_.v));
  sliding_.distance += step.slipped;
  sliding_.angle += step.turned;
  tick.slip_speed = step.slipped / seconds;

  const Mat3 turned = glm::mat3_cast(glm::angleAxis(step.turned, line));
  grasp_.turn = turned * grasp_.turn;
  grasp_.offset = center + turned * (grasp_.offset - center) + step.moved.x * sliding_.u + step.moved.y * sliding_.v;
  return follow_line(line, middle);
}

// The tips keep their line in the gripper's axes; the vessel has moved under them.
bool Session::follow_line(Vec3 line, Vec3 middle) noexcept {
  const LiveVessel& live = live_->vessels[vessel_];
  std::array<double, 2> near{};
  for (std::size_t k = 0; k < 2; ++k) near[k] = glm::dot(grasp_.proxies[k] - grasp_.midpoint, grasp_.direction);
  grasp_.direction = glm::normalize(glm::transpose(grasp_.turn) * line);
  const Vec3 point = glm::transpose(grasp_.turn) * (middle - grasp_.offset);
  const auto contacts = line_contacts(live.vessel, point, grasp_.direction, near, radii_, live.force.friction);
  if (!contacts) return false;
  grasp_.proxies = contacts->places;
  grasp_.midpoint = 0.5 * (contacts->places[0] + contacts->places[1]);
  grasp_.is_antipodal = contacts->is_antipodal;
  if (sliding_.distance - sliding_.posed_distance >= POSE_SLIP || std::abs(sliding_.angle - sliding_.posed_angle) >= POSE_TURN)
    pose_again();
  return true;
}

// The other fingers come to rest on the vessel anew.
void Session::pose_again() noexcept {
  double e1_x = 0;
  const core_f64::Closing closing = close_live_hand(live_->hand, grasp_.proxies, Vec3(0), glm::transpose(grasp_.turn), e1_x);
  core_f64::GripAnswer answer;
  core_f64::rest_hand(live_->hand, live_->vessels[vessel_].vessel,
                      static_cast<core_f64::PoseKind>(static_cast<int>(live_->scene.pose)), closing, live_->scene.force.friction,
                      {false, false}, answer);
  grasp_.touch_mask = answer.touch_mask;
  grasp_.used_mask = answer.used_mask;
  take_posed(answer);
  sliding_.posed_distance = sliding_.distance;
  sliding_.posed_angle = sliding_.angle;
}

// The contacts of the hand that now rests on the vessel, with the tips at their proxies.
void Session::take_posed(const core_f64::GripAnswer& answer) noexcept {
  if (!slides_by_hand()) return;
  std::array<Vec3, JOINT_COUNT> posed = answer.posed;
  posed[THUMB_TIP] = grasp_.proxies[0];
  posed[INDEX_TIP] = grasp_.proxies[1];
  sliding_.hand.take(*live_, live_->vessels[vessel_].vessel, posed, answer.touch_mask);
}

}  // namespace wholehand::device
