// SPDX-License-Identifier: MIT
// The twins core/<stem>.cpp and shaders/<stem>.glsl hold the same functions, in the same order, with the same parameters.
// sanitizers: none
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace {

// The pairs that must exist; others are compared where both files exist.
const std::vector<std::string> PAIRS = {"hand",  "sdf",  "closure", "contact", "projection", "force",
                                        "score", "trig", "table",   "body",    "wrist"};

// What C++ passes along as its first parameters and GLSL has as buffers or constants.
const std::set<std::string> CONTEXT = {"hand", "vessel", "lattice"};

struct Function {
  std::string name;
  std::vector<std::string> parameters;
  std::string text() const {
    std::string line = name + "(";
    for (std::size_t i = 0; i < parameters.size(); ++i) line += (i ? ", " : "") + parameters[i];
    return line + ")";
  }
};

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }
bool is_name(const std::string& token) { return is_word(token[0]) && !std::isdigit(static_cast<unsigned char>(token[0])); }

// Words and single characters; comments, literals and preprocessor lines (with their continuations) are left out.
std::vector<std::string> tokens_of(std::string_view text) {
  std::vector<std::string> tokens;
  bool line_start = true;
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    const std::string_view rest = text.substr(i);
    if (rest.starts_with("//")) {
      i = std::min(text.find('\n', i), text.size());
    } else if (rest.starts_with("/*")) {
      const std::size_t end = text.find("*/", i + 2);
      i = end == text.npos ? text.size() : end + 2;
    } else if (line_start && c == '#') {
      while (i < text.size() && text[i] != '\n') i += text[i] == '\\' ? 2 : 1;
    } else if (c == '"' || (c == '\'' && !(i > 0 && is_word(text[i - 1])))) {
      std::size_t end = i + 1;
      while (end < text.size() && text[end] != c) end += text[end] == '\\' ? 2 : 1;
      i = std::min(end + 1, text.size());
      line_start = false;
    } else if (std::isspace(static_cast<unsigned char>(c))) {
      line_start = line_start || c == '\n';
      ++i;
    } else {
      std::size_t end = i + 1;
      if (is_word(c)) {
        while (end < text.size() && is_word(text[end])) ++end;
      }
      tokens.emplace_back(text.substr(i, end - i));
      i = end;
      line_start = false;
    }
  }
  return tokens;
}

// The last name of each parameter, default values and array bounds aside.
std::vector<std::string> parameter_names(const std::vector<std::string>& tokens) {
  std::vector<std::string> names;
  std::string last;
  int depth = 0;
  bool past_name = false;
  for (const std::string& token : tokens) {
    if (token == "(" || token == "<" || token == "[") ++depth;
    if (token == ")" || token == ">" || token == "]") --depth;
    if (token == "[" || token == "=") past_name = true;
    if (depth == 0 && token == ",") {
      names.push_back(last);
      last.clear();
      past_name = false;
    } else if (depth == 0 && !past_name && is_name(token)) {
      last = token;
    }
  }
  if (!last.empty() && last != "void") names.push_back(last);
  return names;
}

// The function whose head these tokens are (everything between the last `;`, `{` or `}` and a `{`), nameless if they are not one.
Function function_of(const std::vector<std::string>& head) {
  Function function;
  const auto open = std::find(head.begin(), head.end(), "(");
  if (open == head.end() || open == head.begin() || !is_name(*(open - 1))) return function;
  int depth = 0;
  auto close = open;
  for (; close != head.end(); ++close) {
    if (*close == "(") ++depth;
    if (*close == ")" && --depth == 0) break;
  }
  if (close == head.end()) return function;
  for (auto after = close + 1; after != head.end(); ++after) {
    if (*after != "const" && *after != "noexcept") return function;  // layout(..) buffer Name {, struct with attributes
  }
  function.name = *(open - 1);
  function.parameters = parameter_names({open + 1, close});
  auto first = function.parameters.begin();
  while (first != function.parameters.end() && CONTEXT.contains(*first)) ++first;
  function.parameters.erase(function.parameters.begin(), first);
  return function;
}

// Functions defined in a file, outside structs, in order; one that is defined alike under several #if branches counts once.
std::vector<Function> functions_of(std::string_view text) {
  std::vector<Function> functions;
  std::vector<std::string> head;
  int skipping = 0;  // depth within a body
  for (const std::string& token : tokens_of(text)) {
    if (skipping > 0) {
      if (token == "{") ++skipping;
      if (token == "}") --skipping;
      continue;
    }
    if (token == "{") {
      if (std::find(head.begin(), head.end(), "namespace") != head.end()) {  // its contents count
        head.clear();
        continue;
      }
      const Function function = function_of(head);
      const auto same = [&](const Function& other) { return other.text() == function.text(); };
      if (!function.name.empty() && std::none_of(functions.begin(), functions.end(), same)) functions.push_back(function);
      skipping = 1;
      head.clear();
    } else if (token == ";" || token == "}") {
      head.clear();
    } else {
      head.push_back(token);
    }
  }
  return functions;
}

std::string listing(const std::vector<Function>& functions) {
  std::string text;
  for (const Function& function : functions) text += function.text() + "\n";
  return text;
}

std::string listing(std::string_view text) { return listing(functions_of(text)); }

std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path);
  EXPECT_TRUE(file) << "cannot read " << path;
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

const std::filesystem::path SOURCE = WHOLEHAND_SOURCE_DIR;

class Twin : public testing::TestWithParam<std::string> {};

TEST_P(Twin, HasTheSameFunctionsInTheSameOrder) {
  const std::string& stem = GetParam();
  const std::filesystem::path core = SOURCE / "core" / (stem + ".cpp");
  const std::filesystem::path shader = SOURCE / "shaders" / (stem + ".glsl");
  ASSERT_TRUE(std::filesystem::exists(core)) << core;
  ASSERT_TRUE(std::filesystem::exists(shader)) << shader;
  const std::vector<Function> in_core = functions_of(contents(core));
  EXPECT_FALSE(in_core.empty()) << core;
  EXPECT_EQ(listing(in_core), listing(functions_of(contents(shader))))
      << "core/" << stem << ".cpp against shaders/" << stem << ".glsl";
}

// The core's plain-double files, which are no kernels, may share a stem with a shader's helper.
std::vector<std::string> pairs() {
  std::set<std::string> stems(PAIRS.begin(), PAIRS.end());
  std::error_code absent;  // this runs before main, also where other tests run without the sources
  for (const auto& entry : std::filesystem::directory_iterator(SOURCE / "core", absent)) {
    const std::string stem = entry.path().stem().string();
    if (entry.path().extension() != ".cpp" || !std::filesystem::exists(SOURCE / "shaders" / (stem + ".glsl"))) continue;
    if (contents(entry.path()).find("namespace CORE_NS {") != std::string::npos) stems.insert(stem);
  }
  return {stems.begin(), stems.end()};
}

INSTANTIATE_TEST_SUITE_P(Pairs, Twin, testing::ValuesIn(pairs()), [](const auto& pair) { return pair.param; });

// ---- the comparison itself: it must see what it is there for ----

const char* const CORE = R"(#include "core/x.h"
namespace CORE_NS {
// not_a_function(int a) { }
Real one(const Hand& hand, Vec3 p, Real radius) { return f({1, 2}); }
namespace {
struct Cell { int i; int size() const { return i; } };
constexpr std::array<int, 2> TABLE = {1, 2};
}  // namespace
Vec3 two(const Hand& hand, const Vessel& vessel, Real angle,
         Real& sine_out) {
  if (angle > 0) { sine_out = g(angle); }
  return Vec3(0);
}
Real declared_only(Real x);
}  // namespace CORE_NS
)";

const char* const SHADER = R"(#ifndef X_GLSL
#define X_GLSL
#define MACRO(a) { \
  a }
layout(set = 0, binding = 1) readonly buffer B { Real values[]; };
struct Cell { int i; };
const int TABLE[2] = {1, 2};
/* Real three(Real x) { } */
Real one(Vec3 p, Real radius) {
  for (int i = 0; i < 3; ++i) { }
  return 1;
}
#if OUTLINE_SOURCE == 0
Vec3 two(Real angle, out Real sine_out) { return Vec3(0); }
#else
Vec3 two(const in Real angle, out Real sine_out) { return Vec3(1); }
#endif
#endif
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, text.npos) << from;
  return at == text.npos ? text : text.replace(at, from.size(), to);
}

TEST(TwinExtractor, FindsDefinitionsWithTheirParameters) {
  EXPECT_EQ(listing(CORE), "one(p, radius)\ntwo(angle, sine_out)\n");
  EXPECT_EQ(listing(SHADER), listing(CORE));
}

TEST(TwinExtractor, SeesAMissingFunction) { EXPECT_NE(listing(replaced(SHADER, "Real one(", "Real other(")), listing(CORE)); }

TEST(TwinExtractor, SeesAnExtraFunction) {
  EXPECT_EQ(listing(std::string(SHADER) + "Real three() { return 3; }"), listing(CORE) + "three()\n");
}

TEST(TwinExtractor, SeesAnotherOrder) {
  EXPECT_EQ(listing("void a(int x) {} void b() {}"), "a(x)\nb()\n");
  EXPECT_EQ(listing("void b() {} void a(int x) {}"), "b()\na(x)\n");
}

TEST(TwinExtractor, SeesAnotherParameterName) { EXPECT_NE(listing(replaced(SHADER, "Real radius", "Real r")), listing(CORE)); }

TEST(TwinExtractor, SeesAnotherParameterOrder) {
  EXPECT_NE(listing(replaced(SHADER, "Vec3 p, Real radius", "Real radius, Vec3 p")), listing(CORE));
}

TEST(TwinExtractor, DropsContextOnlyInFront) {
  EXPECT_EQ(listing("void f(const Vessel& vessel, Real x, Hand hand) {}"), "f(x, hand)\n");
}

TEST(TwinExtractor, ReadsArraysDefaultsTemplatesAndVoid) {
  EXPECT_EQ(listing("int f(const std::array<int, 4>& lengths, Real angles[3], int n) noexcept {}"), "f(lengths, angles, n)\n");
  EXPECT_EQ(listing("int f(void) {}"), "f()\n");
  EXPECT_EQ(listing("int f(Real a, Real) {}"), "f(a, Real)\n");
}

}  // namespace
