// SPDX-License-Identifier: MIT
#include "device/grippers/haply_messages.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "core/vectors.h"

namespace wholehand::device::haply {
namespace {

// As in Haply's documentation of the protocol (docs/devices.md), shortened.
constexpr const char* INVENTORY = R"({"session_id": 7, "inverse3": [
  {"device_id": "049D", "config": {"type": "inverse3", "handedness": "right", "basis": {"permutation": "XYZ"}},
   "state": {"cursor_position": {"x": 0.0, "y": -0.12, "z": 0.15}}, "status": {"ready": true}},
  {"device_id": "04BA", "config": {}}], "verse_grip": [{"device_id": "61576"}], "wireless_verse_grip": [{"device_id": "0B01"}]})";

std::string state_with(const std::string& cursor, const std::string& grip = "") {
  return R"({"inverse3":[{"device_id":"other","state":{}},{"device_id":"A","state":{"cursor_position":)" + cursor + R"(}}])" +
         (grip.empty() ? "" : R"(,"wireless_verse_grip":[{"device_id":"G","state":)" + grip + "}]") + "}";
}

const Devices ONE{{"A", ""}, ""}, WITH_GRIP{{"A", ""}, "G"};
constexpr const char* CURSOR = R"({"x":1,"y":-2.5,"z":3e-3})";

TEST(HaplyMessages, AnInventoryNamesTheDevicesAndTheirSides) {
  Inventory found;
  ASSERT_EQ(read_inventory(INVENTORY, found), nullptr);
  ASSERT_EQ(found.arms.size(), 2u);
  EXPECT_EQ(found.arms[0].id, "049D");
  EXPECT_EQ(found.arms[0].handedness, "right");
  EXPECT_EQ(found.arms[1].id, "04BA");
  EXPECT_EQ(found.arms[1].handedness, "");
  EXPECT_EQ(found.grips, (std::vector<std::string>{"61576", "0B01"}));
  EXPECT_FALSE(found.is_old);
  ASSERT_EQ(read_inventory(R"({"inverse3": {"049D": {}}})", found), nullptr);
  EXPECT_TRUE(found.is_old);
  EXPECT_TRUE(found.arms.empty()) << "nothing is left of the one before";
  ASSERT_EQ(read_inventory(R"({"inverse3": []})", found), nullptr);
  EXPECT_FALSE(found.is_old);
}

TEST(HaplyMessages, AnInventoryThatIsNoneIsReported) {
  Inventory found;
  for (const char* text : {"", "[]", "null", "{", "\"inverse3\"", "\xff\xfe"})
    EXPECT_STREQ(read_inventory(text, found), "a message that is not a JSON object") << text;
  EXPECT_STREQ(read_inventory("{}", found), "an inventory without `inverse3`");
  EXPECT_STREQ(read_inventory(R"({"inverse3": 3})", found), "an inventory whose `inverse3` is not a list");
  for (const char* device : {"3", "{}", R"({"device_id": 3})", R"({"device_id": ""})"})
    EXPECT_STREQ(read_inventory(std::string(R"({"inverse3": [)") + device + "]}", found), "an Inverse3 without `device_id`")
        << device;
}

TEST(HaplyMessages, AStateIsThatOfTheOwnDevices) {
  Measurement found;
  ASSERT_EQ(read_measurement(state_with(CURSOR), ONE, found), nullptr);
  EXPECT_EQ(found.cursors[0], (Triple{1, -2.5, 3e-3}));
  const std::string both = R"({"inverse3":[{"device_id":"B","state":{"cursor_position":{"x":4,"y":5,"z":6}}},
    {"device_id":"A","state":{"cursor_position":{"x":1,"y":2,"z":3}}}]})";
  ASSERT_EQ(read_measurement(both, {{"A", "B"}, ""}, found), nullptr);
  EXPECT_EQ(found.cursors, (std::array<Triple, 2>{{{1, 2, 3}, {4, 5, 6}}}));
  EXPECT_STREQ(read_measurement(both, {{"A", "C"}, ""}, found), "a state without the right Inverse3");
  EXPECT_STREQ(read_measurement(both, {{"C", "B"}, ""}, found), "a state without the first Inverse3");
}

TEST(HaplyMessages, AGripHasAnOrientationAndButtons) {
  Measurement found;
  ASSERT_EQ(read_measurement(
                state_with(CURSOR, R"({"orientation":{"w":0.8,"x":0,"y":-0.6,"z":0},"buttons":{"a":false,"b":true,"c":true}})"),
                WITH_GRIP, found),
            nullptr);
  EXPECT_DOUBLE_EQ(found.orientation[0], 0.8);
  EXPECT_DOUBLE_EQ(found.orientation[2], -0.6);
  EXPECT_EQ(found.buttons, 6u);
  // a wired one has one button, and lengths are rounded
  const std::string wired = R"({"inverse3":[{"device_id":"A","state":{"cursor_position":{"x":1,"y":2,"z":3}}}],"verse_grip":[
    {"device_id":"G","state":{"orientation":{"w":0.707,"x":0.707,"y":0,"z":0},"button":true}}]})";
  ASSERT_EQ(read_measurement(wired, WITH_GRIP, found), nullptr);
  EXPECT_EQ(found.buttons, 1u);
  EXPECT_NEAR(found.orientation[0], std::sqrt(0.5), 1e-15);
  EXPECT_STREQ(read_measurement(state_with(CURSOR), WITH_GRIP, found), "a state without the VerseGrip");
  for (const char* grip : {"{}", R"({"orientation":{"w":1,"x":0,"y":0}})", R"({"orientation":{"w":1,"x":0,"y":0,"z":"0"}})"})
    EXPECT_STREQ(read_measurement(state_with(CURSOR, grip), WITH_GRIP, found), "an orientation that is not four numbers") << grip;
  EXPECT_STREQ(read_measurement(state_with(CURSOR, R"({"orientation":{"w":0,"x":0,"y":0,"z":0}})"), WITH_GRIP, found),
               "an orientation whose length is not 1");
}

TEST(HaplyMessages, NoMessageThatLacksAFiniteNumberIsAState) {
  Measurement found;
  for (const char* cursor : {"{}", "null", "[1,2,3]", R"({"x":1,"y":2})", R"({"x":1,"y":2,"z":null})", R"({"x":1,"y":2,"z":"3"})",
                             R"({"x":1,"y":2,"z":true})"})
    EXPECT_STREQ(read_measurement(state_with(cursor), ONE, found), "a cursor position that is not three numbers") << cursor;
  for (const char* number : {"NaN", "nan", "Infinity", "1e999", "-1e999", "0x1", "1."})
    EXPECT_NE(read_measurement(state_with(std::string(R"({"x":1,"y":2,"z":)") + number + "}"), ONE, found), nullptr) << number;
  // each beginning of a state, and each state with one byte of it replaced, is read or refused
  const std::string whole = state_with(CURSOR, R"({"orientation":{"w":1,"x":0,"y":0,"z":0},"buttons":{"a":true}})");
  ASSERT_EQ(read_measurement(whole, WITH_GRIP, found), nullptr);
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_STREQ(read_measurement(whole.substr(0, size), WITH_GRIP, found), "a message that is not a JSON object") << size;
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const char byte : {'\0', '"', '{', ']', '9', 'e', '\xff'}) {
      std::string wrong = whole;
      wrong[at] = byte;
      if (read_measurement(wrong, WITH_GRIP, found)) continue;
      EXPECT_TRUE(std::isfinite(norm(found.cursors[0]))) << wrong;
    }
  }
}

TEST(HaplyMessages, ADeepMessageIsRefusedLikeAnyOther) {
  Measurement found;
  EXPECT_NE(read_measurement(std::string(100000, '['), ONE, found), nullptr);
  EXPECT_NE(read_measurement(R"({"inverse3":)" + std::string(50000, '[') + std::string(50000, ']') + "}", ONE, found), nullptr);
}

TEST(HaplyMessages, AVersionIsTwoNumbers) {
  Version version;
  ASSERT_EQ(read_version(R"({"git_tag":"3.0.0","project_version":"3.0.0.0"})", version), nullptr);
  EXPECT_TRUE(version < OLDEST_VERSION);
  ASSERT_EQ(read_version(R"({"ok":true,"data":{"project_version":"3.5.2"}})", version), nullptr);
  EXPECT_FALSE(version < VECTOR_VERSION);
  ASSERT_EQ(read_version(R"({"project_version":"3.10.0"})", version), nullptr);
  EXPECT_FALSE(version < VECTOR_VERSION);
  ASSERT_EQ(read_version(R"({"project_version":"3.4.9"})", version), nullptr);
  EXPECT_TRUE(version < VECTOR_VERSION);
  for (const char* text : {"", "{}", R"({"project_version":3.5})", R"({"project_version":"new"})", R"({"project_version":"3"})"})
    EXPECT_NE(read_version(text, version), nullptr) << text;
}

// The key that carries a force differs between versions, and a service ignores what it does not know.
TEST(HaplyMessages, AForceIsAnObjectForEachDevice) {
  const std::array<Triple, 2> forces{{{1.5, 0, -2}, {0, 1e-9, 3}}};
  const auto vector = nlohmann::json::parse(write_forces({{"A", "B"}, ""}, forces, {3, 5}));
  ASSERT_EQ(vector["inverse3"].size(), 2u);
  EXPECT_EQ(vector["inverse3"][0]["device_id"], "A");
  EXPECT_EQ(vector["inverse3"][0]["commands"]["set_cursor_force"]["vector"], (nlohmann::json{{"x", 1.5}, {"y", 0.0}, {"z", -2.0}}));
  EXPECT_EQ(vector["inverse3"][1]["commands"]["set_cursor_force"]["vector"]["z"], 3);
  const auto values = nlohmann::json::parse(write_forces(ONE, forces, {3, 1}));
  ASSERT_EQ(values["inverse3"].size(), 1u);
  EXPECT_EQ(values["inverse3"][0]["commands"]["set_cursor_force"]["values"]["x"], 1.5);
  EXPECT_EQ(nlohmann::json::parse(write_forces({{"a\"b\\", ""}, ""}, forces, {3, 1}))["inverse3"][0]["device_id"], "a\"b\\");
}

// RFC 6455, 5.3: a masked byte is the byte xor that of the key at its place modulo four.
TEST(HaplyMessages, AMaskedFrameIsAWholeTextFrame) {
  for (const std::size_t size : {0u, 1u, 125u, 126u, 300u}) {
    std::string text;
    for (std::size_t k = 0; k < size; ++k) text += static_cast<char>('a' + k % 26);
    const std::string frame = masked_frame(text);
    const auto byte = [&frame](std::size_t at) { return static_cast<unsigned char>(frame.at(at)); };
    EXPECT_EQ(byte(0), 0x81);
    EXPECT_EQ(byte(1), 0x80 | (size < 126 ? size : 126));
    const std::size_t head = size < 126 ? 2 : 4;
    if (head == 4) {
      EXPECT_EQ(byte(2) * 256u + byte(3), size);
    }
    ASSERT_EQ(frame.size(), head + 4 + size);
    for (std::size_t k = 0; k < size; ++k) ASSERT_EQ(byte(head + 4 + k) ^ byte(head + k % 4), text[k]) << k;
  }
}

TEST(HaplyMessages, TheFrameOfTheDevicesIsTurnedAndBack) {
  EXPECT_EQ(from_haply({1, 0, 0}), (Triple{1, 0, 0})) << "to the right";
  EXPECT_EQ(from_haply({0, 1, 0}), (Triple{0, 0, -1})) << "forward is away from the person";
  EXPECT_EQ(from_haply({0, 0, 1}), (Triple{0, 1, 0})) << "up";
  EXPECT_EQ(to_haply(from_haply({1, 2, 3})), (Triple{1, 2, 3}));
}

}  // namespace
}  // namespace wholehand::device::haply
