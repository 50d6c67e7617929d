// SPDX-License-Identifier: MIT
// Text from anywhere: what would end the TOML parser or the program is refused like everything else.
#include "core/reader/scan.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/support/scene_texts.h"

namespace wholehand {
namespace {

TEST(SceneScan, SurvivesHostileText) {
  const std::string deep(100000, '[');
  EXPECT_NE(refusal_of("a = " + deep).find("test.toml:1:"), std::string::npos);
  std::string dotted = "a";
  for (int i = 0; i < 200000; ++i) dotted += ".a";
  EXPECT_NE(refusal_of(dotted + " = 1").find("test.toml:1:16: a key of more than 8 parts"), std::string::npos)
      << refusal_of(dotted + " = 1").substr(0, 100);
  EXPECT_NE(refusal_of("[" + dotted + "]").find("a key of more than 8 parts"), std::string::npos);
  EXPECT_NE(refusal_of("x = { " + dotted + " = 1 }").find("a key of more than 8 parts"), std::string::npos);
  EXPECT_NE(refusal_of("\"x\" . 'y' . \"a.b.c.d.e.f.g.h.i.j\" . c . d . e . f . g . h . i = 1").find("a key of more than 8 parts"),
            std::string::npos);
  EXPECT_EQ(refusal_of("# a.b.c.d.e.f.g.h.i.j.k\n[scene]\nname = \"a.b.c.d.e.f.g.h.i.j\"\n" + VESSEL), "accepted");
  EXPECT_EQ(refusal_of("[scene]\nname = '''a.b.c.d.e.f.g.h.i.j'''\n" + VESSEL), "accepted");
  // headers on which the parser would end the program
  for (const char* header : {"[=", "[ = x]", "[[.a]]", "[[[a]]]", "[\n]", "[#]", "[\r\n", "[{", "[+a]", "[\xc3\xa4]"}) {
    EXPECT_NE(refusal_of(std::string("x = 1 # [=\n  ") + header).find("a table header without a key; allowed: TOML 1.0"),
              std::string::npos)
        << header;
  }
  EXPECT_NE(refusal_of("[").find("test.toml:1:"), std::string::npos);
  EXPECT_NE(refusal_of("[]").find("test.toml:1:"), std::string::npos);
  EXPECT_EQ(refusal_of("[grips]\nroll_deg = [ # a comment\n  +1,\n  .2e1]\n" + VESSEL).find("without a key"), std::string::npos);
  EXPECT_EQ(refusal_of("[ \"scene\" ]\nname = \"\"\"[=\"\"\"\n[ hand . thumb ]\n['tilts']\ndeg = [\n+1,\n 2.0]\n" + VESSEL),
            "accepted");
  expect_refusal("a = [0,@}", "found '}', but '[' is open; allowed: TOML 1.0");
  expect_refusal("a = { b = [1], c = 3@] }", "found ']', but '{' is open; allowed: TOML 1.0");
  // strings that the parser would not see as such
  expect_refusal("a = 9@\"\xc3\xa4\"",
                 "\" directly after '9': a quote is missing before it, or this one is too many; allowed: TOML 1.0");
  expect_refusal("a = 9.@'\xc3\xa4'",
                 "' directly after '.': a quote is missing before it, or this one is too many; allowed: TOML 1.0");
  expect_refusal("a = 9@=\"\xc3\xa4\"", "'=' in a value; allowed: TOML 1.0");
  expect_refusal("a = 9@[\"\xc3\xa4\"]", "[ directly after '9'; allowed: TOML 1.0");
  expect_refusal("a = [{ b = 1, c = 2@{ } }]", "{ directly after '2'; allowed: TOML 1.0");
  expect_refusal("a = \"x\"@\"\xc3\xa4\"",
                 "\" directly after '\"': a quote is missing before it, or this one is too many; allowed: TOML 1.0");
  EXPECT_EQ(
      refusal_of("scene={\"name\"=\"\xc3\xa4\",'pose'=\"paper\"}\ngrips.roll_deg=[1,\n2]\nhand.\"thumb\".'splay_deg'=3\n" + VESSEL),
      "accepted");
  // characters beyond ASCII, of which the parser asks whether they are spaces
  expect_refusal("[scene]\nn@\xca\xa3 = 1", "a non-ASCII character outside strings and comments");
  expect_refusal("[scene]\ngravity_m_s2 = 1@\xc3\xa4", "a non-ASCII character outside strings and comments");
  expect_refusal("[scene]\nname = \"\"\"\\@\xc3\xa4\"\"\"", "a backslash before a non-ASCII character");
  expect_refusal("[scene]\nname = \"\"\"\\\n  @\xc3\xa4\"\"\"", "a backslash before a non-ASCII character");
  EXPECT_EQ(refusal_of("\xEF\xBB\xBF# \xc3\xa4\n[scene]\nname = \"\xc3\xa4\\n\".\n").substr(0, 14), "test.toml:3:13");
  EXPECT_EQ(refusal_of("\xEF\xBB\xBF# \xc3\xa4\n[scene]\nname = '\xc3\xa4\\'\n" + VESSEL), "accepted");
  EXPECT_EQ(refusal_of("[scene]\nname = \"\"\"\\\n  a\"\"\"\n" + VESSEL), "accepted");
  EXPECT_NE(refusal_of(std::string("a\0b = 1", 7)).find("test.toml:1:"), std::string::npos);
  EXPECT_NE(refusal_of("a = \"\xff\xfe\"").find("test.toml:1:"), std::string::npos);
  EXPECT_NE(refusal_of("a = 99999999999999999999999").find("test.toml:1:"), std::string::npos);
  EXPECT_NE(refusal_of(std::string(2 << 20, ' ')).find("more than 1,048,576 bytes; allowed: a scene of at most 1 MiB"),
            std::string::npos);
  const std::string key(500000, 'k');
  const std::string refusal = refusal_of(key + " = 1");
  EXPECT_LT(refusal.size(), 300u);
  EXPECT_NE(refusal.find("test.toml:1:1: unknown key 'kkk"), std::string::npos);
  EXPECT_NE(refusal_of("\"a\\nb\\u0007\" = 1").find("unknown key 'a\\x0ab\\x07'"), std::string::npos);
}

TEST(SceneScan, AMissingQuoteIsNamedWhereItsTextIs) {
  const std::string one =
      "the closing \" of this text is missing; allowed: the same quote at the end of the text, in the same line";
  expect_refusal("[scene]\nname = @\"a\npose = \"paper\"" + VESSEL, one);
  expect_refusal("[scene]\nname = @\"a\\\"\n" + VESSEL, one);
  expect_refusal("[scene]\nname = @\"a", one);
  expect_refusal("[output]\nkeep = [\"score\", @\"gap]\n" + VESSEL, one);
  expect_refusal("[scene]\nname = @'a\npose = 'paper'" + VESSEL, "the closing ' of this text is missing");
  expect_refusal("[scene]\n'name = 'a@'", "' directly after 'a': a quote is missing before it, or this one is too many");
  expect_refusal("[scene]\nname = @\"\"\"a\npose = \"paper\"" + VESSEL, "the closing \"\"\" of this text is missing");
  expect_refusal("[scene]\nname = @'''a\"", "the closing ''' of this text is missing");
  const std::string outside = "'paper' is outside quotes: a quote is missing; allowed: texts in quotes, as name = \"cup\"";
  for (const char* line : {"pose = @paper\"", "pose = @paper", "pose = @paper'", "keep = [\"score, \"@paper\"]",
                           "keep = [\"a\", @paper\"]", "a = { b = @paper }"})
    expect_refusal(std::string("[scene]\n") + line, outside);
  const std::string before = "\" directly after 'v': a quote is missing before it, or this one is too many";
  expect_refusal("[scene]\n\"name = \"v@\"\n", before);
  for (const char* value :
       {"true", "[true,\n false]", "inf", "+inf", "-nan", "1e5", "0xFF", "1979-05-27T07:32:00Z", "[ # a\n nan]"})
    EXPECT_NE(refusal_of(std::string("a = ") + value).find("unknown key 'a'"), std::string::npos) << value;
}

TEST(SceneScan, ColumnsCountCharacters) {
  expect_refusal("[scene]\nname = \"fl\xc3\xa4sche\"\n" + VESSEL.substr(1) + "liquid = @3", "liquid = 3; allowed: a table");
  const std::string refusal = refusal_of("scene = { name = \"\xc3\xa4\", pose = 3 }\n" + VESSEL);
  EXPECT_EQ(refusal.substr(0, 16), "test.toml:1:30: ") << refusal;
}

}  // namespace
}  // namespace wholehand
