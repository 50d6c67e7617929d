// SPDX-License-Identifier: MIT
#include "device/simulated/sim_user.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/gtc/matrix_transform.hpp>

#include "base/text/error.h"
#include "core/evaluator.h"
#include "core/held.h"
#include "core/mirror.h"
#include "core/prepare.h"
#include "core/vectors.h"

namespace wholehand::device {

using core_f64::Vec3;

namespace {

// How a person moves: durations of ours, in s, and lengths in m, but for the paper's tilting time.
constexpr double REACH_TIME = 0.9, LOOK_TIME = 0.6, ENTER_TIME = 0.5, CLOSE_TIME = 0.9, SETTLE_TIME = 0.8, LIFT_TIME = 0.8,
                 CARRY_TIME = 1.2;
constexpr double TILT_TIME = 3.6, MAINTAIN_TIME = 1.5, UPRIGHT_TIME = 1.2, LOWER_TIME = 0.9, OPEN_TIME = 0.5, WITHDRAW_TIME = 0.5;
constexpr double SHOWN_TILT = radians(75);
constexpr double LIFT = 0.12, APART = 0.12;  // height of lifting; distance from which the hand goes in
constexpr double SQUEEZE = 8e-3;             // m that the fingers aim inside of the vessel
constexpr double TILT_SPEED = radians(25);   // rad/s, the paper's 90 degrees in 3.6 s
constexpr double QUICKEST_FLOW = 25e-6;      // m3/s that a person pours when there is much to pour
constexpr double POUR_AHEAD = 0.8;           // s: how far before the amount is there the flow is made less
constexpr double FLOW_BAND = 100e-6;         // m3/s of difference for the whole tilting speed
constexpr double LONGEST_POUR = 40;          // s, however much still runs
constexpr double LOOKS = 0.3;                // s before a vessel that slipped is seen to
constexpr double CLEAR = 0.28;               // over the other vessels, on the way to the next
constexpr int ATTEMPTS = 3;

constexpr int FIRST_ROLL = -60, LAST_ROLL = 30, ROLL_STEP = 15;  // degrees

// The best-scoring grip of a vessel among heights and rolls, or at a given height; false: none is feasible.
bool choose_grip(const Scene& scene, const Evaluator& evaluator, std::size_t v, std::size_t task, SimJob& job) {
  const VesselData& vessel = scene.vessels[v];
  std::vector<double> heights;
  if (!vessel.guidance.empty()) heights.push_back(vessel.guidance[task % vessel.guidance.size()].height);
  const std::size_t guided = heights.size();
  for (int k = 1; k < 20; ++k) heights.push_back(vessel.base + (vessel.height - vessel.base) * k / 20);
  std::optional<ChosenGrip> best;
  for (std::size_t k = 0; k < heights.size(); ++k) {
    if (k == guided && best) break;  // the guidance point's height it is
    GripInput grip;
    grip.height = heights[k];
    // in the world of a left hand the palm faces away where the line runs the other way
    if (scene.hand.handedness == Handedness::left) grip.azimuth = PI;
    const std::optional<ChosenGrip> found = best_roll(evaluator, v, grip);
    if (found && (!best || found->score > best->score)) best = found;
  }
  if (!best) return false;
  job.grip = best->grip;
  job.grip.azimuth = 0;
  job.gap = best->result.gap;
  if (job.kind == SimJob::Kind::pour) job.path = PourPath(*scene.task, vessel, scene.hand, job.grip, best->result);
  return true;
}

}  // namespace

std::optional<ChosenGrip> best_roll(const Evaluator& evaluator, std::size_t vessel, const GripInput& grip) {
  std::optional<ChosenGrip> best;
  for (int roll = FIRST_ROLL; roll <= LAST_ROLL; roll += ROLL_STEP) {
    ChosenGrip one{grip, {}, 0};
    one.grip.roll = radians(roll);
    evaluator.grip(vessel, one.grip, one.result);
    if (one.result.reason != Reason::none || one.result.grazing) continue;
    one.score =
        evaluator.score(vessel, one.grip, one.result).score + (one.result.antipodal ? 1 : 0) + (one.result.plausible ? 1 : 0);
    if (!best || one.score > best->score) best = one;
  }
  return best;
}

std::vector<SimJob> plan_sim_jobs(const Scene& scene) {
  Scene bare = scene;
  bare.arm.reset();  // the user goes to the vessel's place
  const std::unique_ptr<Evaluator> evaluator = make_core_evaluator(bare);
  std::vector<SimJob> jobs;
  auto wanted = scene.task ? scene.task->amounts : std::vector<std::pair<std::string, double>>{};
  bool is_tutored = false;
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    const VesselData& vessel = scene.vessels[v];
    SimJob job;
    job.vessel = static_cast<int>(v);
    if (scene.task && vessel.liquid_name.empty()) {
      if (is_tutored) continue;
      is_tutored = true;
      job.kind = SimJob::Kind::carry;
    } else if (scene.task) {
      const auto entry = std::find_if(wanted.begin(), wanted.end(), [&](const auto& w) { return w.first == vessel.liquid_name; });
      if (entry == wanted.end() || !(entry->second > 0)) continue;
      job.kind = SimJob::Kind::pour;
      job.amount = std::min(entry->second, vessel.liquid_fill * evaluator->capacity(v));
      entry->second -= job.amount;
    }
    jobs.push_back(job);
  }
  // what is carried comes first: the tutorial
  std::stable_partition(jobs.begin(), jobs.end(), [](const SimJob& job) { return job.kind == SimJob::Kind::carry; });
  std::vector<SimJob> possible;
  for (SimJob& job : jobs)
    if (choose_grip(scene, *evaluator, job.vessel, possible.size(), job)) possible.push_back(job);
  if (possible.empty())
    throw usage_error(at_place(
        scene.file, "the simulated user finds nothing to do: no vessel that the hand can hold with its palm away from the user"));
  return possible;
}

core_f64::Mat3 SimCommand::rotation() const noexcept {
  const auto about = [](int axis, double angle) {
    Vec3 unit(0);
    unit[axis] = 1;
    return core_f64::Mat3(glm::rotate(glm::dmat4(1), angle, unit));
  };
  return about(1, azimuth) * about(0, -tilt) * about(2, obliquity) * about(0, roll);
}

SimUser::SimUser(const LiveScene& live, std::vector<SimJob> jobs, const Participant& person)
    : live_(live), jobs_(std::move(jobs)), person_(person) {
  next_grasp();
  const double open = live.hand.scale * live.hand.gap_open;
  home_ = live.vessels[jobs_.front().vessel].home + Vec3(0, 0.2, 0.3);
  command_.middle = home_;
  command_.gap = open;
  begin(Phase::reach);
  command_.roll = roll_from_ = roll_to_;
  command_.azimuth = azimuth_from_ = azimuth_to_;
  command_.obliquity = obliquity_from_ = obliquity_to_;
}

// A new try, with the person's guess of the vessel.
void SimUser::next_grasp() noexcept {
  traits_ = person_.grasp(static_cast<std::uint64_t>(++grasp_));
  const LiveVessel& vessel = live_.vessels[job().vessel];
  const double density = live_.scene.liquid ? live_.scene.liquid->density : 0;
  weight_ = vessel.force.gravity * core_f64::load_with(vessel.vessel, density * vessel.volume, 0, 0).mass;
  load_ = caught_ = catching_ = 0;
}

// The grip follows what opens the fingers, and a weight above the expected one, over the response time. A felt slip raises it to what holding takes
// with the person's margin, and it stays there (Johansson and Westling 1987).
void SimUser::follow_load(const SimSense& sense, double seconds) noexcept {
  const double surplus = std::max(0.0, sense.weight - traits_[Trait::weight_guess] * weight_);
  const double rise = sense.load + surplus / (2 * traits_[Trait::friction]);
  // nine tenths and a half of a step within the response
  const double share = -std::expm1(-3 * seconds / traits_[Trait::response]), most = largest_force(traits_);
  load_ += (rise - load_) * share;
  const double loaded = loaded_force(traits_, first_force(traits_, weight_), load_);
  if (sense.holding > 0) caught_ = std::max(caught_, std::min(sense.holding / (1 - traits_[Trait::margin]), most));
  catching_ += (std::max(0.0, caught_ - loaded) - catching_) * share;
  command_.force = std::clamp(loaded + catching_, 0.0, most);
}

// Takes the grip shown for the job's vessel from now on, also in further tries. The person's aim is as good or bad as at any other.
void SimUser::take_shown_grip() noexcept {
  if (shown_.vessel != job().vessel) return;
  SimJob& own = jobs_[static_cast<std::size_t>(job_)];
  own.grip = shown_.grip;
  own.gap = shown_.gap;
  own.path = shown_.path;
}

// Middle of the tips while the vessel pours. A higher grasp moves the middle up the vessel; the vessel stays where it is.
Vec3 SimUser::on_path(double tilt) const noexcept {
  const double up = traits_[Trait::height];
  return job().path.middle(tilt) + up * Vec3(0, std::cos(tilt), -std::sin(tilt));
}

// How high the vessel is lifted off its support; higher before it goes to a target.
double SimUser::lift() const noexcept {
  if (job().kind != SimJob::Kind::pour) return LIFT;
  return std::max(LIFT, job().path.middle(0).y - (live_.vessels[job().vessel].home.y + job().grip.height));
}

void SimUser::move(Vec3 to, double seconds) noexcept {
  from_ = command_.middle;
  to_ = to;
  lasts_ = seconds;
}

void SimUser::begin(Phase phase) noexcept {
  phase_ = phase;
  time_ = 0;
  from_ = to_ = command_.middle;
  gap_from_ = gap_to_ = command_.gap;
  tilt_from_ = tilt_to_ = command_.tilt;
  roll_from_ = command_.roll;
  roll_to_ = job().grip.roll + traits_[Trait::roll];
  azimuth_from_ = command_.azimuth;
  obliquity_from_ = command_.obliquity;
  // a user who pours turns the vessel towards the target on the way there
  const bool is_poured = job().kind == SimJob::Kind::pour && phase >= Phase::carry && phase <= Phase::open;
  azimuth_to_ = is_poured ? 0 : traits_[Trait::azimuth];
  obliquity_to_ = job().grip.obliquity + traits_[Trait::obliquity];
  has_run_ = false;
  plan_motion();
}

// Where the middle of the tips goes.
Vec3 SimUser::set_down_at() const noexcept {
  const Vec3 destination = live_.scene.task ? live_.mirror.in(live_.scene.task->destination) : Vec3(0);
  const Vec3 place = job().kind == SimJob::Kind::carry ? destination : live_.vessels[job().vessel].home;
  return place + Vec3(0, job().grip.height + traits_[Trait::height], 0);
}

// The phases in which jobs differ; a job without one skips it.
void SimUser::plan_job() noexcept {
  const bool shows = job().kind == SimJob::Kind::show, pours = job().kind == SimJob::Kind::pour;
  const bool carries = job().kind == SimJob::Kind::carry;
  lasts_ = 0;
  if (phase_ == Phase::carry && pours) move(on_path(0), CARRY_TIME);
  if (phase_ == Phase::carry && carries) move(set_down_at() + Vec3(0, LIFT, 0), CARRY_TIME);
  if (phase_ == Phase::tilt && shows) tilt_to_ = SHOWN_TILT;
  if (phase_ == Phase::tilt && !carries) lasts_ = shows ? TILT_TIME : LONGEST_POUR;
  if (phase_ == Phase::maintain && shows) lasts_ = MAINTAIN_TIME;
}

// Where the phase ends, and how long it lasts.
void SimUser::plan_motion() noexcept {
  const double open = live_.hand.scale * live_.hand.gap_open;
  const Vec3 taken = live_.vessels[job().vessel].home + Vec3(0, job().grip.height + traits_[Trait::height], 0);
  const double azimuth = traits_[Trait::azimuth];
  const Vec3 put = set_down_at();
  switch (phase_) {
    case Phase::reach:
      move(taken + APART * Vec3(std::sin(azimuth), 0, std::cos(azimuth)), REACH_TIME);
      gap_to_ = open;
      tilt_to_ = 0;
      break;
    case Phase::look:
      lasts_ = LOOK_TIME;
      break;
    case Phase::enter:
      move(taken, ENTER_TIME);
      break;
    case Phase::close:
      gap_to_ = std::max(live_.hand.scale * live_.hand.gap_closed, job().gap - SQUEEZE);
      lasts_ = CLOSE_TIME;
      break;
    case Phase::settle:
      lasts_ = SETTLE_TIME;
      break;
    case Phase::lift:
      move(command_.middle + Vec3(0, lift(), 0), LIFT_TIME * lift() / LIFT);
      break;
    case Phase::carry:
    case Phase::tilt:
    case Phase::maintain:
      plan_job();
      break;
    case Phase::upright:
      lasts_ = command_.tilt > 0 ? UPRIGHT_TIME : 0;
      tilt_to_ = 0;
      break;
    case Phase::back:
      move(put + Vec3(0, lift(), 0), CARRY_TIME);
      break;
    case Phase::lower:
      move(put, LOWER_TIME * lift() / LIFT);
      break;
    case Phase::open:
      gap_to_ = open;
      lasts_ = OPEN_TIME;
      break;
    case Phase::withdraw:
      move(command_.middle + Vec3(0, CLEAR, APART), WITHDRAW_TIME);
      break;
  }
}

// Tilts until it runs, then adapts the flow to what is missing; upright again when the amount is reached.
void SimUser::pour(const SimSense& sense, double seconds) noexcept {
  const double missing = job().amount - sense.arrived;
  const double flow = std::clamp(missing / POUR_AHEAD, 0.0, QUICKEST_FLOW);
  has_run_ = has_run_ || sense.flow > 0;
  const double speed = has_run_ ? TILT_SPEED * std::clamp((flow - sense.flow) / FLOW_BAND, -1.0, 1.0) : TILT_SPEED;
  command_.tilt = std::clamp(command_.tilt + speed * seconds, 0.0, SIM_LARGEST_TILT);
  command_.middle = on_path(command_.tilt);
  idle_ = sense.flow > 0 || command_.tilt < SIM_LARGEST_TILT ? 0 : idle_ + seconds;
  if (missing <= 0.3 * live_.scene.task->tolerance || idle_ > traits_[Trait::patience]) time_ = lasts_;
}

SimCommand SimUser::next(const SimSense& sense, double seconds) noexcept {
  if (is_done()) return command_;
  time_ += seconds;
  const bool should_hold = phase_ >= Phase::settle && phase_ < Phase::open;
  if (should_hold && time_ > LOOKS && is_returning(sense.state)) fail();
  const double part = lasts_ > 0 ? time_ / lasts_ : 1;
  const Vec3 before = command_.middle;
  const double gap_before = command_.gap;
  const bool pours = job().kind == SimJob::Kind::pour;
  if (phase_ == Phase::tilt && pours) {
    pour(sense, seconds);
  } else {
    command_.middle = from_ + minimum_jerk(part) * (to_ - from_);
    command_.tilt = tilt_from_ + minimum_jerk(part) * (tilt_to_ - tilt_from_);
    if (phase_ == Phase::upright && pours) command_.middle = on_path(command_.tilt);
  }
  command_.roll = roll_from_ + minimum_jerk(part) * (roll_to_ - roll_from_);
  command_.azimuth = azimuth_from_ + minimum_jerk(part) * (azimuth_to_ - azimuth_from_);
  command_.obliquity = obliquity_from_ + minimum_jerk(part) * (obliquity_to_ - obliquity_from_);
  command_.gap = command_.grips_by_force ? sense.gap : gap_from_ + minimum_jerk(part) * (gap_to_ - gap_from_);
  command_.velocity = (command_.middle - before) / seconds;
  command_.gap_speed = (command_.gap - gap_before) / seconds;
  const bool feels = phase_ == Phase::close && is_held(sense.state) && sense.felt > FELT;
  if (feels) command_.grips_by_force = true;
  follow_load(sense, seconds);
  if (feels || time_ >= lasts_) go_on(feels);
  return command_;
}

// The attempt failed: lets go, leaves, and begins again.
void SimUser::fail() noexcept {
  has_failed_ = true;
  command_.grips_by_force = false;
  begin(Phase::open);
  tilt_to_ = 0;
}

void SimUser::go_on(bool feels) noexcept {
  if (phase_ == Phase::close && !feels) {
    if (time_ > 2 * CLOSE_TIME) fail();
    return;
  }
  if (phase_ == Phase::lower) command_.grips_by_force = false;
  if (phase_ == Phase::look) take_shown_grip();
  if (phase_ == Phase::reach && !follows_) {
    begin(Phase::enter);
    return;
  }
  if (phase_ != Phase::withdraw) {
    begin(static_cast<Phase>(static_cast<int>(phase_) + 1));
    return;
  }
  const bool again = has_failed_ && ++attempts_ < ATTEMPTS;
  if (has_failed_ && !again) ++abandoned_;
  has_failed_ = false;
  if (!again) {
    attempts_ = 0;
    ++job_;
  }
  if (is_done()) return;
  next_grasp();
  begin(Phase::reach);
}

}  // namespace wholehand::device
