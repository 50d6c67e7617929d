// SPDX-License-Identifier: MIT
#include "evidence/trials/recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <utility>

#include "base/system/version.h"
#include "base/text/error.h"
#include "core/mirror.h"
#include "core/reader/reader.h"
#include "core/vectors.h"
#include "device/recordings/recording.h"
#include "evidence/trials/output.h"
#include "sweeps/grips/report.h"

namespace wholehand {
namespace {

using core_f64::Mat3;
using core_f64::Vec3;

constexpr double TICK_RATE = 1000;  // Hz

// The name of a table's head, "vessel.liquid" of "[[vessel.liquid]]"; empty of any other line. Rows of an array begin with no
// letter.
std::string table_of(const std::string& line) {
  std::size_t at = line.find_first_not_of(" \t");
  if (at == std::string::npos || line[at] != '[') return "";
  at = line.find_first_not_of("[ \t", at);
  if (at == std::string::npos || !(std::isalpha(static_cast<unsigned char>(line[at])) || line[at] == '"')) return "";
  return line.substr(at, line.find_first_of("] \t", at) - at);
}

// Where the gripper's axes are in the frame of the grip: along the tips, and towards the index finger's side of the hand.
Mat3 gripper_axes(const GripInput& grip) {
  const double ca = std::cos(grip.azimuth), sa = std::sin(grip.azimuth), cb = std::cos(grip.obliquity),
               sb = std::sin(grip.obliquity);
  const Vec3 along(cb * ca, sb, -cb * sa);
  const Vec3 down = glm::normalize(Vec3(0, -1, 0) + along.y * along), side = glm::cross(along, down);
  const Vec3 little = std::cos(grip.roll) * down + std::sin(grip.roll) * side;
  return {along, -little, -glm::cross(along, little)};
}

// The shortest turn that takes a direction to +y.
Mat3 turn_to_up(const Vec3& up) {
  const Vec3 y(0, 1, 0), axis = glm::cross(up, y);
  const double sine = glm::length(axis), cosine = glm::dot(up, y);
  if (sine < 1e-12) return cosine > 0 ? Mat3(1) : Mat3(Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, -1));
  const Vec3 a = axis / sine;
  const Mat3 cross(Vec3(0, a.z, -a.y), Vec3(-a.z, 0, a.x), Vec3(a.y, -a.x, 0));  // columns
  return Mat3(1) + sine * cross + (1 - cosine) * cross * cross;
}

Mat3 matrix_of(const std::array<double, 4>& q) {
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  return {Vec3(1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)),
          Vec3(2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)),
          Vec3(2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y))};
}

// What does not change in the course of a trial.
device::Tick still_tick(const Scene& scene, const Evaluator& core, const TrialGrip& grip, const TrialCase& one,
                        const GripResult& result) {
  device::Tick tick;
  tick.vessel = 0;
  tick.closure = result.closure;
  tick.touch_mask = result.touch_mask;
  tick.used_mask = result.used_mask;
  tick.grasp_height = result.midpoint[1];
  tick.grasps = 1;
  const double tilt = one.protocol == TrialProtocol::fill_tilt ? one.tilt : 0;
  const LiquidResult liquid = scene.liquid ? core.liquid(grip.vessel, one.fill, tilt) : LiquidResult{};
  const StateResult state = core.state(grip.vessel, grip.grip, result, liquid, tilt);
  tick.volume[0] = liquid.volume;
  tick.weight = state.mass * scene.gravity;
  tick.torque = state.torque;
  tick.exact_torque = state.exact_torque;
  tick.normal_force = state.normal_force;
  tick.hold_force = state.hold_force;
  tick.feedback = tick.wanted.grip = tick.written.grip = state.feedback_force;  // what a gripper would render
  return tick;
}

device::RecordingInfo info_of_trial(const Scene& scene, const std::string& engine, const TrialGrip& grip, double gap) {
  const VesselData& vessel = scene.vessels[grip.vessel];
  device::RecordingInfo info;
  info.scene_name = scene.name;
  info.scene_file = scene.file;
  info.scene_text = text_of_one_vessel(scene, grip.vessel);
  info.version = version();
  info.rate = TICK_RATE;
  info.has_clock = false;
  info.device.name = TRIAL_DEVICE + engine;
  info.device.gap = {0, gap};
  info.device.rate = TICK_RATE;
  info.vessels = {{vessel.name, scene.liquid ? "liquid" : "", vessel.force_range.value_or(scene.force.range)}};
  info.force_base = scene.force.base;
  info.force_max = scene.force.max;
  return info;
}

// A recording on its way: gone before it begins, and gone however the writing ends.
class PartialFile {
 public:
  explicit PartialFile(std::string path) : path_(std::move(path)) { std::remove(path_.c_str()); }
  ~PartialFile() { std::remove(path_.c_str()); }
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;

 private:
  std::string path_;
};

}  // namespace

std::string text_of_one_vessel(const Scene& scene, std::size_t vessel) {
  std::string text;
  std::size_t seen = 0;
  bool is_kept = true;
  for (std::size_t at = 0; at < scene.text.size();) {
    const std::size_t end = std::min(scene.text.find('\n', at), scene.text.size());
    const std::string line = scene.text.substr(at, end - at), table = table_of(line);
    if (table == "vessel")
      is_kept = seen++ == vessel;
    else if (!table.empty() && !table.starts_with("vessel."))
      is_kept = true;
    if (is_kept) text += line;
    if (end < scene.text.size()) text += '\n';
    at = end + 1;
  }
  try {
    const Scene left = parse_scene(text, scene.file);
    if (left.vessels.size() == 1 && left.vessels[0].name == scene.vessels[vessel].name) return text;
  } catch (const Error&) {
    return "";
  }
  return "";
}

std::vector<TrialFrame> joined_frames(const std::vector<TrialTrack>& tracks) {
  std::vector<TrialFrame> frames;
  for (const TrialTrack& track : tracks)
    for (const TrialFrame& frame : track.frames)
      if (frames.empty() || frame.time > frames.back().time) frames.push_back(frame);
  return frames;
}

std::vector<device::Tick> ticks_of_trial(const Scene& scene, const Evaluator& core, const TrialGrip& grip, const TrialCase& one,
                                         const TrialOutcome& outcome, const std::vector<TrialFrame>& frames, double rate) {
  GripResult result;
  core.grip(grip.vessel, grip.grip, result);
  const VesselData& vessel = scene.vessels[grip.vessel];
  const device::Tick still = still_tick(scene, core, grip, one, result);
  const Vec3 pivot = to_vec3<double>(result.midpoint);
  const Vec3 over = to_vec3<double>(vessel.place) + pivot + Vec3(0, vessel.height - vessel.base, 0);
  const Handedness hand = scene.hand.handedness;
  const Mat3 axes = mirrored(gripper_axes(mirrored(grip.grip, hand)), hand);  // a left hand is a right one in a mirror
  std::vector<device::Tick> ticks;
  for (const TrialFrame& frame : frames) {
    const Mat3 turn = turn_to_up(glm::normalize(to_vec3<double>(frame.up)));
    const auto out = [&](const Triple& point) { return to_triple(over + turn * (to_vec3<double>(point) - pivot)); };
    device::Tick tick = still;
    tick.number = std::llround(frame.time * rate);
    if (!ticks.empty() && tick.number <= ticks.back().number) continue;
    tick.device.time = frame.time;
    tick.device.sequence = static_cast<std::uint32_t>(ticks.size() + 1);
    tick.tips = tick.proxies = {out(frame.joints[THUMB_TIP]), out(frame.joints[INDEX_TIP])};
    tick.middle = to_triple(0.5 * (to_vec3<double>(tick.tips[0]) + to_vec3<double>(tick.tips[1])));
    tick.gap = distance(tick.tips[0], tick.tips[1]);
    tick.device.gap = tick.gap;
    tick.hand_rotation = to_rotation(turn * axes);
    const Mat3 turned = turn * matrix_of(frame.rotation);
    tick.vessel_place = out(frame.place);
    tick.vessel_rotation = to_rotation(turned);
    tick.tilt = std::acos(std::clamp(turned[1].y, -1.0, 1.0));
    const bool is_lost = !outcome.held && frame.time >= outcome.when;
    tick.state = is_lost                  ? device::SessionState::slipped
                 : tick.tilt < radians(5) ? device::SessionState::lift
                                          : device::SessionState::maintain;
    tick.lost = is_lost ? 1 : 0;
    ticks.push_back(tick);
  }
  return ticks;
}

void write_trial_recording(const std::string& path, const Scene& scene, const Evaluator& core, const std::string& engine,
                           const TrialGrip& grip, const TrialCase& one, const TrialOutcome& outcome,
                           const std::vector<TrialTrack>& tracks) {
  const device::RecordingInfo info = info_of_trial(scene, engine, grip, core.gap_at(0));
  if (info.scene_text.empty()) throw usage_error("the scene's text does not stand without its other vessels");
  const std::vector<device::Tick> ticks = ticks_of_trial(scene, core, grip, one, outcome, joined_frames(tracks), TICK_RATE);
  const PartialFile partial(path + ".partial");
  device::RecordingWriter writer(path, info, "recording", TRIALS_REMEDY);
  const bool is_written = writer.append(ticks);
  if (writer.finish({}) && is_written) return;
  std::remove(path.c_str());  // a session keeps what the disk took; a trial can be written once more
  throw failure_error(fmt::format("cannot write {}: {}; {}", path, writer.reason(), TRIALS_REMEDY));
}

}  // namespace wholehand
