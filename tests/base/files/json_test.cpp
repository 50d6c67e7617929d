// SPDX-License-Identifier: MIT
#include "base/files/json.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

namespace wholehand {
namespace {

constexpr const char* TEXT = R"({"b":[1,2.5,null],"a":"x"})";

TEST(JsonText, IsReadAndWritten) {
  EXPECT_EQ(json_text(parse_json(TEXT)), R"({"a":"x","b":[1,2.5,null]})");
  EXPECT_EQ(json_text(parse_ordered_json(TEXT)), TEXT) << "in the order of its keys";
  EXPECT_EQ(json_text(try_json(TEXT)), R"({"a":"x","b":[1,2.5,null]})");
  EXPECT_EQ(json_text(parse_json("[1]"), 2), "[\n  1\n]");
  EXPECT_EQ(json_text(parse_ordered_json("[1]"), 2), "[\n  1\n]");
}

TEST(JsonText, ThatIsNoneIsRefused) {
  for (const char* text : {"", "{", "{}x", "[1,]", "\"\xff\""}) {
    EXPECT_THROW(parse_json(text), nlohmann::json::parse_error) << text;
    EXPECT_THROW(parse_ordered_json(text), nlohmann::json::parse_error) << text;
    EXPECT_TRUE(try_json(text).is_discarded()) << text;
  }
}

TEST(JsonText, OfBytesThatAreNoUtf8IsWritten) {
  const std::string name = "m\xff.nc";
  EXPECT_EQ(json_text(nlohmann::json(name)), "\"m\xef\xbf\xbd.nc\"");
  EXPECT_EQ(json_text(nlohmann::ordered_json(name)), "\"m\xef\xbf\xbd.nc\"");
}

TEST(JsonText, GivesAZeroNoSign) {
  EXPECT_EQ(json_text(nlohmann::json{-0.0, -0.05, -1.0, 0.0, -0.0}), "[0.0,-0.05,-1.0,0.0,0.0]");
  EXPECT_EQ(json_text(nlohmann::ordered_json{{"-0.0", "[\"-0.0,\\"}, {"b", -0.0}}), R"({"-0.0":"[\"-0.0,\\","b":0.0})")
      << "not in strings";
  EXPECT_EQ(json_text(nlohmann::json(-0.0)), "0.0");
}

TEST(JsonText, SteersNothing) {
  const std::string name = "a\x1b\x7f\xc2\x9b\xe2\x80\xae\xc3\xa4";
  const std::string text = json_text(nlohmann::json{{name, name}});
  EXPECT_EQ(text, "{\"a\\u001b\\u007f\\u009b\\u202e\xc3\xa4\":\"a\\u001b\\u007f\\u009b\\u202e\xc3\xa4\"}");
  EXPECT_EQ(parse_json(text)[name], name) << "and stays what it is";
}

}  // namespace
}  // namespace wholehand
