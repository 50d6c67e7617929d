// SPDX-License-Identifier: MIT
#include "evidence/trials/grasp_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/joints.h"
#include "core/vectors.h"

namespace wholehand {
namespace {

using core_f64::ContactForce;
using core_f64::Vec3;

constexpr double FREE_TRAVEL = 0.05;    // m, of a slide
constexpr double SHORTEST_BONE = 1e-6;  // m: a shorter one is its balls

// How far a joint turns before bones and ligaments stop it, rad: fingers MCP, PIP, DIP; thumb abduction, MCP, IP (AAOS; the upper
// ends of the fingers are the scene's).
constexpr std::array<double, 3> LEAST_TURN{radians(-30), radians(-5), radians(-10)};
constexpr std::array<std::array<double, 2>, 3> THUMB_TURN{
    {{radians(-20), radians(90)}, {radians(-10), radians(60)}, {radians(-20), radians(80)}}};

int bones_of(int finger) { return finger_joints(finger) - 1; }

glm::dmat3 frame_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 x = glm::normalize(b - a), z = glm::normalize(glm::cross(b - a, c - a));
  return {x, glm::cross(z, x), z};
}

// From the hand frame to the vessel's, by the bases of index and little finger and the index's MCP, which no pose moves.
glm::dmat3 hand_turn(const PreparedHand& hand, const PosedHand& rigged) {
  const auto& index = hand.fingers[1];
  const Vec3 base = to_vec3(index.base), mcp = base + index.length[0] * to_vec3(index.forward);
  const auto place = [&](int joint) { return to_vec3(rigged[static_cast<std::size_t>(joint)]); };
  const int first = finger_start(1), little = finger_start(4);
  return frame_of(place(first), place(little), place(first + 1)) *
         glm::transpose(frame_of(base, to_vec3(hand.fingers[4].base), mcp));
}

std::string triple_text(const Vec3& v) { return fmt::format("{} {} {}", v.x, v.y, v.z); }

// The hinge at the inner end of a bone, and its drive.
struct Hinge {
  int finger = 0, bone = 0;
  Vec3 anchor{}, axis{};
};

class HandWriter {
 public:
  HandWriter(const PreparedHand& hand, const HandData& data, const PosedHand& rigged, const PosedHand& posed, double scale)
      : hand_(hand), data_(data), posed_(posed), scale_(scale), turn_(hand_turn(hand, rigged)) {}

  void write(GraspModel& model) {
    for (int finger = 0; finger < FINGER_COUNT; ++finger) {
      const Vec3 base = joint(finger, 0);
      write_bone(finger, 0, base, model);
      for (int bone = 0; bone < bones_of(finger); ++bone) model.bodies += "</body>\n";
    }
  }
  const std::vector<Hinge>& hinges() const { return hinges_; }
  Vec3 joint(int finger, int k) const { return to_vec3(posed_[static_cast<std::size_t>(finger_start(finger) + k)]); }
  // From a joint to its finger's tip along the bones.
  double way_to_tip(int finger, int k) const {
    double way = 0;
    for (; k < bones_of(finger); ++k) way += glm::distance(joint(finger, k), joint(finger, k + 1));
    return way;
  }

 private:
  // Opens the body of a bone, and those beyond it.
  void write_bone(int finger, int bone, const Vec3& parent, GraspModel& model) {
    const std::string name = fmt::format("{}{}", finger, bone);
    const Vec3 start = joint(finger, bone), along = joint(finger, bone + 1) - start;
    const Vec3 place = bone == 0 ? start : start - parent;
    model.bodies += fmt::format("<body name=\"bone{}\" pos=\"{}\">", name, triple_text(place));
    if (finger == 0 || bone > 0) write_hinge(finger, bone, model);
    const auto& radii = hand_.fingers[static_cast<std::size_t>(finger)].radius;
    const double inner = scale_ * radii[static_cast<std::size_t>(bone)], outer = scale_ * radii[static_cast<std::size_t>(bone) + 1];
    // a capsule alone touches a straight wall in one point, which jumps from one end to the other, so each end has its own ball
    const double radius = std::max(THINNEST, (inner + outer) / 2);
    model.roughness = std::max(model.roughness, std::abs(inner - outer));
    if (bone == 0) write_ball("base" + name, Vec3(0), inner, model);
    write_ball("ball" + name, along, outer, model);
    if (glm::length(along) > SHORTEST_BONE) {
      model.bodies += fmt::format("<geom name=\"skin{}\" type=\"capsule\" fromto=\"0 0 0 {}\" size=\"{}\"/>\n", name,
                                  triple_text(along), radius);
      model.geoms.push_back("skin" + name);
    }
    model.bones.push_back("bone" + name);
    if (bone + 1 < bones_of(finger)) write_bone(finger, bone + 1, start, model);
  }

  static void write_ball(const std::string& name, const Vec3& place, double radius, GraspModel& model) {
    model.bodies += fmt::format("<geom name=\"{}\" type=\"sphere\" pos=\"{}\" size=\"{}\"/>\n", name, triple_text(place),
                                std::max(THINNEST, radius));
    model.geoms.push_back(name);
  }

  // Angle of a segment in its finger's plane, rad.
  double segment_angle(int finger, int bone) const {
    const auto& plane = hand_.fingers[static_cast<std::size_t>(finger)];
    const Vec3 along = joint(finger, bone + 1) - joint(finger, bone);
    return std::atan2(glm::dot(along, turn_ * to_vec3(plane.palmward)), glm::dot(along, turn_ * to_vec3(plane.forward)));
  }

  // A hinge whose angle is 0 as posed and grows as the joint bends; the thumb's outer two reverse its abduction.
  void write_hinge(int finger, int bone, GraspModel& model) {
    const auto& plane = hand_.fingers[static_cast<std::size_t>(finger)];
    const double sense = finger == 0 && bone > 0 ? -1 : 1;
    const Vec3 axis = sense * glm::normalize(turn_ * glm::cross(to_vec3(plane.forward), to_vec3(plane.palmward)));
    const double before = bone > 0 ? segment_angle(finger, bone - 1) : 0;
    const double angle = sense * std::remainder(segment_angle(finger, bone) - before, 2 * PI);
    const auto k = static_cast<std::size_t>(finger == 0 ? bone : bone - 1);
    const double least = std::min(finger == 0 ? THUMB_TURN[k][0] : LEAST_TURN[k], angle);
    const double most = std::max(finger == 0 ? THUMB_TURN[k][1] : data_.joint_limit[k], angle);
    const double way = std::max(way_to_tip(finger, bone), 5e-3), square = way * way;
    model.bodies +=
        fmt::format("<joint type=\"hinge\" axis=\"{}\" limited=\"true\" range=\"{} {}\" damping=\"{}\" armature=\"{}\"/>",
                    triple_text(axis), least - angle, most - angle, JOINT_DAMPING * square, JOINT_INERTIA * square);
    const auto& radii = hand_.fingers[static_cast<std::size_t>(finger)].radius;
    const double thickest = std::max(THINNEST, scale_ * *std::max_element(radii.begin(), radii.end()));
    model.joints.push_back({finger, JOINT_STIFFNESS * square, 0, false, way_to_tip(finger, bone) + thickest});
    hinges_.push_back({finger, bone, joint(finger, bone), axis});
  }

  const PreparedHand& hand_;
  const HandData& data_;
  const PosedHand& posed_;
  double scale_;
  glm::dmat3 turn_;
  std::vector<Hinge> hinges_;
};

// The bone of a contact: the one that ends at its joint. A base has no bone that turns.
bool is_moved_by(const Hinge& hinge, int joint) {
  const int finger = finger_of(joint), bone = joint - finger_start(finger) - 1;
  return hinge.finger == finger && bone >= hinge.bone;
}

}  // namespace

std::vector<double> GraspModel::drives(std::span<const ContactForce> forces) const {
  std::vector<double> result(joints.size(), 0.0);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    for (std::size_t i = 0; i < contacts; ++i) {
      const Lever& lever = levers[j * contacts + i];
      result[j] += glm::dot(lever.force, forces[i].force) + lever.torsion * forces[i].torsion;
    }
  }
  return result;
}

// A bone that presses with f at q on the vessel, with a torsion tau about the normal n, loads its hinge at o with the axis a by a.((q - o) x f) + a.n
// tau = (a x (q - o)).f + a.n tau, which its joint must hold. A digit's strength limits its normal forces N; with friction |(f, tau / gamma)| reaches
// sqrt(1 + mu^2) N. A joint's largest torque is that of such a force of the full strength, at the digit's contact with the longest arm, or at the tip
// of a digit that touches nothing. So the joints can produce every force of kernel 10 within the strength.
GraspModel articulated_hand(const PreparedHand& hand, const HandData& data, const PosedHand& rigged, const PosedHand& posed,
                            double scale, const GraspContacts& contacts) {
  GraspModel model;
  HandWriter writer(hand, data, rigged, posed, scale);
  writer.write(model);
  model.contacts = contacts.points.size();
  model.levers.resize(model.joints.size() * model.contacts);
  const double whole = std::hypot(1.0, contacts.strength.friction);
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const Hinge& hinge = writer.hinges()[j];
    GraspJoint& joint = model.joints[j];
    for (std::size_t i = 0; i < model.contacts; ++i) {
      if (!is_moved_by(hinge, contacts.joints[i])) continue;
      const core_f64::ContactPoint& contact = contacts.points[i];
      const Vec3 lever = glm::cross(hinge.axis, contact.place - hinge.anchor);
      model.levers[j * model.contacts + i] = {lever, glm::dot(hinge.axis, contact.normal)};
      const double strength = contacts.strength.digits[static_cast<std::size_t>(contact.digit)];
      const double arm = std::hypot(glm::length(lever), contacts.strength.torsion * glm::dot(hinge.axis, contact.normal));
      joint.most = std::max(joint.most, whole * strength * arm);
    }
    if (joint.most == 0) {
      const double strength = contacts.strength.digits[static_cast<std::size_t>(hinge.finger)];
      joint.most = whole * strength * writer.way_to_tip(hinge.finger, hinge.bone);
    }
  }
  return model;
}

GraspModel sliding_contacts(std::span<const double> radii, const GraspContacts& contacts) {
  GraspModel model;
  model.contacts = contacts.points.size();
  model.levers.resize(model.contacts * model.contacts);
  for (std::size_t i = 0; i < model.contacts; ++i) {
    const core_f64::ContactPoint& contact = contacts.points[i];
    const double radius = std::max(THINNEST, radii[i]);
    model.bodies += fmt::format(
        "<body name=\"bone{0}\" pos=\"{1}\"><joint type=\"slide\" axis=\"{2}\" limited=\"true\" range=\"{3} {4}\" damping=\"{5}\" "
        "armature=\"{6}\"/><geom name=\"skin{0}\" type=\"sphere\" size=\"{7}\"/></body>\n",
        i, triple_text(contact.place - radius * contact.normal), triple_text(contact.normal), -FREE_TRAVEL, FREE_TRAVEL,
        JOINT_DAMPING / 3, JOINT_INERTIA / 3, radius);
    model.geoms.push_back(fmt::format("skin{}", i));
    const double strength = contacts.strength.digits[static_cast<std::size_t>(contact.digit)];
    model.joints.push_back({contact.digit, JOINT_STIFFNESS / 3, strength, true});
    model.levers[i * model.contacts + i] = {contact.normal, 0};
  }
  return model;
}

PosedHand moved_joints(const PosedHand& posed, std::span<const BonePlace> bones) {
  PosedHand moved = posed;
  std::size_t next = 0;
  for (int finger = 0; finger < FINGER_COUNT; ++finger) {
    for (int bone = 0; bone < bones_of(finger); ++bone) {
      const auto k = static_cast<std::size_t>(finger_start(finger) + bone);
      const BonePlace& body = bones[next++];
      moved[k] = body.place;
      const auto along = to_vec3(posed[k + 1]) - to_vec3(posed[k]);
      const auto& r = body.rotation;
      moved[k + 1] = to_triple(to_vec3(body.place) + Vec3(r[0] * along.x + r[1] * along.y + r[2] * along.z,
                                                          r[3] * along.x + r[4] * along.y + r[5] * along.z,
                                                          r[6] * along.x + r[7] * along.y + r[8] * along.z));
    }
  }
  return moved;
}

}  // namespace wholehand
