// SPDX-License-Identifier: MIT
// Advice as the page and engines get it: words, efforts, and a ghost whose joints are those of the advised grip on its vessel.
// sanitizers: address
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "app/viewer/frame.h"
#include "base/files/json.h"
#include "core/vectors.h"
#include "device/advice/moment.h"
#include "device/advice/words.h"
#include "tests/support/advised_session.h"
#include "tests/support/osc_listener.h"

namespace wholehand {
namespace {

// A hand that is advised to go elsewhere: the last tick before a grasp that is too high.
struct Advised {
  Advised() : scene(advised_session_scene()), live(scene) {
    LiveScript script = script_for(scene);
    script.height = 0.09;
    const std::vector<device::Tick> record = play_session(scene, script);
    tick = record[last_free_tick(record)];
    poses = device::VesselTracker(scene).poses();
    poses[0].place = {0.3, 0.02, -0.1};  // off the origin, and turned: a forgotten pose shows
    poses[0].rotation = turned('y', 0.4);
    device::Adviser adviser(scene, "core", 1);
    advice = device::advice_of(live, tick, device::VesselTracker(scene).poses(), adviser, 1024);
  }
  Scene scene;
  device::LiveScene live;
  device::Tick tick;
  device::VesselPoses poses;
  device::Advice advice;
};

Triple out(const device::VesselPose& pose, const Triple& p) {
  return to_triple(to_vec3(pose.place) + to_mat3(pose.rotation) * to_vec3(p));
}

TEST(Ghost, IsTheAdvisedHandOnItsVessel) {
  const Advised one;
  ASSERT_TRUE(one.advice.best && one.advice.is_better);
  const auto ghost = ghost_of(one.scene, one.advice, one.poses);
  ASSERT_TRUE(ghost);
  for (std::size_t j = 0; j < ghost->joints.size(); ++j)
    EXPECT_LT(distance(ghost->joints[j].place, out(one.poses[0], one.advice.posed.posed[j])), 1e-12);
  device::Advice good = one.advice;
  good.is_better = false;
  EXPECT_FALSE(ghost_of(one.scene, good, one.poses));
  EXPECT_FALSE(ghost_of(one.scene, {}, one.poses));
}

TEST(ViewFrame, TellsTheAdvice) {
  const Advised one;
  ViewFrame frame = FrameMaker(one.live).make(one.tick, one.poses, {}, {});
  EXPECT_FALSE(parse_json(frame_json(frame)).contains("advice"));
  frame.advice = frame_advice(one.scene, one.advice, one.poses);
  const nlohmann::json advice = parse_json(frame_json(frame))["advice"];
  EXPECT_EQ(advice["vessel"], 0);
  EXPECT_EQ(advice["words"], device::advice_words(one.advice));
  EXPECT_EQ(advice["to"].get<float>(), static_cast<float>(one.advice.best->effort));
  ASSERT_EQ(advice["joints"].size(), 24u);
  EXPECT_EQ(advice["joints"][8][0].get<float>(), static_cast<float>(frame.advice->ghost->joints[8].place[0]));
  EXPECT_EQ(advice["wrist"][1].get<float>(), static_cast<float>(frame.advice->ghost->wrist.place[1]));
  device::Advice impossible = one.advice;
  impossible.present.is_possible = false;
  impossible.is_better = false;
  frame.advice = frame_advice(one.scene, impossible, one.poses);
  const nlohmann::json other = parse_json(frame_json(frame))["advice"];
  EXPECT_TRUE(other["from"].is_null());
  EXPECT_FALSE(other.contains("joints"));
}

TEST(OscStream, SendsTheAdvice) {
  const Advised one;
  OscListener listener;
  OscStream stream(listener.target(), one.live);
  const device::HandView hand = device::hand_view(one.live, one.tick, one.poses);
  const device::DisplayTiming timing;
  const auto sent = [&](const device::Advice* advice) {
    stream.show({one.tick, one.poses, hand, timing, advice});
    std::map<std::string, OscMessage> found;
    for (const OscMessage& message : listener.frame())
      if (message.address.find("/advice/") != std::string::npos) found.emplace(message.address, message);
    return found;
  };
  EXPECT_TRUE(sent(nullptr).empty());
  auto messages = sent(&one.advice);
  EXPECT_EQ(text(messages.at("/wholehand/advice/words")), device::advice_words(one.advice));
  EXPECT_EQ(whole(messages.at("/wholehand/advice/vessel")), 0);
  EXPECT_EQ(text(messages.at("/wholehand/advice/vessel"), 1), one.scene.vessels[0].name);
  EXPECT_EQ(whole(messages.at("/wholehand/advice/better")), 1);
  EXPECT_EQ(number(messages.at("/wholehand/advice/effort"), 1), static_cast<float>(one.advice.best->effort));
  EXPECT_EQ(number(messages.at("/wholehand/advice/grip"), 3), static_cast<float>(one.advice.best->grip.roll));
  const auto ghost = ghost_of(one.scene, one.advice, one.poses);
  const OscMessage& wrist = messages.at("/wholehand/advice/joint/XR_HAND_JOINT_WRIST_EXT");
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(number(wrist, k), static_cast<float>(ghost->wrist.place[k]));
  EXPECT_EQ(messages.size(), 5u + 25u);
  // no vessel is near: the messages say that there is no advice
  messages = sent(std::make_unique<device::Advice>().get());
  EXPECT_EQ(messages.size(), 3u);
  EXPECT_EQ(whole(messages.at("/wholehand/advice/vessel")), -1);
}

}  // namespace
}  // namespace wholehand
