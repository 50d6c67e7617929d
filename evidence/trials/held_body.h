// SPDX-License-Identifier: MIT
// A body in a grasp, in the engine: pinned, released, pushed and observed. docs/trials-model.md has the reason for each option.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "evidence/trials/grasp_model.h"
#include "evidence/trials/mujoco.h"
#include "evidence/trials/vessel_body.h"

namespace wholehand {

constexpr double TIME_STEP = 2e-3;  // s
// The engine searches for contacts only among geoms nearer to the body than NEAR. It checks again every NEAR_STEPS, and at once when hand and body
// may have approached by SURE since, so that no touching pair is left out.
constexpr double NEAR = 5e-3, SURE = 4e-3;  // m; the difference exceeds the error of a lattice's distance
constexpr int NEAR_STEPS = 5;
constexpr int MOST_CONTACTS = 100;        // six with four points each take 24
constexpr int MOST_PIECE_CONTACTS = 300;  // of a body of many pieces, of which a finger touches some at a time

// What touches the hand of a body: XML and the names of its geoms.
struct BodyForm {
  std::string assets, geoms;
  std::vector<std::string> names;
  double error = 0;                          // m, by which a piece may lie outside the body whose distance is asked
  std::string text;                          // the line about the pieces; empty: none
  std::vector<std::array<Triple, 2>> boxes;  // low and high corner of each, in the body's frame, m; none: unknown
};
BodyForm body_form(std::span<const ConvexPiece> pieces);

// The parts of a model. The body's frame is the model's.
struct HeldSetup {
  BodyForm form;
  GraspModel grasp;
  double friction = 0, torsion = 0;  // of every contact; torsion in m
  RigidLoad load;
  // Which geom of the hand may touch which of the body, by index in their lists; empty: each may touch each.
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  // Signed distance to the body at a point of its frame, m, or a lower bound. Empty, or without boxes: all pairs are always checked.
  std::function<double(const core_f64::Vec3&)> distance;
  int most_contacts = MOST_CONTACTS;  // room in the engine; an overflow is reported, never ignored
};

// One contact at the present moment.
struct TouchedPlace {
  std::size_t geom = 0;              // index in the hand's list
  double overlap = 0;                // m
  core_f64::Vec3 place{}, normal{};  // normal into the body
  double normal_force = 0;           // N
  core_f64::Vec3 force{};            // on the body, total, N
  double torsion = 0;                // N m
};

class HeldBody {
 public:
  HeldBody(const MujocoLibrary& library, const HeldSetup& setup);

  // Resets to the initial state, pinned, without load and drive.
  void reset();
  void set_load(const RigidLoad& load);
  void set_friction(double friction, double torsion);
  // Sets the force at the center of mass from now on, N.
  void push(const core_f64::Vec3& force) { push_ = force; }
  // Torques of the joints, or forces of the slides, in addition to their springs.
  void drive(std::span<const double> drives) { drives_.assign(drives.begin(), drives.end()); }
  // Sets the rest positions of the joints' springs to the present ones.
  void set_rest_pose();
  void release();
  void step();

  double time() const { return time_; }  // s since the release; while pinned also counts, from 0
  std::vector<TouchedPlace> contacts();
  double deepest_overlap();  // m; 0 without contacts
  core_f64::Vec3 place();
  std::array<double, 9> rotation();                   // rows
  std::array<double, 4> quaternion();                 // w, x, y, z
  core_f64::Vec3 moved(const core_f64::Vec3& point);  // present place of a point of the body
  double turned();                                    // rad, from where it was pinned
  std::vector<BonePlace> bones();                     // of the model's
  // Sliding of the contacts along the surface since `anchor`: how far bone and body have slid there, m.
  void anchor();
  double slipped();
  Simulation& simulation() { return simulation_; }

 private:
  struct Anchor {
    int bone = 0;                                   // of the engine's bodies
    core_f64::Vec3 on_bone{}, on_body{}, normal{};  // each in its frame; the normal in the body's
  };
  core_f64::Vec3 point_of(int body, const core_f64::Vec3& local);
  void collide_near_pairs();
  double largest_step();
  // Balls about a geom of the hand that may be near the body, in the body's frame; each with its reach.
  struct NearBalls {
    double reach = 0;
    std::vector<core_f64::Vec3> centers;
  };
  NearBalls near_balls(int geom);

  Simulation simulation_;
  std::vector<GraspJoint> joints_;
  std::vector<int> geoms_, bones_, geom_place_;  // ids; index of a geom in the hand's list, by id
  int body_ = 0, pin_ = 0, first_qpos_ = 7, first_dof_ = 6;
  std::array<double, core_f64::DIGITS> strength_{};  // of slides, by digit
  std::vector<double> drives_, rest_;
  std::vector<Anchor> anchors_;
  core_f64::Vec3 push_{};
  double time_ = 0;
  // Since the last check of pairs: steps, and an upper bound of the approach of hand and body, m. Infinite: no check yet.
  int steps_ = 0;
  double nearer_ = std::numeric_limits<double>::infinity(), last_step_ = nearer_;
  double body_reach_ = 0;  // m, of the body's farthest point from its origin
  std::function<double(const core_f64::Vec3&)> distance_;
  std::vector<std::array<Triple, 2>> boxes_;
  std::array<Triple, 2> whole_box_{};  // of all boxes
  std::vector<int> box_place_;         // index of a geom in the body's list, by id
};

// The engine's text of a setup.
std::string model_text(const HeldSetup& setup);

}  // namespace wholehand
