// SPDX-License-Identifier: MIT
#include "evidence/trials/held_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace wholehand {
namespace {

using core_f64::Vec3;

// A contact closes within 5 ms and without ringing; it is soft over a tenth of a millimeter, below which a resting one would
// flicker.
const char* const CONTACT = "condim=\"4\" solref=\"0.005 1\" solimp=\"0.5 0.99 0.0001\"";

Vec3 column(const mjtNum* p) { return {p[0], p[1], p[2]}; }
// Products of a vector with a matrix by rows, and with its transpose.
Vec3 turned_by(const mjtNum* m, const Vec3& v) {
  return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[3] * v.x + m[4] * v.y + m[5] * v.z, m[6] * v.x + m[7] * v.y + m[8] * v.z};
}
Vec3 turned_back(const mjtNum* m, const Vec3& v) {
  return {m[0] * v.x + m[3] * v.y + m[6] * v.z, m[1] * v.x + m[4] * v.y + m[7] * v.z, m[2] * v.x + m[5] * v.y + m[8] * v.z};
}

// The largest distance along an axis of a point outside a box: at most its distance.
double box_distance(const std::array<Triple, 2>& box, const Vec3& p) {
  double outside = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    outside = std::max({outside, box[0][i] - p[axis], p[axis] - box[1][i]});
  }
  return outside;
}

std::string pair_text(const HeldSetup& setup, std::size_t hand, std::size_t body) {
  return fmt::format("<pair geom1=\"{}\" geom2=\"{}\" {} friction=\"{} {} {} 0.0001 0.0001\"/>\n", setup.grasp.geoms[hand],
                     setup.form.names[body], CONTACT, setup.friction, setup.friction, setup.friction * setup.torsion);
}

}  // namespace

BodyForm body_form(std::span<const ConvexPiece> pieces) {
  BodyForm form;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const ConvexPiece& piece = pieces[k];
    const std::string name = fmt::format("glass{}", k);
    const double r = piece.radius;
    if (piece.shape == PieceShape::cylinder) {
      form.geoms += fmt::format("<geom name=\"{}\" type=\"cylinder\" fromto=\"0 {} 0 0 {} 0\" size=\"{}\"/>\n", name, piece.low,
                                piece.high, r);
    } else if (piece.shape == PieceShape::ball) {
      form.geoms +=
          fmt::format("<geom name=\"{}\" type=\"sphere\" pos=\"0 {} 0\" size=\"{}\"/>\n", name, (piece.low + piece.high) / 2, r);
    } else {
      form.assets += fmt::format("<mesh name=\"piece{}\" vertex=\"", k);
      for (const Triple& p : piece.vertices) form.assets += fmt::format("{:.9g} {:.9g} {:.9g} ", p[0], p[1], p[2]);
      form.assets += "\"/>\n";
      form.geoms += fmt::format("<geom name=\"{}\" type=\"mesh\" mesh=\"piece{}\"/>\n", name, k);
    }
    form.names.push_back(name);
    std::array<Triple, 2> box{Triple{-r, piece.low, -r}, Triple{r, piece.high, r}};
    if (piece.shape == PieceShape::hull) box = {piece.vertices.front(), piece.vertices.front()};
    for (const Triple& p : piece.vertices) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        box[0][axis] = std::min(box[0][axis], p[axis]);
        box[1][axis] = std::max(box[1][axis], p[axis]);
      }
    }
    form.boxes.push_back(box);
  }
  return form;
}

std::string model_text(const HeldSetup& setup) {
  std::string pairs;
  if (setup.pairs.empty()) {
    for (std::size_t hand = 0; hand < setup.grasp.geoms.size(); ++hand)
      for (std::size_t body = 0; body < setup.form.names.size(); ++body) pairs += pair_text(setup, hand, body);
  }
  for (const auto& [hand, body] : setup.pairs) pairs += pair_text(setup, hand, body);
  // the body's mass is set later; a separate inertial frame keeps the engine from shortcuts that would then be wrong
  return fmt::format(
      "<mujoco><compiler angle=\"radian\"/><size njmax=\"{}\" nconmax=\"{}\" nstack=\"{}\"/>\n"
      "<option timestep=\"{}\" gravity=\"0 0 0\" cone=\"elliptic\" impratio=\"10\" iterations=\"100\" tolerance=\"1e-12\" "
      "noslip_iterations=\"10\" noslip_tolerance=\"1e-12\" collision=\"predefined\" jacobian=\"dense\" solver=\"Newton\"><flag "
      "multiccd=\"enable\"/></option>\n"
      "<default><geom density=\"{}\"/></default>\n<asset>\n{}</asset>\n<worldbody>\n"
      "<body name=\"vessel\"><freejoint/><inertial pos=\"0.001 0.002 0.003\" mass=\"1\" fullinertia=\"0.003 0.0025 0.002 0.0001 0 "
      "0\"/>\n"
      "{}</body>\n{}</worldbody>\n<contact>\n{}</contact>\n"
      "<equality><weld name=\"pin\" body1=\"vessel\" solref=\"0.004 1\" solimp=\"0.99 0.999 0.0001\"/></equality></mujoco>\n",
      4 * setup.most_contacts + 100, setup.most_contacts, setup.most_contacts > MOST_CONTACTS ? 4'000'000 : 500'000, TIME_STEP,
      FLESH, setup.form.assets, setup.form.geoms, setup.grasp.bodies, pairs);
}

HeldBody::HeldBody(const MujocoLibrary& library, const HeldSetup& setup)
    : simulation_(library, model_text(setup)),
      joints_(setup.grasp.joints),
      rest_(joints_.size(), 0.0),
      distance_(setup.form.boxes.empty() ? nullptr : setup.distance),
      boxes_(setup.form.boxes) {
  if (!boxes_.empty()) whole_box_ = boxes_.front();
  for (const auto& box : boxes_) {
    Vec3 farthest(0);
    for (int axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<std::size_t>(axis);
      farthest[axis] = std::max(std::abs(box[0][i]), std::abs(box[1][i]));
      whole_box_[0][i] = std::min(whole_box_[0][i], box[0][i]);
      whole_box_[1][i] = std::max(whole_box_[1][i], box[1][i]);
    }
    body_reach_ = std::max(body_reach_, glm::length(farthest));
  }
  geom_place_.assign(static_cast<std::size_t>(simulation_.model().ngeom), -1);
  box_place_ = geom_place_;
  for (std::size_t k = 0; k < setup.form.names.size(); ++k)
    box_place_[static_cast<std::size_t>(simulation_.id(mjOBJ_GEOM, setup.form.names[k]))] = static_cast<int>(k);
  for (std::size_t k = 0; k < setup.grasp.geoms.size(); ++k) {
    geoms_.push_back(simulation_.id(mjOBJ_GEOM, setup.grasp.geoms[k]));
    geom_place_[static_cast<std::size_t>(geoms_.back())] = static_cast<int>(k);
  }
  for (const std::string& name : setup.grasp.bones) bones_.push_back(simulation_.id(mjOBJ_BODY, name));
  body_ = simulation_.id(mjOBJ_BODY, "vessel");
  pin_ = simulation_.id(mjOBJ_EQUALITY, "pin");
  for (const GraspJoint& joint : joints_)
    if (joint.is_slide) strength_[static_cast<std::size_t>(joint.digit)] = joint.most;
  reset();
  set_load(setup.load);
}

void HeldBody::reset() {
  simulation_.reset();
  simulation_.model().eq_active[pin_] = 1;
  drives_.assign(joints_.size(), 0.0);
  rest_.assign(joints_.size(), 0.0);
  push_ = Vec3(0);
  anchors_.clear();
  time_ = 0;
  last_step_ = nearer_ = std::numeric_limits<double>::infinity();
  for (int k = 0; k < simulation_.model().npair; ++k) simulation_.model().pair_margin[k] = 0;
}

void HeldBody::set_load(const RigidLoad& load) {
  mjModel& m = simulation_.model();
  std::array<mjtNum, 9> axes{};
  m.body_mass[body_] = load.mass;
  for (int i = 0; i < 3; ++i) m.body_ipos[3 * body_ + i] = load.center[static_cast<std::size_t>(i)];
  simulation_.library().eig3(m.body_inertia + 3 * body_, axes.data(), m.body_iquat + 4 * body_, load.inertia.data());
  simulation_.set_constants();
}

void HeldBody::set_friction(double friction, double torsion) {
  mjModel& m = simulation_.model();
  for (int k = 0; k < m.npair; ++k) {
    m.pair_friction[5 * k] = m.pair_friction[5 * k + 1] = friction;
    m.pair_friction[5 * k + 2] = friction * torsion;
  }
}

void HeldBody::set_rest_pose() {
  for (std::size_t j = 0; j < joints_.size(); ++j) rest_[j] = simulation_.data().qpos[first_qpos_ + static_cast<int>(j)];
}

void HeldBody::release() {
  simulation_.model().eq_active[pin_] = 0;
  time_ = 0;
}

// Balls along a geom's axis, each wider than the geom by half of their spacing, enclose it: if none of them is near the body, the geom is not.
HeldBody::NearBalls HeldBody::near_balls(int geom) {
  constexpr double APART = 8e-3;  // m
  const mjModel& m = simulation_.model();
  const mjData& d = simulation_.data();
  const double half = m.geom_type[geom] == mjGEOM_CAPSULE ? m.geom_size[3 * geom + 1] : 0;
  const int count = 1 + static_cast<int>(std::ceil(2 * half / APART));
  NearBalls balls{m.geom_size[3 * geom] + half / count + NEAR, {}};
  const mjtNum* frame = d.geom_xmat + 9 * geom;
  for (int k = 0; k < count; ++k) {
    const double along = half * ((2 * k + 1.0) / count - 1);
    const Vec3 place = column(d.geom_xpos + 3 * geom) + along * Vec3(frame[2], frame[5], frame[8]);
    const Vec3 local = turned_back(d.xmat + 9 * body_, place - column(d.xpos + 3 * body_));
    if (box_distance(whole_box_, local) < balls.reach && distance_(local) < balls.reach) balls.centers.push_back(local);
  }
  return balls;
}

// The largest approach of a point of the hand and one of the body in the last step, m.
double HeldBody::largest_step() {
  const mjtNum* v = simulation_.data().qvel;
  std::array<double, core_f64::DIGITS> hand{};
  for (std::size_t j = 0; j < joints_.size(); ++j)
    hand[static_cast<std::size_t>(joints_[j].digit)] += joints_[j].reach * std::abs(v[first_dof_ + static_cast<int>(j)]);
  const double body = glm::length(column(v)) + body_reach_ * glm::length(column(v + 3));
  return TIME_STEP * (body + *std::max_element(hand.begin(), hand.end()));
}

// The engine first tests whether the balls about two geoms meet, with a margin; a margin that cancels both radii excludes the pair. Positions are
// those at the start of the last step, so the approach during it counts too. If that is too large, and before the first step, no pair is excluded.
void HeldBody::collide_near_pairs() {
  mjModel& m = simulation_.model();
  steps_ = 0;
  nearer_ = last_step_;
  std::vector<std::optional<NearBalls>> found(geom_place_.size());  // by id
  const auto is_near = [&](int hand, std::size_t box) {
    auto& balls = found[static_cast<std::size_t>(hand)];
    if (!balls) balls = near_balls(hand);
    return std::any_of(balls->centers.begin(), balls->centers.end(), [&](const Vec3& center) {
      return box >= boxes_.size() || box_distance(boxes_[box], center) < balls->reach;
    });
  };
  for (int k = 0; k < m.npair; ++k) {
    const bool is_first = geom_place_[static_cast<std::size_t>(m.pair_geom1[k])] >= 0;
    const int hand = is_first ? m.pair_geom1[k] : m.pair_geom2[k], body = is_first ? m.pair_geom2[k] : m.pair_geom1[k];
    const auto box = static_cast<std::size_t>(box_place_[static_cast<std::size_t>(body)]);
    m.pair_margin[k] = last_step_ >= SURE || is_near(hand, box) ? 0 : -(m.geom_rbound[hand] + m.geom_rbound[body]);
  }
}

void HeldBody::step() {
  mjData& d = simulation_.data();
  if (distance_ && (steps_ >= NEAR_STEPS || nearer_ >= SURE)) collide_near_pairs();
  std::array<double, core_f64::DIGITS> sum{};
  std::vector<double> torques(joints_.size());
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const GraspJoint& joint = joints_[j];
    const double spring = joint.stiffness * (rest_[j] - d.qpos[first_qpos_ + static_cast<int>(j)]);
    torques[j] = std::clamp(drives_[j] + spring, joint.is_slide ? 0.0 : -joint.most, joint.most);
    if (joint.is_slide) sum[static_cast<std::size_t>(joint.digit)] += torques[j];
  }
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const auto digit = static_cast<std::size_t>(joints_[j].digit);
    // a digit has one strength for all of its contacts
    const double share = joints_[j].is_slide && sum[digit] > strength_[digit] ? strength_[digit] / sum[digit] : 1;
    d.qfrc_applied[first_dof_ + static_cast<int>(j)] = share * torques[j];
  }
  for (int i = 0; i < 3; ++i) d.xfrc_applied[6 * body_ + i] = push_[i];
  simulation_.step();
  ++steps_;
  last_step_ = largest_step();
  nearer_ += last_step_;
  time_ += TIME_STEP;
}

std::vector<TouchedPlace> HeldBody::contacts() {
  mjModel& m = simulation_.model();
  mjData& d = simulation_.data();
  std::vector<TouchedPlace> touched;
  for (int k = 0; k < d.ncon; ++k) {
    const mjContact& contact = d.contact[k];
    const int first = geom_place_[static_cast<std::size_t>(contact.geom1)],
              second = geom_place_[static_cast<std::size_t>(contact.geom2)];
    const bool is_first = first >= 0;  // the normal points from the first geom to the second
    TouchedPlace place;
    place.geom = static_cast<std::size_t>(is_first ? first : second);
    place.overlap = -contact.dist;
    place.place = column(contact.pos);
    place.normal = (is_first ? 1.0 : -1.0) * column(contact.frame);
    std::array<mjtNum, 6> force{};
    simulation_.library().contact_force(&m, &d, k, force.data());
    place.normal_force = force[0];
    const double sense = is_first ? 1 : -1;
    place.force =
        sense * (force[0] * column(contact.frame) + force[1] * column(contact.frame + 3) + force[2] * column(contact.frame + 6));
    place.torsion = force[3];  // about the normal, both with the sense
    touched.push_back(place);
  }
  return touched;
}

double HeldBody::deepest_overlap() {
  double deepest = 0;
  const mjData& d = simulation_.data();
  for (int k = 0; k < d.ncon; ++k) deepest = std::max(deepest, -d.contact[k].dist);
  return deepest;
}

Vec3 HeldBody::place() { return column(simulation_.data().xpos + 3 * body_); }

std::array<double, 9> HeldBody::rotation() {
  std::array<double, 9> rows{};
  std::copy_n(simulation_.data().xmat + 9 * body_, 9, rows.begin());
  return rows;
}

std::array<double, 4> HeldBody::quaternion() {
  std::array<double, 4> q{};
  std::copy_n(simulation_.data().xquat + 4 * body_, 4, q.begin());
  return q;
}

Vec3 HeldBody::point_of(int body, const Vec3& local) {
  const mjData& d = simulation_.data();
  return column(d.xpos + 3 * body) + turned_by(d.xmat + 9 * body, local);
}

Vec3 HeldBody::moved(const Vec3& point) { return point_of(body_, point); }

double HeldBody::turned() {
  const auto q = quaternion();
  return 2 * std::atan2(std::hypot(q[1], q[2], q[3]), std::abs(q[0]));
}

std::vector<BonePlace> HeldBody::bones() {
  const mjData& d = simulation_.data();
  std::vector<BonePlace> places;
  for (const int bone : bones_) {
    BonePlace place;
    std::copy_n(d.xpos + 3 * bone, 3, place.place.begin());
    std::copy_n(d.xmat + 9 * bone, 9, place.rotation.begin());
    places.push_back(place);
  }
  return places;
}

void HeldBody::anchor() {
  anchors_.clear();
  const mjModel& m = simulation_.model();
  const mjData& d = simulation_.data();
  for (const TouchedPlace& touched : contacts()) {
    const int bone = m.geom_bodyid[geoms_[touched.geom]];
    const auto local = [&](int body) { return turned_back(d.xmat + 9 * body, touched.place - column(d.xpos + 3 * body)); };
    anchors_.push_back({bone, local(bone), local(body_), turned_back(d.xmat + 9 * body_, touched.normal)});
  }
}

double HeldBody::slipped() {
  double most = 0;
  const mjData& d = simulation_.data();
  for (const Anchor& anchor : anchors_) {
    const Vec3 apart = turned_back(d.xmat + 9 * body_, point_of(anchor.bone, anchor.on_bone) - point_of(body_, anchor.on_body));
    most = std::max(most, glm::length(apart - glm::dot(apart, anchor.normal) * anchor.normal));
  }
  return most;
}

}  // namespace wholehand
