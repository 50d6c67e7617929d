// SPDX-License-Identifier: MIT
// Bundles of OSC 1.0: against the specification's own examples byte by byte, and against liblo, which reads them its own way.
// sanitizers: address
#include "base/system/osc_bundle.h"

#include <gtest/gtest.h>
#include <lo/lo.h>

#include <cstring>
#include <limits>
#include <string>
#include <vector>

namespace wholehand {
namespace {

std::string bytes_of(const OscBundle& bundle) { return {bundle.bytes().begin(), bundle.bytes().end()}; }
template <std::size_t N>
std::string literal(const char (&text)[N]) {
  return std::string(text, N - 1);
}
const std::string HEAD = literal("#bundle\0\0\0\0\0\0\0\0\1");

// "Open Sound Control 1.0 Specification Examples": the two messages, each with its size before it as in a bundle.
TEST(OscBundle, IsTheSpecificationsExamplesByteByByte) {
  OscBundle bundle(1000);
  EXPECT_EQ(bytes_of(bundle), HEAD) << "with the time tag for at once";
  EXPECT_TRUE(bundle.is_empty());
  ASSERT_TRUE(bundle.add("/oscillator/4/frequency", {440.0f}));
  EXPECT_FALSE(bundle.is_empty());
  const std::string first = literal("\0\0\0\x20/oscillator/4/frequency\0,f\0\0\x43\xdc\0\0");
  EXPECT_EQ(bytes_of(bundle), HEAD + first);
  ASSERT_TRUE(bundle.add("/foo", {1000, -1, std::string_view("hello"), 1.234f, 5.678f}));
  EXPECT_EQ(bytes_of(bundle),
            HEAD + first +
                literal("\0\0\0\x28/foo\0\0\0\0,iisff\0\0\0\0\x03\xe8\xff\xff\xff\xffhello\0\0\0\x3f\x9d\xf3\xb6\x40\xb5\xb2\x2d"));
  bundle.clear();
  EXPECT_EQ(bytes_of(bundle), HEAD);
}

TEST(OscBundle, AMessageGoesAloneToo) {
  OscBundle bundle(1000);
  ASSERT_TRUE(bundle.add("/oscillator/4/frequency", {440.0f}));
  const auto alone = [&bundle] { return std::string(bundle.first_message().begin(), bundle.first_message().end()); };
  const std::string first = literal("/oscillator/4/frequency\0,f\0\0\x43\xdc\0\0");
  EXPECT_EQ(alone(), first);
  ASSERT_TRUE(bundle.add("/foo", {1}));
  EXPECT_EQ(alone(), first);
}

TEST(OscBundle, TakesNoMessageThatIsTooMuch) {
  OscBundle bundle(16 + 4 + 12);  // "/a", ",i", a word
  EXPECT_FALSE(bundle.add("/a", {1, 2}));
  EXPECT_EQ(bytes_of(bundle), HEAD);
  EXPECT_TRUE(bundle.add("/a", {1}));
  const std::string full = bytes_of(bundle);
  EXPECT_EQ(full.size(), 32u);
  EXPECT_FALSE(bundle.add("/", {}));
  EXPECT_EQ(bytes_of(bundle), full) << "as it was";
}

struct Arrived {
  std::string address, types;
  std::vector<std::int32_t> ints;
  std::vector<float> floats;
  std::vector<std::string> texts;
};

Arrived read_message(lo_message message, const char* address) {
  Arrived arrived{address, lo_message_get_types(message), {}, {}, {}};
  for (int k = 0; k < lo_message_get_argc(message); ++k) {
    // liblo reads arguments in place, aligned to four bytes in the packet instead of as their type requires
    const void* value = lo_message_get_argv(message)[k];
    if (arrived.types[k] == 'i') std::memcpy(&arrived.ints.emplace_back(), value, 4);
    if (arrived.types[k] == 'f') std::memcpy(&arrived.floats.emplace_back(), value, 4);
    if (arrived.types[k] == 's') arrived.texts.emplace_back(static_cast<const char*>(value));
  }
  return arrived;
}

// Texts of every length to the next word and beyond, every number of arguments likewise.
TEST(OscBundle, AnotherLibraryReadsWhatWasMeant) {
  const std::string text(100, 'x');
  std::string address = "/";
  for (int count = 0; count < 10; ++count) {
    address += static_cast<char>('a' + count);
    OscBundle bundle(10000);
    std::vector<OscValue> values;
    for (int k = 0; k < count; ++k) {
      values.emplace_back(std::numeric_limits<std::int32_t>::min() + k);
      values.emplace_back(-1.5f * static_cast<float>(k));
      values.emplace_back(std::string_view(text).substr(0, static_cast<std::size_t>(count + k)));
    }
    ASSERT_TRUE(bundle.add(address, values));
    std::string bytes = bytes_of(bundle);
    int result = 0;
    const lo_message message = lo_message_deserialise(bytes.data() + 20, bytes.size() - 20, &result);
    ASSERT_NE(message, nullptr) << result;
    const Arrived arrived = read_message(message, bytes.data() + 20);
    lo_message_free(message);
    EXPECT_EQ(arrived.address, address);
    ASSERT_EQ(arrived.types.size(), 3u * static_cast<std::size_t>(count));
    for (int k = 0; k < count; ++k) {
      EXPECT_EQ(arrived.ints[k], std::get<std::int32_t>(values[3 * k]));
      EXPECT_EQ(arrived.floats[k], std::get<float>(values[3 * k + 1]));
      EXPECT_EQ(arrived.texts[k], std::get<std::string_view>(values[3 * k + 2]));
    }
  }
}

}  // namespace
}  // namespace wholehand
