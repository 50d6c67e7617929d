// SPDX-License-Identifier: MIT
// What a hand over the network says, as liblo writes it: good, of every type, and damaged in every way.
// sanitizers: address
#include "device/grippers/osc_messages.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/support/live_script.h"
#include "tests/support/osc_words.h"

namespace wholehand::device {
namespace {

constexpr double OSC_NAN = std::numeric_limits<double>::quiet_NaN();
const std::vector<double> A_STATE{7, 0.1, -0.2, 0.3, 0, 0, 0, 1, 0.09, 5};
const std::vector<double> A_HELLO{0.02, 0.12, 5, 3};

std::string said(const std::string& bytes, osc::Words& words) {
  const char* wrong = osc::read_words({bytes.data(), bytes.size()}, words);
  return wrong ? wrong : "";
}

std::string state_message(const std::vector<double>& numbers, const std::string& types = STATE_TYPES) {
  return osc_message("/wholehand/gripper/state", types, numbers);
}
std::vector<double> with(std::vector<double> numbers, std::size_t at, double value) {
  numbers.at(at) = value;
  return numbers;
}

void expect_wrong(const std::string& bytes, const std::string& why) {
  osc::Words words;
  EXPECT_EQ(said(bytes, words), why);
  EXPECT_FALSE(words.is_any()) << "nothing of it counts";
}

TEST(OscMessages, AStateSaysWhereTheHandIs) {
  GripperState truth;
  truth.position = {0.1, -0.25, 0.5};
  truth.rotation = product(turned('y', 0.7), turned('x', -1.9));
  truth.gap = 0.0625;
  truth.buttons = 0x80000001;
  osc::Words words;
  ASSERT_EQ(said(osc_state(41, truth, "iddddddddh"), words), "");
  ASSERT_TRUE(words.has_state);
  EXPECT_FALSE(words.has_hello || words.has_bye);
  EXPECT_EQ(words.state.sequence, 41u);
  EXPECT_EQ(words.state.position, truth.position);
  EXPECT_EQ(words.state.gap, truth.gap);
  EXPECT_EQ(words.state.buttons, truth.buttons);
  for (int k = 0; k < 9; ++k) EXPECT_NEAR(words.state.rotation[k], truth.rotation[k], 1e-15) << k;  // rounding of products
}

TEST(OscMessages, EveryTypeOfNumberIsTaken) {
  for (const std::string types : {"iffffffffi",
                                  "idddddddd"
                                  "i",
                                  "hddddddddh", "fffffffffi", "ffffffffff", "dddddddddd"}) {
    osc::Words words;
    ASSERT_EQ(said(state_message(A_STATE, types), words), "") << types;
    EXPECT_EQ(words.state.sequence, 7u) << types;
    EXPECT_EQ(words.state.buttons, 5u) << types;
    EXPECT_NEAR(words.state.position[1], -0.2, 1e-8) << types << ": float32";
    EXPECT_NEAR(words.state.gap, 0.09, 1e-8) << types;
  }
  osc::Words words;
  ASSERT_EQ(said(state_message({-1, 1, 2, 3, 0, 0, 0, 1, 0, 0}, "iiiiiiiiii"), words), "");
  EXPECT_EQ(words.state.position, (Triple{1, 2, 3}));
  EXPECT_EQ(words.state.sequence, 0xFFFFFFFFu) << "32 bits without a sign";
}

TEST(OscMessages, AHelloSaysWhatTheHandIs) {
  for (const double port : {-1.0, 0.0, 7000.0, 65535.0}) {
    std::vector<double> numbers = A_HELLO;
    if (port >= 0) numbers.push_back(port);
    osc::Words words;
    ASSERT_EQ(said(osc_hello(numbers), words), "");
    ASSERT_TRUE(words.has_hello);
    EXPECT_NEAR(words.hello.gap[0], 0.02, 1e-9);
    EXPECT_NEAR(words.hello.gap[1], 0.12, 1e-8);
    EXPECT_EQ(words.hello.force, 5);
    EXPECT_EQ(words.hello.grip, 3);
    EXPECT_EQ(words.hello.port, std::max(port, 0.0));
  }
}

TEST(OscMessages, AByeIsOneWhateverItCarries) {
  for (const std::string types : {"", "i", "s"}) {
    osc::Words words;
    ASSERT_EQ(said(osc_message("/wholehand/gripper/bye", types, {1}), words), "");
    EXPECT_TRUE(words.has_bye);
  }
}

TEST(OscMessages, BundlesAreTakenApartWhateverTheirTime) {
  GripperState first, later;
  first.gap = 0.5;
  later.gap = 0.25;
  const std::string hello = osc_hello(A_HELLO), other = osc_message("/somebody/else", "sT", {0, 0});
  osc::Words words;
  ASSERT_EQ(said(osc_bundle({hello, other, osc_bundle({osc_state(9, later), osc_state(8, first)})}), words), "");
  EXPECT_TRUE(words.has_hello);
  EXPECT_EQ(words.state.sequence, 9u) << "the latest by its sequence";
  EXPECT_EQ(words.state.gap, 0.25);
  ASSERT_EQ(said(osc_bundle({}), words), "");
  EXPECT_FALSE(words.is_any());
  ASSERT_EQ(said(other, words), "");
  EXPECT_FALSE(words.is_any()) << "for others";
}

TEST(OscMessages, BundlesInBundlesHaveAnEnd) {
  std::string bytes = state_message(A_STATE);
  for (int depth = 0; depth < 8; ++depth) bytes = osc_bundle({bytes});
  osc::Words words;
  EXPECT_EQ(said(bytes, words), "");
  EXPECT_TRUE(words.has_state);
  expect_wrong(osc_bundle({bytes}), "too many bundles in each other");
}

TEST(OscMessages, ANumberThatIsNoneIsForTheGuard) {
  for (std::size_t k = 1; k <= 8; ++k) {
    osc::Words words;
    ASSERT_EQ(said(state_message(with(A_STATE, k, OSC_NAN)), words), "") << k;
    EXPECT_FALSE(is_finite(words.state)) << k;
  }
  // a quaternion of another length
  for (const double w : {0.0, 0.99, 1.01, -0.99, 1e30, 1e-30}) {
    osc::Words words;
    ASSERT_EQ(said(state_message(with(A_STATE, 7, w), "iddddddddi"), words), "") << w;
    EXPECT_FALSE(is_finite(words.state)) << w;
  }
  for (const double w : {1.0, -1.0, 1.0009, 0.9991}) {
    osc::Words words;
    ASSERT_EQ(said(state_message(with(A_STATE, 7, w), "iddddddddi"), words), "") << w;
    EXPECT_EQ(words.state.rotation, NO_ROTATION) << w << ": made unit";
  }
}

TEST(OscMessages, OtherArgumentsAreWrong) {
  const std::string why = "arguments of another number or type";
  for (const std::string types : {"", "i", "iffffffff", "iffffffffii", "sffffffffi", "iffffffffs", "iffffTfffi", "iffff[fff]i"})
    expect_wrong(state_message(A_STATE.size() >= types.size() ? A_STATE : std::vector<double>(types.size(), 0), types), why);
  for (const double sequence : {0.5, 4294967296.0, -2147483649.0, OSC_NAN, 1e300})
    expect_wrong(state_message(with(A_STATE, 0, sequence), "dffffffffi"), why);
  expect_wrong(state_message(with(A_STATE, 9, 1.5), "iffffffffd"), why);
  expect_wrong(osc_hello({0, 0.1, 5}), why);
  expect_wrong(osc_message("/wholehand/gripper/hello", "ffffff", {0, 0.1, 5, 5, 0, 0}), why);
  expect_wrong(osc_message("/wholehand/gripper/hello", "ffffi", {0, 0.1, 5, 5, 65536}), why);
  expect_wrong(osc_message("/wholehand/gripper/hello", "ffffi", {0, 0.1, 5, 5, -1}), why);
  // one that is good does not save another in the same datagram
  expect_wrong(osc_bundle({osc_hello(A_HELLO), state_message(A_STATE, "i")}), why);
}

TEST(OscMessages, NumbersOutOfRangeAreWrong) {
  for (const double place : {100.01, -100.01, 1e30, std::numeric_limits<double>::infinity()})
    for (std::size_t k = 1; k <= 3; ++k) expect_wrong(state_message(with(A_STATE, k, place)), "a place out of range");
  for (const double gap : {-0.011, 1.01, -std::numeric_limits<double>::infinity()})
    expect_wrong(state_message(with(A_STATE, 8, gap)), "a gap out of range");
  for (const auto& [closed, open] : {std::pair{0.1, 0.1}, {0.1, 0.05}, {-0.02, 0.1}, {0.0, 1.1}, {OSC_NAN, 0.1}, {0.0, OSC_NAN}})
    expect_wrong(osc_hello({closed, open, 5, 5}), "a gap that does not open, or out of range");
  for (const double force : {-0.1, 1000.1, OSC_NAN, std::numeric_limits<double>::infinity()}) {
    expect_wrong(osc_hello({0, 0.1, force, 5}), "a largest force out of range");
    expect_wrong(osc_hello({0, 0.1, 5, force}), "a largest force out of range");
  }
  osc::Words words;
  EXPECT_EQ(said(state_message({0, 100, -100, 0, 0, 0, 0, 1, 1, 0}), words), "") << "the ends are allowed";
  EXPECT_EQ(said(osc_hello({0, 1, 0, 1000}), words), "");
}

// No prefix of a datagram is a valid datagram, unless it is a whole one itself.
TEST(OscMessages, CutDatagramsAreWrong) {
  const std::string hello = osc_hello(A_HELLO), bundle = osc_bundle({hello, state_message(A_STATE)});
  for (std::size_t size = 0; size < bundle.size(); ++size) {
    osc::Words words;
    const bool is_whole = size == 16 || size == 16 + 4 + hello.size();
    EXPECT_EQ(said(bundle.substr(0, size), words) == "", is_whole) << size;
    EXPECT_EQ(words.is_any(), size == 16 + 4 + hello.size()) << size;
  }
  for (const std::string& whole : {state_message(A_STATE), hello})
    for (std::size_t size = 0; size < whole.size(); ++size) {
      osc::Words words;
      EXPECT_NE(said(whole.substr(0, size), words), "") << size;
    }
}

// The reader never trusts lengths, whatever the stated size of a part and whichever byte is damaged.
TEST(OscMessages, DamagedBytesAreNoTrouble) {
  const std::string bundle = osc_bundle({osc_hello(A_HELLO), state_message(A_STATE)});
  for (std::size_t at = 0; at < bundle.size(); ++at) {
    for (const int value : {0, 1, 4, 0x7f, 0x80, 0xff}) {
      std::string damaged = bundle;
      damaged[at] = static_cast<char>(value);
      osc::Words words;
      const std::string wrong = said(damaged, words);
      EXPECT_TRUE(wrong == "" || !words.is_any()) << at << ' ' << value;
    }
  }
  for (const std::uint32_t size : {0u, 1u, 3u, 0x7fffffffu, 0x80000000u, 0xfffffffcu, 0xffffffffu}) {
    const std::string head = osc_bundle({});
    expect_wrong(head + big_endian_word(size) + (size == 0 ? "" : "/abc"),
                 size == 0  ? "an empty part of a bundle"
                 : size < 4 ? "a length that is not a multiple of 4 bytes"
                            : "a part of a bundle that is longer than the datagram");
  }
}

TEST(OscMessages, WhatIsNoMessageIsWrong) {
  using namespace std::string_literals;
  expect_wrong("", "an empty datagram");
  expect_wrong("abc"s, "a length that is not a multiple of 4 bytes");
  expect_wrong("abc\0"s, "a message without an address");
  expect_wrong("\0\0\0\0"s, "a message without an address");
  expect_wrong("/abc"s, "a message without an address");
  expect_wrong("/ab\0"s, "a message without type tags");
  expect_wrong("/ab\0i\0\0\0"s, "a message without type tags");
  expect_wrong("/ab\0,iii"s, "a message without type tags");
  expect_wrong("/a\0x,\0\0\0"s, "a message without an address");
  expect_wrong("#bundle\0\0\0\0\0"s, "a bundle without a time tag");
}

TEST(OscMessages, SequencesWrap) {
  EXPECT_TRUE(osc::is_later(1, 0));
  EXPECT_FALSE(osc::is_later(0, 0));
  EXPECT_FALSE(osc::is_later(0, 1));
  EXPECT_TRUE(osc::is_later(0, 0xFFFFFFFF));
  EXPECT_TRUE(osc::is_later(0x7FFFFFFF, 0));
  EXPECT_FALSE(osc::is_later(0xFFFFFFFF, 0));
  EXPECT_FALSE(osc::is_later(0, 0x7FFFFFFF));
}

}  // namespace
}  // namespace wholehand::device
