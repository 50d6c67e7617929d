// SPDX-License-Identifier: MIT
// Frames of a view as the page gets them: every field of docs/view.md, with its unit and frame, against the ticks that they come
// from.
// sanitizers: address
#include "app/viewer/frame.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/files/json.h"
#include "tests/support/live_script.h"

namespace wholehand {
namespace {

using nlohmann::json;

std::set<std::string> keys_of(const json& object) {
  std::set<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.insert(key);
  return keys;
}

// What the page has of a number: a float's digits.
bool is_seen(const json& value, double truth) { return value.is_number() && value.get<float>() == static_cast<float>(truth); }
void expect_seen(const json& list, const Triple& truth, const std::string& what) {
  ASSERT_EQ(list.size(), 3u) << what;
  for (int k = 0; k < 3; ++k)
    EXPECT_TRUE(is_seen(list[static_cast<std::size_t>(k)], truth[k])) << what << " " << list << " " << truth[k];
}

// The quaternion turns as the matrix does, to a few units of a float's 24 bits.
void expect_turned(const json& quaternion, const Rotation& r) {
  const double x = quaternion[0], y = quaternion[1], z = quaternion[2], w = quaternion[3];
  EXPECT_NEAR(1 - 2 * (y * y + z * z), r[0], 1e-6);
  EXPECT_NEAR(2 * (x * y - z * w), r[1], 1e-6);
  EXPECT_NEAR(2 * (x * z + y * w), r[2], 1e-6);
  EXPECT_NEAR(2 * (y * z - x * w), r[5], 1e-6);
}

struct Moment {
  device::Tick tick;
  device::VesselPoses poses;
};

// Ticks of a session that lifts, tilts, pours and loses a beaker, one of each state at least.
std::vector<Moment> moments(const Scene& scene) {
  LiveScript script;
  script.vessel = scene.vessels[0].place;
  device::Session session(scene, own_gap(scene.hand));
  std::vector<Moment> seen;
  for (std::int64_t n = 0; n < static_cast<std::int64_t>(script.seconds() * script.rate); ++n) {
    device::Tick tick;
    session.step(script.at(n), n, tick);
    tick.written.grip = 0.5 * tick.wanted.grip;
    if (n % 50 == 0) seen.push_back({tick, session.poses()});
  }
  return seen;
}

// One frame beside what it was made of.
struct Shown {
  const Scene& scene;
  const device::LiveScene& live;
  const device::Tick& tick;
  const device::VesselPoses& poses;
  const device::HandView& hand;
};

// Fields by their place in the frame (a JSON pointer): whole values ..
struct WholeField {
  const char* place;
  json (*truth)(const Shown&);
};

constexpr WholeField WHOLE_FIELDS[] = {
    {"/t", [](const Shown& s) { return json(static_cast<double>(s.tick.number) / s.scene.live.rate); }},
    {"/tick", [](const Shown& s) { return json(s.tick.number); }},
    {"/state", [](const Shown& s) { return json(device::SESSION_STATE_NAMES[static_cast<std::size_t>(s.tick.state)]); }},
    {"/vessel", [](const Shown& s) { return json(s.tick.vessel); }},
    {"/guidance", [](const Shown& s) { return json(s.tick.guidance); }},
    {"/done", [](const Shown& s) { return json(s.tick.task_done); }},
    {"/timing/missed", [](const Shown&) { return json(3); }},
};

// .. numbers, of which a frame has a float's digits ..
struct NumberField {
  const char* place;
  double (*truth)(const Shown&);
};

constexpr NumberField NUMBER_FIELDS[] = {
    {"/closure", [](const Shown& s) { return s.tick.closure; }},
    {"/gap", [](const Shown& s) { return s.tick.gap; }},
    {"/tilt", [](const Shown& s) { return s.tick.tilt; }},
    {"/forces/feedback", [](const Shown& s) { return s.tick.feedback; }},
    {"/forces/normal", [](const Shown& s) { return s.tick.normal_force; }},
    {"/forces/opening", [](const Shown& s) { return s.tick.opening_force; }},
    {"/forces/user", [](const Shown& s) { return s.tick.user_force; }},
    {"/forces/weight", [](const Shown& s) { return s.tick.weight; }},
    {"/forces/torque", [](const Shown& s) { return s.tick.torque; }},
    {"/forces/written", [](const Shown& s) { return s.tick.written.grip; }},
    {"/forces/base", [](const Shown& s) { return device::is_held(s.tick.state) ? s.scene.force.base : 0; }},
    {"/amounts/0/arrived", [](const Shown& s) { return s.tick.arrived[0]; }},
    {"/spilled", [](const Shown& s) { return s.tick.spilled[0] + s.tick.spilled[1]; }},
    {"/target_volume", [](const Shown& s) { return s.tick.arrived[0] + s.tick.arrived[1]; }},
    {"/timing/rate", [](const Shown&) { return 999.0; }},
    {"/timing/step", [](const Shown&) { return 4e-6; }},
};

// .. those that may be missing ..
struct OptionalField {
  const char* place;
  bool (*is_there)(const Shown&);
};

constexpr OptionalField OPTIONAL_FIELDS[] = {
    {"/forces/hold", [](const Shown& s) { return std::isfinite(s.tick.hold_force); }},
    {"/stream", [](const Shown& s) { return device::pouring_stream(s.live, s.tick, 0).has_value(); }},
};

// .. and objects by their keys.
struct KeysOf {
  const char* place;
  std::set<std::string> keys;
};

const std::vector<KeysOf> FRAME_KEYS{
    {"", {"t",   "tick", "state",   "vessel", "joints", "rigged",  "wrist",   "rigged_wrist",  "rotation", "contacts", "closure",
          "gap", "tilt", "vessels", "stream", "forces", "amounts", "spilled", "target_volume", "guidance", "done",     "timing"}},
    {"/forces", {"feedback", "written", "base", "normal", "opening", "user", "hold", "weight", "torque"}},
};

void expect_fields(const json& seen, const Shown& shown) {
  const auto at = [&](const char* place) { return seen.value(json::json_pointer(place), json("missing")); };
  for (const auto& [place, keys] : FRAME_KEYS) EXPECT_EQ(keys_of(at(place)), keys) << place;
  for (const auto& [place, truth] : WHOLE_FIELDS) EXPECT_EQ(at(place), truth(shown)) << place;
  for (const auto& [place, truth] : NUMBER_FIELDS)
    EXPECT_TRUE(is_seen(at(place), truth(shown))) << place << " " << at(place) << " " << truth(shown);
  for (const auto& [place, is_there] : OPTIONAL_FIELDS) EXPECT_EQ(at(place).is_null(), !is_there(shown)) << place;
}

void expect_hand(const json& seen, const Shown& shown) {
  const device::HandView& hand = shown.hand;
  ASSERT_EQ(seen["joints"].size(), static_cast<std::size_t>(JOINT_COUNT));
  ASSERT_EQ(seen["rigged"].size(), static_cast<std::size_t>(JOINT_COUNT));
  const std::string contacts = seen["contacts"];
  ASSERT_EQ(contacts.size(), static_cast<std::size_t>(JOINT_COUNT));
  for (std::size_t j = 0; j < JOINT_COUNT; ++j) {
    expect_seen(seen["joints"][j], hand.proxies[j], "joint " + std::to_string(j));
    expect_seen(seen["rigged"][j], hand.rigged[j], "rigged " + std::to_string(j));
    EXPECT_EQ(contacts[j], std::string(".tpkK")[static_cast<std::size_t>(hand.contact[j])]);
  }
  expect_seen(seen["wrist"], hand.wrist, "wrist");
  expect_seen(seen["rigged_wrist"], hand.rigged_wrist, "rigged wrist");
  expect_turned(seen["rotation"], shown.tick.hand_rotation);
}

void expect_vessels(const json& seen, const Shown& shown) {
  ASSERT_EQ(seen["vessels"].size(), shown.scene.vessels.size());
  for (std::size_t v = 0; v < shown.scene.vessels.size(); ++v) {
    const json& vessel = seen["vessels"][v];
    const device::VesselPose& pose = shown.poses[v];
    EXPECT_EQ(keys_of(vessel), (std::set<std::string>{"place", "rotation", "volume", "up", "level"}));
    expect_seen(vessel["place"], pose.place, "place");
    EXPECT_TRUE(is_seen(vessel["volume"], shown.tick.volume[v]));
    const device::LiveScene& live = shown.live;
    const auto surface = device::liquid_surface(live.vessels[v].vessel, live.quadrature, shown.tick.volume[v], pose.rotation);
    EXPECT_EQ(vessel["level"].is_null(), !surface.has_value());
    EXPECT_TRUE(!surface || is_seen(vessel["level"], surface->level));
    expect_seen(vessel["up"], {pose.rotation[3], pose.rotation[4], pose.rotation[5]}, "up");
    expect_turned(vessel["rotation"], pose.rotation);
  }
}

TEST(ViewFrame, TellsEveryFieldOfATick) {
  const Scene scene = live_scene();
  const device::LiveScene live(scene);
  FrameMaker maker(live);
  std::set<std::string> states;
  bool has_stream = false;
  for (const auto& [tick, poses] : moments(scene)) {
    SCOPED_TRACE("tick " + std::to_string(tick.number));
    const device::HandView hand = device::hand_view(live, tick, poses);
    const std::string text = frame_json(maker.make(tick, poses, hand, {999, 4e-6, 3}));
    EXPECT_EQ(text.find('\n'), std::string::npos);
    const json seen = parse_json(text);
    const Shown shown{scene, live, tick, poses, hand};
    expect_fields(seen, shown);
    expect_hand(seen, shown);
    expect_vessels(seen, shown);
    ASSERT_FALSE(HasFatalFailure());
    EXPECT_EQ(seen["amounts"].size(), 1u);
    states.insert(seen["state"]);
    if (const auto stream = device::pouring_stream(live, tick, 0)) {
      has_stream = true;
      expect_seen(seen["stream"]["from"], stream->from, "from");
      expect_seen(seen["stream"]["to"], stream->to, "to");
      EXPECT_TRUE(is_seen(seen["stream"]["flow"], stream->flow));
    }
  }
  EXPECT_TRUE(has_stream);
  for (const char* state : {"free", "lift", "tilt", "maintain", "slipped"}) EXPECT_TRUE(states.count(state)) << state;
}

void expect_pressed(const json& seen, const device::HandPress& press) {
  EXPECT_EQ(keys_of(seen), (std::set<std::string>{"digit", "place", "normal", "force"}));
  EXPECT_EQ(seen["digit"], press.digit);
  expect_seen(seen["place"], press.place, "place");
  expect_seen(seen["normal"], press.normal, "normal");
  expect_seen(seen["force"], press.force, "force");
}

// In a scene with strengths: what the whole hand takes, and the hold force of it.
TEST(ViewFrame, TellsWhatHoldingTakesOfTheHand) {
  Scene scene = live_scene();
  scene.strength.emplace();
  scene.strength->by_opening = false;
  const device::LiveScene live(scene);
  FrameMaker maker(live);
  int held = 0;
  for (const auto& [tick, poses] : moments(scene)) {
    SCOPED_TRACE("tick " + std::to_string(tick.number));
    const device::HandView hand = device::hand_view(live, tick, poses);
    const json seen = parse_json(frame_json(maker.make(tick, poses, hand, {})));
    ASSERT_EQ(seen.contains("holding"), device::is_held(tick.state));
    if (!device::is_held(tick.state)) {
      EXPECT_TRUE(seen["forces"]["hold"].is_null());
      continue;
    }
    ++held;
    const json& holding = seen["holding"];
    EXPECT_EQ(keys_of(holding), (std::set<std::string>{"effort", "effort_low", "tips_effort", "tips_hold", "contacts"}));
    EXPECT_TRUE(is_seen(holding["effort"], hand.hold->effort));
    EXPECT_TRUE(is_seen(holding["effort_low"], hand.hold->low));
    EXPECT_TRUE(is_seen(holding["tips_effort"], hand.hold->tips));
    EXPECT_TRUE(is_seen(holding["tips_hold"], 25 * hand.hold->tips)) << "the index finger is the weaker one";
    EXPECT_TRUE(is_seen(seen["forces"]["hold"], 25 * hand.hold->effort));
    ASSERT_EQ(holding["contacts"].size(), hand.hold->presses.size());
    for (std::size_t k = 0; k < hand.hold->presses.size(); ++k) expect_pressed(holding["contacts"][k], hand.hold->presses[k]);
  }
  EXPECT_GT(held, 20);
}

// Where vessels slide: margin, way, turn and speed of what is held, and nothing of them where sliding is off.
TEST(ViewFrame, TellsHowTheHeldVesselSlips) {
  Scene scene = live_scene();
  scene.live.slide = true;
  const device::LiveScene live(scene);
  FrameMaker maker(live);
  int slipped = 0;
  for (const auto& [tick, poses] : moments(scene)) {
    SCOPED_TRACE("tick " + std::to_string(tick.number));
    const json seen = parse_json(frame_json(maker.make(tick, poses, device::hand_view(live, tick, poses), {})));
    ASSERT_EQ(seen.contains("slip"), device::is_held(tick.state));
    if (!device::is_held(tick.state)) continue;
    EXPECT_EQ(keys_of(seen["slip"]), (std::set<std::string>{"margin", "distance", "angle", "speed"}));
    EXPECT_TRUE(is_seen(seen["slip"]["margin"], tick.safety_margin));
    EXPECT_TRUE(is_seen(seen["slip"]["distance"], tick.slip_distance));
    EXPECT_TRUE(is_seen(seen["slip"]["angle"], tick.slip_angle));
    EXPECT_TRUE(is_seen(seen["slip"]["speed"], tick.slip_speed));
    slipped += tick.slip_distance > 0;
  }
  EXPECT_GT(slipped, 2) << "the script's grip is too weak";
}

TEST(ViewFrame, WhatNoForceHoldsIsNull) {
  constexpr double INFINITE = std::numeric_limits<double>::infinity();
  ViewFrame frame;
  frame.hand.hold = device::HandHold{INFINITE, INFINITE, INFINITE, 25, {}};
  frame.hold = frame.hand.hold->force();
  const json seen = parse_json(frame_json(frame));
  EXPECT_EQ(seen["holding"], json({{"effort", nullptr},
                                   {"effort_low", nullptr},
                                   {"tips_effort", nullptr},
                                   {"tips_hold", nullptr},
                                   {"contacts", json::array()}}));
  EXPECT_TRUE(seen["forces"]["hold"].is_null());
  EXPECT_EQ(seen["forces"]["hold_infinite"], true);
}

TEST(ViewFrame, WhatIsNoNumberIsNull) {
  ViewFrame frame;
  frame.hold = std::numeric_limits<double>::infinity();
  frame.feedback = std::numeric_limits<double>::quiet_NaN();
  frame.vessels.resize(2);
  frame.vessels[1].is_shown = false;
  const json seen = parse_json(frame_json(frame));
  EXPECT_TRUE(seen["forces"]["hold"].is_null());
  EXPECT_EQ(seen["forces"]["hold_infinite"], true);
  frame.hold = device::Tick::NONE;
  EXPECT_FALSE(parse_json(frame_json(frame))["forces"].contains("hold_infinite")) << "there is none";
  EXPECT_TRUE(seen["forces"]["feedback"].is_null());
  EXPECT_TRUE(seen["forces"]["written"].is_null()) << "there is no gripper";
  EXPECT_TRUE(seen["vessels"][0]["level"].is_null());
  EXPECT_TRUE(seen["vessels"][1].is_null());
}

// What is kept of a vessel that rests is what would be found anew.
TEST(ViewFrame, AKeptSurfaceIsTheSame) {
  const Scene scene = live_scene();
  const device::LiveScene live(scene);
  FrameMaker kept(live);
  for (const auto& [tick, poses] : moments(scene)) {
    FrameMaker anew(live);
    const device::HandView hand = device::hand_view(live, tick, poses);
    EXPECT_EQ(frame_json(kept.make(tick, poses, hand, {})), frame_json(anew.make(tick, poses, hand, {})));
  }
}

}  // namespace
}  // namespace wholehand
