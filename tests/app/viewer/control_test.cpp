// SPDX-License-Identifier: MIT
// What the page posts: every control that is one, and every way in which a request is none.
// sanitizers: address
#include "app/viewer/control.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "base/files/json.h"
#include "base/text/error.h"
#include "device/loop/guard.h"
#include "tests/support/live_script.h"
#include "tests/support/refusal.h"

namespace wholehand {
namespace {

using nlohmann::json;

json good() {
  return {
      {"position", {0.1, -0.2, 0.3}}, {"rotation", turned('y', 0.3)}, {"gap", 0.08}, {"buttons", 3}, {"sequence", 1763769600123}};
}

std::string refusal(const std::string& body) {
  const std::string line = refusal_line([&] { parse_view_control(body); });
  EXPECT_NE(line, "") << "taken: " << body;
  EXPECT_EQ(line.find('\r'), std::string::npos) << line;
  EXPECT_EQ(line.rfind("control: ", 0), 0u) << line;
  EXPECT_NE(line.find("allowed"), std::string::npos) << line;
  return line;
}

std::string with(const char* key, const json& value) {
  json object = good();
  object[key] = value;
  return json_text(object);
}

TEST(ViewControl, TakesWhatAPagePosts) {
  const device::ViewControl control = parse_view_control(json_text(good()));
  EXPECT_EQ(control.position, (Triple{0.1, -0.2, 0.3}));
  EXPECT_EQ(control.gap, 0.08);
  EXPECT_EQ(control.buttons, 3u);
  EXPECT_EQ(control.sequence, 1763769600123);
  const Rotation expected = turned('y', 0.3);
  for (int k = 0; k < 9; ++k) EXPECT_NEAR(control.rotation[k], expected[k], 1e-15);
  EXPECT_EQ(parse_view_control(with("gap", 0)).gap, 0) << "a whole number is a number";
  EXPECT_EQ(parse_view_control(with("gap", -3.5)).gap, -3.5) << "limits are another's business";
  EXPECT_EQ(parse_view_control(with("buttons", 4294967295)).buttons, 4294967295u);
}

// Rotations in single precision, as a page has them, and ones that are just allowed become exact: the guard takes the result.
TEST(ViewControl, MakesRotationsExact) {
  for (const double error : {1e-7, 1e-3, 3e-3}) {
    Rotation skewed = product(turned('z', 1.1), turned('x', -2));
    const Rotation exact = skewed;
    for (int k = 0; k < 9; ++k) skewed[k] += (k % 2 == 0 ? error : -error);
    const Rotation rotation = parse_view_control(with("rotation", skewed)).rotation;
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) {
        double dot = 0;
        for (int k = 0; k < 3; ++k) dot += rotation[3 * k + a] * rotation[3 * k + b];
        EXPECT_NEAR(dot, a == b ? 1 : 0, 1e-15);
      }
    }
    for (int k = 0; k < 9; ++k) EXPECT_NEAR(rotation[k], exact[k], 6 * error) << "each column moved by what is off in two";
  }
}

TEST(ViewControl, RefusesWhatIsNoRotation) {
  for (const json& rotation :
       {json{0, 0, 0, 0, 0, 0, 0, 0, 0}, json{1, 0, 0, 0, 1, 0, 0, 0, -1}, json{2, 0, 0, 0, 1, 0, 0, 0, 0.5},
        json{1, 0.1, 0, 0, 1, 0, 0, 0, 1}, json{1.02, 0, 0, 0, 1, 0, 0, 0, 1}, json{1, 0, 0, 1, 0, 0, 0, 0, 1}})
    refusal(with("rotation", rotation));
}

TEST(ViewControl, RefusesWrongSizesAndWhatIsNoNumber) {
  for (const char* key : {"position", "rotation"}) {
    for (const json& value : {json(), json(1), json("1,2,3"), json::array(), json{1, 2}, json{1, 2, 3, 4}, json{1, "2", 3},
                              json{1, nullptr, 3}, json{1, json::array(), 3}, json{1, 2, 1001}, json{1, 2, true}, json::object()})
      refusal(with(key, value));
  }
  for (const json& value : {json(), json("0.1"), json{0.1}, json(true), json(1001), json(-1e30)}) refusal(with("gap", value));
  for (const char* key : {"buttons", "sequence"}) {
    for (const json& value :
         {json(), json("1"), json(1.5), json(-1), json(1e3), json(9007199254740992), json(18446744073709551615u)})
      refusal(with(key, value));
  }
  refusal(with("buttons", 4294967296));
}

TEST(ViewControl, RefusesMissingAndUnknownKeys) {
  for (const std::string key : {"position", "rotation", "gap", "buttons", "sequence"}) {
    json object = good();
    object.erase(key);
    EXPECT_NE(refusal(json_text(object)).find("'" + key + "'"), std::string::npos);
  }
  EXPECT_NE(refusal(with("grip", 1)).find("'grip'"), std::string::npos);
  EXPECT_NE(refusal(with("a\nb", 1)).find("a\\x0ab"), std::string::npos) << "on one line";
}

TEST(ViewControl, RefusesWhatIsNoJsonWhateverItIs) {
  const std::string text = json_text(good());
  for (std::size_t size = 0; size < text.size(); ++size) refusal(text.substr(0, size));
  refusal(text + "x");
  refusal(text + text);
  refusal("[" + text + "]");
  refusal(std::string(4096, '['));
  refusal(std::string("\0\0\0", 3));
  refusal("\xff\xfe{}");
  for (const char* number : {"NaN", "Infinity", "1e999", "-1e999", "0x10", "01", ".5", "1e"}) {
    std::string body = text;
    body.replace(body.find("0.08"), 4, number);
    refusal(body);
  }
  EXPECT_NE(refusal(text + std::string(4096, ' ')).find("bytes"), std::string::npos) << "however harmless";
  EXPECT_EQ(parse_view_control(text + std::string(1000, ' ')).buttons, 3u);
}

}  // namespace
}  // namespace wholehand
