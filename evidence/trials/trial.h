// SPDX-License-Identifier: MIT
// A trial: a physics engine holds a vessel with a grip's hand, and reports whether it stays. Request and answer.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/result.h"
#include "core/scene.h"

namespace wholehand {

// Gravity turned step by step with each fill; or a force along each of six directions, without weight.
enum class TrialProtocol { fill_tilt, six_forces };
// The hand as an articulated body of bones; or, as a cross-check, each contact as a sphere on a slide along its normal.
enum class TrialModel { hand, contacts };

// One trial of a grip: a fill at a tilt, or a fill pushed along a direction.
struct TrialCase {
  TrialProtocol protocol = TrialProtocol::fill_tilt;
  double fill = 0;    // of the capacity; 0 without liquid
  double tilt = 0;    // rad; fill_tilt
  int direction = 0;  // six_forces: +x, -x, +y, -y, +z, -z of the vessel frame
  int material = 0;   // six_forces: place in TrialSettings::materials
};

// The vessel's values for six_forces.
struct TrialMaterial {
  std::string name;                                            // "scene", "DexGraspBench"
  double mass = std::numeric_limits<double>::quiet_NaN();      // kg; NaN: that of the state
  double friction = std::numeric_limits<double>::quiet_NaN();  // NaN: the scene's
  double torsion = std::numeric_limits<double>::quiet_NaN();   // m; NaN: the scene's
};

// The numbers of a run. Lengths m, angles rad, times s.
struct TrialSettings {
  TrialModel model = TrialModel::hand;
  double squeeze = 1.25;                                       // factor on the fingers' least forces
  double mass = std::numeric_limits<double>::quiet_NaN();      // kg, of the whole in every state; NaN: that of the state
  double friction = std::numeric_limits<double>::quiet_NaN();  // NaN: the scene's
  // DexGraspBench sets MuJoCo's torsional coefficient to 20 mm, which is mu gamma.
  std::vector<TrialMaterial> materials{{"scene"}, {"DexGraspBench", 0.1, 0.6, 20e-3 / 0.6}};
  double tilt_rate = radians(25);                          // rad/s
  double hold_time = 1;                                    // at each tilt
  double push_time = 2;                                    // in each direction
  double push_acceleration = 10;                           // m/s2, times the mass
  double largest_move = 0.05, largest_turn = radians(15);  // held: less than these
  double slip = 2e-3;                                      // a contact that slides more has slipped
  double start_overlap = 1e-3;                             // more at the start: discarded
  double buried = 3e-3;                                    // a finger deeper once closed: discarded
};

// Why a trial is discarded, or was not held.
enum class TrialReason {
  none,      // held
  overlap,   // discarded: the hand starts too deep in the vessel
  buried,    // discarded: a finger is too deep in it once closed
  diverged,  // discarded: the engine gave a warning or a number that is not finite
  release,   // lost while it settled after the release
  turned,    // lost: turned too far in the hand
  moved,     // lost: moved too far in the hand
  earlier,   // lost at a smaller tilt of the same fill
};
extern const std::array<const char*, 8> TRIAL_REASON_NAMES;  // "" for none

struct TrialOutcome {
  bool held = false;
  bool discarded = false;
  TrialReason reason = TrialReason::none;
  std::string detail;         // the engine's words, for a discarded one
  double slip = 0;            // largest slide of a contact on the vessel since the release, m
  double move = 0, turn = 0;  // largest of the vessel since the release, m, rad
  double when = 0;            // of the loss, s since the release; 0 where held
  double tilt_lost = 0;       // at which it was lost, rad
};

// A grip moved by a deviation, tried in all its cases.
struct Placement {
  bool is_possible = false;                // feasible and plausible there; else it is not tried
  bool held = false;                       // in every case
  TrialReason reason = TrialReason::none;  // of the first case that was discarded; else of the first that was lost
};
constexpr bool is_discarded(TrialReason reason) {
  return reason == TrialReason::overlap || reason == TrialReason::buried || reason == TrialReason::diverged;
}

// One moment of a trial, for a drawing or a recording. Vessel and hand in the frame of the grip: the vessel's as it was gripped.
struct TrialFrame {
  double time = 0;                             // s since the release
  Triple place{};                              // of the vessel's origin, m
  std::array<double, 4> rotation{1, 0, 0, 0};  // w, x, y, z
  Triple up{0, 1, 0};                          // against gravity
  PosedHand joints{};                          // m; as posed for the model `contacts`
};

struct TrialTrack {
  double interval = 0.02;  // s between frames
  std::vector<TrialFrame> frames;
};

// Tries grips of one scene. Thread-safe; the same grip and cases give the same bits on any thread, in any order.
class TrialEngine {
 public:
  virtual ~TrialEngine() = default;
  virtual std::string name() const = 0;  // "MuJoCo 2.2.2"
  // Throws Error (usage), with the vessel's name and the reason, if the vessel or the scene's hand has no model; call it before trying any grip. It
  // does not check single grips.
  virtual void check(std::size_t vessel) const { static_cast<void>(vessel); }
  // What the model of a vessel's form is, and its error: "42 convex pieces, which leave the mesh by at most 0.50 mm". Empty: the outline's own. Throws
  // Error as `check`.
  virtual std::string form_text(std::size_t vessel) const {
    static_cast<void>(vessel);
    return "";
  }
  // One outcome for each case, in order. Cases of one fill of fill_tilt are one run of the engine through ascending tilts; an outcome does not depend
  // on further tilts after it. `tracks`, if requested, gets one for each case. `grip` is feasible and plausible. Throws Error as `check`.
  virtual std::vector<TrialOutcome> run(std::size_t vessel, const GripInput& grip, const std::vector<TrialCase>& cases,
                                        std::vector<TrialTrack>* tracks = nullptr) const = 0;
};

}  // namespace wholehand
