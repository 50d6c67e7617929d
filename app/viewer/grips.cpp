// SPDX-License-Identifier: MIT
#include "app/viewer/grips.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "app/viewer/scene.h"
#include "base/files/json.h"
#include "base/text/error.h"
#include "core/counted_tilts.h"
#include "core/load.h"
#include "core/mesh_body.h"
#include "core/outline_points.h"
#include "core/prepare.h"
#include "core/vectors.h"
#include "sweeps/grips/hand_nodes.h"
#include "sweeps/grips/holding.h"
#include "sweeps/grips/report.h"

namespace wholehand {
namespace {

using core_f64::Mat3;
using core_f64::Vec3;
using Json = nlohmann::ordered_json;

// A vessel of the scene, and data beyond the evaluator: its cavity, and points that show how low it reaches.
struct ViewedVessel {
  core_f64::Vessel vessel;
  std::vector<std::array<double, 2>> rings;  // (r, y) of its profile, m; arcs by their chords' ends
  std::vector<Triple> points;                // of a mesh
};

ViewedVessel load_viewed(const Scene& scene, const VesselData& data, const core_f64::Quadrature& quadrature) {
  const PreparedVessel prepared = prepare_vessel(data, data.has_cavity());
  ViewedVessel viewed;
  viewed.vessel = core_f64::load_vessel(prepared, data, quadrature, false, scene.hand.handedness);
  viewed.rings = outline_points(prepared.hull, prepared.hull.size(), ARC_STEP);
  if (data.mesh) viewed.points = data.mesh->body->vertices;
  return viewed;
}

// The least y of the vessel turned by `turn` about its origin, m.
double lowest_of(const ViewedVessel& viewed, const Mat3& turn) {
  const Vec3 up = glm::transpose(turn) * Vec3(0, 1, 0);
  const double sine = std::hypot(up.x, up.z);
  double lowest = core_f64::NO_DISTANCE;
  for (const auto& [r, y] : viewed.rings) lowest = std::min(lowest, up.y * y - sine * r);
  for (const Triple& point : viewed.points) lowest = std::min(lowest, glm::dot(up, to_vec3(point)));
  return lowest;
}

void put_place(Json& json, const GripInput& grip) {
  json["height_m"] = grip.height;
  json["azimuth_rad"] = grip.azimuth;
  json["obliquity_rad"] = grip.obliquity;
  json["roll_rad"] = grip.roll;
  json["offset_m"] = grip.offset;
}

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

}  // namespace

class GripsView::Impl {
 public:
  Impl(const Scene& scene, const std::vector<ViewedGrip>& grips, std::vector<std::string>& notes)
      : scene_(scene),
        evaluator_(make_core_evaluator(scene)),
        quadrature_(core_f64::load_quadrature(prepare_quadrature(QUADRATURE_POINTS))) {
    for (const VesselData& data : scene_.vessels) vessels_.push_back(load_viewed(scene_, data, quadrature_));
    for (std::size_t v = 0; v < vessels_.size(); ++v) last_tilts_.push_back(last_tilts(scene_, v));
    for (const ViewedGrip& wanted : grips) {
      Seen seen{wanted, {}, {}, {}, {}};
      evaluator_->grip(wanted.vessel, wanted.grip, seen.result);
      if (seen.result.reason != Reason::none) {
        notes.push_back(fmt::format("{} is not shown: the core finds that it is not feasible ({})", wanted.label,
                                    REASON_NAMES[static_cast<std::size_t>(seen.result.reason)]));
        continue;
      }
      seen.score = evaluator_->score(wanted.vessel, wanted.grip, seen.result);
      seen.wrist = sweeps::hand_nodes(scene_.hand, wanted.grip, seen.result).wrist.position;
      if (scene_.strength) {
        seen.holding =
            std::make_unique<sweeps::Holding>(scene_, *evaluator_, wanted.vessel, seen.result, to_triple(pour_of(wanted.grip)));
      }
      seen_.push_back(std::move(seen));
    }
    if (seen_.empty()) throw usage_error("view: there is no feasible grip to show");
  }

  std::size_t size() const { return seen_.size(); }
  const GripResult& result(std::size_t grip) const { return seen_[grip].result; }

  ViewFrame frame(std::size_t grip, double fill, double tilt) const {
    const Seen& seen = seen_[grip];
    const std::size_t v = seen.wanted.vessel;
    const Mat3 turn = turn_of(seen, tilt);
    ViewFrame frame;
    frame.state = device::SESSION_STATE_NAMES[static_cast<std::size_t>(tilt > 0 ? device::SessionState::maintain
                                                                                : device::SessionState::lift)];
    frame.vessel = static_cast<int>(v);
    const Vec3 place = place_of(seen, turn);
    pose_hand(seen, turn, place, frame.hand);
    frame.closure = seen.result.closure;
    frame.gap = seen.result.gap;
    frame.tilt = tilt;
    LiquidResult liquid;
    if (scene_.liquid) liquid = evaluator_->liquid(v, fill, tilt);
    frame.vessels.resize(scene_.vessels.size());
    for (ViewFrame::Vessel& vessel : frame.vessels) vessel.is_shown = false;
    const Rotation rotation = to_rotation(turn);
    frame.vessels[v] = {true,
                        {to_triple(place), rotation},
                        liquid.volume,
                        device::liquid_surface(vessels_[v].vessel, quadrature_, liquid.volume, rotation)};
    put_forces(seen, fill, tilt, liquid, frame);
    return frame;
  }

  std::string grips_json() const {
    Json list = Json::array();
    for (const Seen& seen : seen_) list.push_back(grip_json(seen));
    return json_text(list);
  }

  std::string scene_json(const std::string& title, const sweeps::StateAxes& asked) const {
    ViewFacts facts;
    facts.mode = ViewMode::grips;
    facts.title = title;
    facts.device = "core";
    facts.grips = grips_json();
    facts.fills = asked.fills;
    facts.tilts = asked.tilts;
    return view_scene_json(scene_, facts);
  }

  std::string state(const ViewContent::Query& query) const {
    const double grip = query_number(query, "grip", 0, static_cast<double>(seen_.size() - 1));
    if (grip != std::floor(grip)) throw usage_error("grip must be a whole number");
    const double fill = query_number(query, "fill", 0, scene_.liquid ? 1 : 0);
    return frame_json(frame(static_cast<std::size_t>(grip), fill, std::min(PI, query_number(query, "tilt", 0, PI + 1e-6))));
  }

  const Scene& scene() const { return scene_; }

 private:
  struct Seen {
    ViewedGrip wanted;
    GripResult result;
    GripScore score;
    Triple wrist{};
    std::unique_ptr<const sweeps::Holding> holding;  // in a scene with strengths
  };

  // Any direction where the line is vertical.
  Vec3 pour_of(const GripInput& grip) const {
    const Vec3 to = to_vec3(sweeps::pour_direction(scene_, grip));
    return glm::length(to) < 0.5 ? Vec3(1, 0, 0) : to;
  }

  // About the horizontal axis that turns up to the pouring direction.
  Mat3 turn_of(const Seen& seen, double tilt) const {
    const Vec3 to = pour_of(seen.wanted.grip), up(0, 1, 0), across = glm::cross(up, to);
    const double c = std::cos(tilt), s = std::sin(tilt);
    // columns: where x, y, z of the frame (to, up, across) go
    const Mat3 frame(to, up, across), turned(c * to - s * up, s * to + c * up, across);
    return turned * glm::transpose(frame);
  }

  // About the middle of the tips, and raised so that no glass is below the table on which it stands upright. The hand may be below it, visibly.
  Vec3 place_of(const Seen& seen, const Mat3& turn) const {
    const std::size_t v = seen.wanted.vessel;
    const Vec3 pivot = to_vec3(seen.result.midpoint), home = to_vec3(scene_.vessels[v].place);
    Vec3 place = home + pivot - turn * pivot;
    const double table = home.y + scene_.vessels[v].base;
    place.y += std::max(0.0, table - (place.y + lowest_of(vessels_[v], turn)));
    return place;
  }

  static void pose_hand(const Seen& seen, const Mat3& turn, Vec3 place, device::HandView& hand) {
    const GripResult& result = seen.result;
    const std::uint32_t projected = result.tip_mask | result.finger_mask | result.inner_mask;
    const auto out = [&](const Triple& point) { return to_triple(place + turn * to_vec3(point)); };
    for (int j = 0; j < JOINT_COUNT; ++j) {
      hand.rigged[j] = out(result.joints[j]);
      hand.posed[j] = out(result.posed[j]);
      hand.proxies[j] = out(result.proxies[j]);
      const bool touches = (result.touch_mask >> j & 1) != 0, is_projected = (projected >> j & 1) != 0;
      const bool is_tracked = j == THUMB_TIP || j == INDEX_TIP;
      hand.contact[j] = is_tracked     ? (touches ? device::PointContact::tracked_touching : device::PointContact::tracked)
                        : !touches     ? device::PointContact::free
                        : is_projected ? device::PointContact::projected
                                       : device::PointContact::touching;
    }
    hand.wrist = hand.rigged_wrist = out(seen.wrist);
    hand.vessel = static_cast<int>(seen.wanted.vessel);
  }

  void put_forces(const Seen& seen, double fill, double tilt, const LiquidResult& liquid, ViewFrame& frame) const {
    const auto state_at = [&](const LiquidResult& there, double angle) {
      return evaluator_->state(seen.wanted.vessel, seen.wanted.grip, seen.result, there, angle);
    };
    const StateResult state = state_at(liquid, tilt);
    const StateResult upright = state_at(scene_.liquid ? evaluator_->liquid(seen.wanted.vessel, fill, 0) : LiquidResult{}, 0);
    frame.feedback = state.feedback_force;
    frame.base = scene_.force.base;
    frame.normal = state.normal_force;
    frame.user = state.feedback_force - (state.normal_force - upright.normal_force);
    frame.hold = state.hold_force;
    frame.weight = state.mass * scene_.gravity;
    frame.torque = state.torque;
    if (!seen.holding) return;
    frame.hand.hold = hold_of(seen.holding->state({fill, tilt, liquid, state}), frame.vessels[seen.wanted.vessel].pose);
    frame.hold = frame.hand.hold->force();
  }

  // In the world, where the vessel is.
  device::HandHold hold_of(const sweeps::StateHold& state, const device::VesselPose& pose) const {
    const Mat3 turn = to_mat3(pose.rotation);
    const auto turned = [&](const Triple& v) { return to_triple(turn * to_vec3(v)); };
    device::HandHold hold{state.effort, state.low, state.tips, state.strength.weaker_tip(), {}};
    for (const sweeps::HeldContact& contact : state.contacts) {
      if (contact.force == Triple{}) continue;
      const Triple place = to_triple(to_vec3(pose.place) + turn * to_vec3(contact.point));
      hold.presses.push_back({contact.digit, place, turned(contact.normal), turned(contact.force)});
    }
    return hold;
  }

  Json grip_json(const Seen& seen) const {
    const GripInput& grip = seen.wanted.grip;
    const GripResult& result = seen.result;
    const ScoreTerms& terms = seen.score.terms;
    Json json{
        {"vessel", seen.wanted.vessel}, {"label", seen.wanted.label}, {"score", seen.wanted.score.value_or(seen.score.score)}};
    json["terms"] = {{"fingers", terms.fingers}, {"contacts", terms.contacts}, {"depth", terms.depth}, {"posture", terms.posture}};
    if (!scene_.tilts.empty()) {
      json["terms"]["force"] = terms.force;
      json["terms"]["hold"] = terms.hold;
    }
    put_place(json, grip);
    json["hand_scale"] = grip.hand_scale;
    if (seen.wanted.refined) {
      json["refined"] = {{"score", seen.wanted.refined->score}};
      put_place(json["refined"], seen.wanted.refined->grip);
    }
    if (seen.wanted.robust) json["robust"] = {{"mean", seen.wanted.robust->mean}, {"low", seen.wanted.robust->low}};
    json["gap_m"] = result.gap;
    json["closure"] = result.closure;
    json["fingers"] = std::popcount(result.used_mask);
    json["points"] = std::popcount(result.touch_mask);
    json["depth_m"] = std::max(result.phalanx_depth, result.palm_depth);
    json["antipodal"] = result.antipodal;
    double peak = device::Tick::NONE, hold = device::Tick::NONE, safe = device::Tick::NONE;
    bool is_safe_to_end = !seen.score.fills.empty();
    for (std::size_t f = 0; f < seen.score.fills.size(); ++f) {
      const FillTerms& fill = seen.score.fills[f];
      peak = std::isnan(peak) ? fill.peak_force : std::max(peak, fill.peak_force);
      hold = std::isnan(hold) ? fill.largest_hold : std::max(hold, fill.largest_hold);
      safe = f == 0                                           ? fill.safe_tilt
             : std::isnan(safe) || std::isnan(fill.safe_tilt) ? device::Tick::NONE
                                                              : std::min(safe, fill.safe_tilt);
      is_safe_to_end = is_safe_to_end && fill.safe_tilt >= last_tilts_[seen.wanted.vessel][f];
    }
    json["peak_force_N"] = finite_or_null(peak);
    json["hold_force_N"] = finite_or_null(hold);
    json["safe_tilt_rad"] = finite_or_null(safe);
    json["safe_to_end"] = is_safe_to_end;
    return json;
  }

  const Scene scene_;
  std::unique_ptr<Evaluator> evaluator_;
  core_f64::Quadrature quadrature_;
  std::vector<ViewedVessel> vessels_;
  std::vector<std::vector<double>> last_tilts_;  // of each vessel
  std::vector<Seen> seen_;
};

GripsView::GripsView(const Scene& scene, const std::vector<ViewedGrip>& grips, std::vector<std::string>& notes)
    : impl_(std::make_unique<Impl>(scene, grips, notes)) {}
GripsView::~GripsView() = default;

std::size_t GripsView::size() const { return impl_->size(); }
const GripResult& GripsView::result(std::size_t grip) const { return impl_->result(grip); }
ViewFrame GripsView::frame(std::size_t grip, double fill, double tilt) const { return impl_->frame(grip, fill, tilt); }

ViewContent GripsView::content(const std::string& title, const sweeps::StateAxes& asked) const {
  ViewContent content;
  content.scene = impl_->scene_json(title, asked);
  for (const VesselData& vessel : impl_->scene().vessels) content.meshes.push_back(mesh_bytes(vessel));
  content.state = [this](const ViewContent::Query& query) { return impl_->state(query); };
  return content;
}

}  // namespace wholehand
