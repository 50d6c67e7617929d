// SPDX-License-Identifier: MIT
// sanitizers: address
#include "evidence/trials/recording.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <filesystem>

#include "app/viewer/recording.h"
#include "core/meshes/vessel.h"
#include "core/reader/reader.h"
#include "core/vectors.h"
#include "device/recordings/recording.h"
#include "evidence/trials/output.h"
#include "tests/support/fake_trials.h"
#include "tests/support/files.h"
#include "tests/support/refusal.h"

namespace wholehand {
namespace {

constexpr double SAME_PLACE = 1e-12;  // m

// The shipped scene, whose vessels overlap.
Scene shipped_beakers() { return read_scene_file(std::string(WHOLEHAND_SOURCE_DIR) + "/examples/scenes/three_beakers.toml"); }

TrialGrip grip_of_flask() {
  TrialGrip grip;
  grip.vessel = 1;
  grip.grip.height = 0.06;
  grip.grip.obliquity = radians(10);
  grip.grip.roll = radians(-30);
  grip.grip.azimuth = radians(20);
  return grip;
}

// Gravity turns by 1 rad in 1 s, and the vessel falls from 0.5 s on.
std::vector<TrialTrack> falling_tracks(const Evaluator& core, const TrialGrip& grip) {
  GripResult result;
  core.grip(grip.vessel, grip.grip, result);
  EXPECT_EQ(result.reason, Reason::none);
  std::vector<TrialTrack> tracks(2);
  for (int k = 0; k <= 50; ++k) {
    TrialFrame frame;
    frame.time = 0.02 * k;
    frame.up = {std::sin(frame.time), std::cos(frame.time), 0};
    frame.joints = result.posed;
    if (k > 25) {
      frame.place = {0, -0.1 * (frame.time - 0.5), 0};
      frame.rotation = {std::cos(0.1), 0, std::sin(0.1), 0};  // 0.2 rad about y
    }
    tracks[k < 20 ? 0 : 1].frames.push_back(frame);
  }
  tracks[1].frames.insert(tracks[1].frames.begin(), tracks[0].frames.back());  // as of a track that begins where the last one ended
  return tracks;
}

TrialOutcome lost_after_half_a_second() {
  TrialOutcome outcome;
  outcome.reason = TrialReason::moved;
  outcome.when = 0.5;
  return outcome;
}

TEST(TrialRecording, TextOfOneVessel) {
  const Scene scene = shipped_beakers();
  for (std::size_t v = 0; v < 3; ++v) {
    const std::string text = text_of_one_vessel(scene, v);
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), std::count(scene.text.begin(), scene.text.end(), '\n'));
    const Scene one = parse_scene(text, "one.toml");
    ASSERT_EQ(one.vessels.size(), 1u);
    EXPECT_EQ(one.vessels[0].name, scene.vessels[v].name);
    EXPECT_EQ(one.liquid->fills, scene.liquid->fills);
  }
}

TEST(TrialRecording, ArraysAndOtherTablesStay) {
  Scene scene;
  scene.text =
      "[[vessel]]\nname = \"a\"\noutline = [\n{ line = [0.5e2, 0] },\n{ line = [50, 90] },\n{ line = [0, 90] },\n]\nguidance_mm = "
      "[\n[10, 20],\n]\n"
      "wall_mm = 2\n[[vessel]]\nname = \"b\"\nshape = \"cylinder\"\ndiameter_mm = 80\nheight_mm = 110\nwall_mm = 2\n"
      "[vessel.liquid]\nname = \"oil\"\nfill = 0.5\n[liquid]\nfills = [0, 1]\n[tilts]\ndeg = [0, 10]\n";
  scene.vessels = parse_scene(scene.text, "two.toml").vessels;
  const Scene a = parse_scene(text_of_one_vessel(scene, 0), ""), b = parse_scene(text_of_one_vessel(scene, 1), "");
  ASSERT_EQ(a.vessels.size(), 1u);
  EXPECT_EQ(a.vessels[0].guidance.size(), 1u);
  EXPECT_EQ(a.tilts.size(), 2u);
  ASSERT_EQ(b.vessels.size(), 1u);
  EXPECT_EQ(b.vessels[0].liquid_name, "oil");
}

TEST(TrialRecording, EachMomentOnce) {
  const Scene scene = shipped_beakers();
  const auto core = make_core_evaluator(scene);
  const auto frames = joined_frames(falling_tracks(*core, grip_of_flask()));
  ASSERT_EQ(frames.size(), 51u);
  for (std::size_t k = 1; k < frames.size(); ++k) EXPECT_GT(frames[k].time, frames[k - 1].time);
}

// Gravity is down in the world: what is up for the vessel becomes +y, and distances stay.
TEST(TrialRecording, WorldStandsUpright) {
  const Scene scene = shipped_beakers();
  const auto core = make_core_evaluator(scene);
  const TrialGrip grip = grip_of_flask();
  const auto frames = joined_frames(falling_tracks(*core, grip));
  const auto ticks = ticks_of_trial(scene, *core, grip, {}, lost_after_half_a_second(), frames, 1000);
  ASSERT_EQ(ticks.size(), frames.size());
  GripResult result;
  core->grip(grip.vessel, grip.grip, result);
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    const device::Tick& tick = ticks[k];
    EXPECT_EQ(tick.number, 20 * static_cast<std::int64_t>(k));
    // a right hand's first axis runs along the tips
    const auto along = to_mat3(tick.hand_rotation)[0], apart = to_vec3(tick.tips[1]) - to_vec3(tick.tips[0]);
    EXPECT_NEAR(glm::dot(along, apart), tick.gap, SAME_PLACE);
    EXPECT_NEAR(glm::determinant(to_mat3(tick.hand_rotation)), 1, SAME_PLACE);
    EXPECT_NEAR(distance(tick.tips[0], tick.vessel_place), distance(result.posed[THUMB_TIP], frames[k].place), SAME_PLACE);
    if (k <= 25) {
      EXPECT_NEAR(tick.tilt, frames[k].time, 1e-9);
    }
    EXPECT_EQ(tick.state == device::SessionState::slipped, k >= 25) << k;
  }
}

// The hand of the live session at these axes is the grip's hand.
void expect_hand_of_the_grip(const Scene& scene) {
  const TemporaryFolder folder;
  const auto core = make_core_evaluator(scene);
  const TrialGrip grip = grip_of_flask();
  const std::string path = folder / TrialFiles::recording_name(1);
  write_trial_recording(path, scene, *core, "stand-in", grip, {}, lost_after_half_a_second(), falling_tracks(*core, grip));
  device::Recording recording = device::read_recording(path);
  EXPECT_TRUE(recording.note.empty()) << recording.note;
  EXPECT_EQ(recording.ticks.size(), 51u);
  EXPECT_EQ(recording.info.device.name, "wholehand trials: stand-in");
  const Scene own = parse_scene(recording.info.scene_text, recording.info.scene_file);
  const device::Tick first = recording.ticks[0];
  const RecordingView view(own, std::move(recording));
  const auto frames = view.frames(0, 1, 50);
  ASSERT_EQ(frames.size(), 51u);
  GripResult result;
  core->grip(grip.vessel, grip.grip, result);
  double farthest = 0;
  for (int j = 0; j < JOINT_COUNT; ++j) {
    const Triple there = to_triple(to_vec3(first.vessel_place) + to_vec3(result.posed[j]));
    farthest = std::max(farthest, distance(frames[0].hand.posed[j], there));
  }
  EXPECT_LT(farthest, 1e-6) << "m, at most: the closure is solved for anew";
}

// A limit on the size of files stands for a full disk: it cuts the head, or the last tick.
TEST(TrialRecording, ADiskThatIsFullIsNamedAndNothingIsLeft) {
  const TemporaryFolder folder;
  const Scene scene = shipped_beakers();
  const auto core = make_core_evaluator(scene);
  const TrialGrip grip = grip_of_flask();
  const std::string path = folder / TrialFiles::recording_name(1);
  const auto write = [&] {
    write_trial_recording(path, scene, *core, "stand-in", grip, {}, lost_after_half_a_second(), falling_tracks(*core, grip));
  };
  write();
  const std::size_t whole = std::filesystem::file_size(path);
  std::filesystem::remove(path);
  struct rlimit before {};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto refused_at = [&](std::size_t bytes) {
    struct rlimit small = before;
    small.rlim_cur = bytes;
    EXPECT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    const std::string line = refusal_line(write, ExitCode::failure);
    setrlimit(RLIMIT_FSIZE, &before);
    return line;
  };
  EXPECT_EQ(refused_at(100), path + ": cannot record: File too large; make room, then go on with --resume");
  EXPECT_EQ(refused_at(whole - 1), "cannot write " + path + ": File too large; make room, then go on with --resume");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(TrialRecording, TheViewerShowsTheHandOfTheGrip) { expect_hand_of_the_grip(shipped_beakers()); }

TEST(TrialRecording, TheViewerShowsALeftHandToo) {
  expect_hand_of_the_grip(parse_scene("hand.handedness = \"left\"\n" + shipped_beakers().text, "left.toml"));
}

}  // namespace
}  // namespace wholehand
