// SPDX-License-Identifier: MIT
#include "device/advice/adviser.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/text/error.h"
#include "core/core_backend.h"
#include "core/fills.h"
#include "core/planes.h"
#include "device/advice/cloud.h"
#include "host/open_backend.h"
#include "shaders/status.h"

namespace wholehand::device {
namespace {

constexpr std::size_t RATED_BY_CORE = 8;  // of a cloud
constexpr double WIDEST_SHARE = 0.5, NARROWEST_SHARE = 0.05, NARROWING = 0.7;
constexpr double MOVED = 0.1;  // sizes of the reach: a best grip this far from the last one counts as another
constexpr double POURED_OUT = 1 - LEFT_AS_EMPTY;

double like(double effort) { return effort * (1 + LIKE_SHARE) + LIKE_EFFORT; }

double fill_of(const VesselData& vessel, double volume, double capacity) {
  return vessel.has_cavity() && capacity > 0 ? std::clamp(volume / capacity, 0.0, 1.0) : 0;
}

// Among the rated grips that are as good as the best of them, the one with the shortest way.
const RatedGrip* nearest_of_best(const std::vector<RatedGrip>& rated, const GripInput& from) {
  double least = std::numeric_limits<double>::infinity();
  for (const RatedGrip& one : rated)
    if (one.is_possible) least = std::min(least, one.effort);
  const RatedGrip* nearest = nullptr;
  for (const RatedGrip& one : rated) {
    if (!one.is_possible || !(one.effort <= like(least))) continue;
    if (!nearest || way_between(from, one.grip) < way_between(from, nearest->grip)) nearest = &one;
  }
  return nearest;
}

}  // namespace

Scene advice_scene(const Scene& scene) {
  if (!scene.strength) {
    throw usage_error(at_place(
        scene.file,
        "advice is about the effort of the hand, and the scene has no strengths; leave efforts = false out of [strength]"));
  }
  Scene own = scene;
  if (own.tilts.empty())
    for (int k = 0; k * AHEAD_STEP <= MOST_AHEAD + 1e-9; ++k) own.tilts.push_back(k * AHEAD_STEP);
  own.until_poured = POURED_OUT;
  for (VesselData& vessel : own.vessels) vessel.fills = {vessel.liquid_fill};
  if (own.liquid) {
    own.liquid->volumes.clear();
    own.liquid->fills = {0};
  }
  own.arm.reset();  // in a session the vessel moves, and nobody knows where the shoulder is
  if (own.table) own.table->clearance -= TABLE_LOWERED * own.hand.scale;
  return own;
}

Adviser::Adviser(const Scene& scene, const std::string& on, int threads)
    : Adviser(scene, [&](const Scene& own, const FieldSet& fields) {
        return open_backend(own, fields, on, on == "core" ? Precision::full : Precision::single, threads);
      }) {}

Adviser::Adviser(const Scene& scene, const BackendOpener& open)
    : scene_(advice_scene(scene)),
      fields_(make_field_set({FIELD_WORST_EFFORT, FIELD_STATUS, FIELD_TABLE_DEPTH}, scene_)),
      rated_(make_field_set({FIELD_WORST_EFFORT, FIELD_WORST_EFFORT_TILT, FIELD_STATUS, FIELD_TABLE_DEPTH}, scene_)),
      backend_(open(scene_, fields_)),
      core_(make_core_evaluator(scene_)) {
  if (scene.table) lowered_ = scene.table->clearance - scene_.table->clearance;
  for (std::size_t v = 0; v < scene_.vessels.size(); ++v) {
    capacities_.push_back(core_->capacity(v));
    volumes_.push_back(scene_.vessels[v].liquid_fill * capacities_.back());
  }
  warm_up();
}

// The first question takes as long as later ones: buffers exist, and a driver has compiled what it left for the first dispatch.
void Adviser::warm_up() {
  if (info().backend == "core") return;
  for (std::size_t v = 0; v < scene_.vessels.size(); ++v) {
    GripInput middle;
    middle.height = 0.5 * (scene_.vessels[v].base + scene_.vessels[v].height);
    ask(static_cast<int>(v), grip_cloud(reach_of(scene_.vessels[v], middle), middle, {}, 1, 0, LEAST_CLOUD), nullptr);
  }
}

std::string Adviser::place() const { return info().backend == "core" ? info().device : info().backend + ", " + info().device; }

std::vector<std::string> Adviser::notes() { return std::exchange(notes_, {}); }

// The device's pipelines stay; only its tables of liquid and states are remade. If it does not accept them, its grips would use a different liquid
// from the core's.
void Adviser::take_volume(int vessel, double volume) {
  const auto v = static_cast<std::size_t>(vessel);
  if (!scene_.liquid || std::abs(volume - volumes_[v]) <= SAME_FILL * capacities_[v]) return;
  volumes_[v] = volume;
  scene_.vessels[v].fills = {fill_of(scene_.vessels[v], volume, capacities_[v])};
  core_ = make_core_evaluator(scene_);
  session_.reset();
  try {
    if (!backend_->use_fills_of(scene_)) go_on_with_core("the device does not take the liquid that is left");
  } catch (const std::exception& error) {
    go_on_with_core(error.what());
  }
}

void Adviser::go_on_with_core(const std::string& why) {
  backend_ = std::make_unique<CoreBackend>(make_core_evaluator(scene_), scene_, fields_, Precision::full, 0);
  notes_.push_back(why + "; the core goes on");
}

// Whether a grip may be advised: plausible, and above the table of a vessel that stands. `table_depth`: in the lowered table.
bool Adviser::is_allowed(std::uint32_t status, double table_depth) const {
  return is_plausible(status) && !(scene_.table && stands_ && table_depth + lowered_ > 0);
}

// The allowed grips of a cloud with their worst efforts.
std::vector<Adviser::Found> Adviser::ask(int vessel, const std::vector<GripInput>& cloud, const std::atomic<bool>* stop) {
  std::vector<Found> found;
  RunRequest request;
  request.vessel = static_cast<std::size_t>(vessel);
  request.last = cloud.size();
  request.stop = stop;
  request.grips = [&cloud](std::size_t, std::uint64_t first, std::size_t count, GripInput* out) {
    std::copy_n(cloud.begin() + static_cast<std::ptrdiff_t>(first), count, out);
  };
  request.sink = [&](const PlaneChunk& chunk) {
    for (std::size_t i = 0; i < chunk.count; ++i) {
      const double effort = chunk.real(fields_.plane[FIELD_WORST_EFFORT], i);
      const double depth = scene_.table ? chunk.real(fields_.plane[FIELD_TABLE_DEPTH], i) : 0;
      if (is_allowed(chunk.uint(fields_.plane[FIELD_STATUS], i), depth) && std::isfinite(effort))
        found.push_back({effort, static_cast<std::size_t>(chunk.first) + i});
    }
  };
  for (const std::string& note : backend_->run(request).notes) {
    if (std::find(noted_.begin(), noted_.end(), note) != noted_.end()) continue;
    noted_.push_back(note);
    notes_.push_back(note);
  }
  return found;
}

// `is_advised`: it must be allowed.
RatedGrip Adviser::rate(const Evaluator& core, int vessel, const GripInput& grip, bool is_advised) const {
  std::vector<double> reals(static_cast<std::size_t>(rated_.real_planes));
  std::vector<std::uint32_t> uints(static_cast<std::size_t>(rated_.uint_planes));
  core.planes(static_cast<std::size_t>(vessel), &grip, 1, rated_, 1, reals.data(), uints.data());
  const auto real = [&](int field) { return reals[static_cast<std::size_t>(rated_.plane[field])]; };
  const std::uint32_t status = uints[static_cast<std::size_t>(rated_.plane[FIELD_STATUS])];
  RatedGrip rated;
  rated.grip = grip;
  rated.is_possible = is_advised ? is_allowed(status, scene_.table ? real(FIELD_TABLE_DEPTH) : 0) : is_plausible(status);
  if (!rated.is_possible) return rated;
  rated.effort = real(FIELD_WORST_EFFORT);
  rated.tilt = real(FIELD_WORST_EFFORT_TILT);
  return rated;
}

// The hand's own grip, by the rules of a session.
RatedGrip Adviser::rate_present(const GripInput& grip) {
  const RatedGrip rated = rate(*core_, vessel_, grip, false);
  if (rated.is_possible || !core_->posed(static_cast<std::size_t>(vessel_), grip)) return rated;
  if (!session_) {
    Scene scene = scene_;
    scene.hand.depth_limit = std::numeric_limits<double>::infinity();
    session_ = make_core_evaluator(scene);
  }
  return rate(*session_, vessel_, grip, false);
}

// By the core: the best one, and the nearest ones of those that the device finds equally good. Nearness is measured from the present grip moved in,
// because from beside the vessel the way in would outweigh everything else.
std::vector<RatedGrip> Adviser::rate_best(const GripInput& present, const std::vector<GripInput>& cloud,
                                          std::vector<Found> found) const {
  std::vector<RatedGrip> rated;
  if (found.empty()) return rated;
  const auto by_effort = [](const Found& a, const Found& b) { return std::pair(a.effort, a.grip) < std::pair(b.effort, b.grip); };
  const Found best = *std::min_element(found.begin(), found.end(), by_effort);
  std::erase_if(found, [&](const Found& one) { return one.effort > like(best.effort) || one.grip == best.grip; });
  const auto way = [&](const Found& one) { return std::pair(way_between(present, cloud[one.grip]), one.grip); };
  const auto count = static_cast<std::ptrdiff_t>(std::min(RATED_BY_CORE, found.size()));
  std::partial_sort(found.begin(), found.begin() + count, found.end(),
                    [&](const Found& a, const Found& b) { return way(a) < way(b); });
  rated.push_back(rate_advised(cloud[best.grip]));
  for (std::ptrdiff_t k = 0; k < count; ++k) rated.push_back(rate_advised(cloud[found[static_cast<std::size_t>(k)].grip]));
  return rated;
}

// The last answer stays while it is as good as the present best; a present grip that is as good, or the only one, needs no advice.
void Adviser::choose(const std::vector<RatedGrip>& rated, Advice& advice) const {
  const RatedGrip* found = nearest_of_best(rated, advice.present.grip);
  if (!found && !advice.present.is_possible) return;
  RatedGrip best = found ? *found : advice.present;
  if (last_) {
    const RatedGrip before = rate_advised(*last_);
    double least = best.effort;
    for (const RatedGrip& one : rated)
      if (one.is_possible) least = std::min(least, one.effort);
    if (before.is_possible && before.effort <= like(least)) best = before;
  }
  advice.is_better = !advice.present.is_possible || advice.present.effort > like(best.effort);
  advice.best = advice.is_better ? best : advice.present;
  core_->grip(static_cast<std::size_t>(vessel_), advice.best->grip, advice.posed);
}

// The longer the best one stays, the closer to it the next updates search.
void Adviser::settle(bool has_moved) { share_ = has_moved ? WIDEST_SHARE : std::max(NARROWEST_SHARE, share_ * NARROWING); }

Advice Adviser::advise(const AdviceQuestion& question, std::size_t grips, const std::atomic<bool>* stop) {
  take_volume(question.vessel, question.volume);
  const Reach reach = reach_of(scene_.vessels[static_cast<std::size_t>(question.vessel)], question.grip, question.keeps_line);
  // if the azimuth changes nothing the hand turns freely, and the last answer with it
  if (last_) last_ = reach.with_kept(*last_);
  if (question.vessel != vessel_ || (last_ && !reach.has(*last_))) last_.reset();
  vessel_ = question.vessel;
  stands_ = !question.is_held;
  const std::vector<GripInput> cloud = grip_cloud(reach, question.grip, last_, share_, turn_++, grips);
  Advice advice;
  advice.vessel = question.vessel;
  advice.is_held = question.is_held;
  advice.volume = volumes_[static_cast<std::size_t>(question.vessel)];
  advice.grips = cloud.size();
  advice.present = rate_present(question.is_held ? question.grip : come_in(question.grip));
  choose(rate_best(advice.present.grip, cloud, ask(question.vessel, cloud, stop)), advice);
  std::optional<GripInput> best;
  if (advice.best) best = advice.best->grip;
  settle(!last_ || !best || way_between(*last_, *best) > MOVED);
  last_ = best;
  return advice;
}

}  // namespace wholehand::device
