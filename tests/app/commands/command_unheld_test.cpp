// SPDX-License-Identifier: MIT
// Messages of the built program for a canister that no hand can hold, and for one that a hand can.
// sanitizers: address
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/files/json.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "sweeps/plan/plan.h"
#include "tests/support/files.h"
#include "tests/support/program.h"
#include "tests/support/result_reader.h"

namespace wholehand {
namespace {

class CommandUnheld : public testing::Test {
 protected:
  // A canister with walls of `wall_mm` of steel: 20 mm are 5.5 kg, 1 mm is 0.4 kg.
  void write_scene(const char* wall_mm, double strength = 1, const char* scales = "1") {
    std::ofstream(folder / "a.toml") << "[[vessel]]\nname = \"canister\"\nshape = \"cylinder\"\ndiameter_mm = 75\nheight_mm = 180\n"
                                        "wall_mm = "
                                     << wall_mm << "\ndensity_kg_m3 = 7800\n[table]\n"
                                     << strengths(strength)
                                     << "[liquid]\nfills = [0, 1]\n[grips]\n"
                                        "height_fraction = { from = 0.3, to = 0.9, count = 4 }\n"
                                        "roll_deg = { from = -90, to = 0, count = 3 }\nhand_scale = "
                                     << scales << "\n[tilts]\ndeg = [0, 45, 90]\n";
  }
  // The default strengths times a factor.
  static std::string strengths(double factor) {
    std::string text = "[strength]\n";
    for (const auto& [digit, strength] :
         {std::pair{"thumb", 40.0}, {"index", 25.0}, {"middle", 35.0}, {"ring", 25.0}, {"little", 14.0}, {"palm", 80.0}})
      text += fmt::format("{}_N = {}\n", digit, factor * strength);
    return text;
  }
  Outcome sweep(const std::string& options = "") {
    return run("PROGRAM sweep " + (folder / "a.toml") + " --on core -o " + result + options + " 2>&1");
  }

  TemporaryFolder folder;
  std::string result = folder / "a.nc";
};

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST_F(CommandUnheld, WhereNoGripHoldsOneLineSaysWhatFails) {
  write_scene("20");
  const Outcome swept = sweep();
  ASSERT_EQ(swept.code, 0) << swept.output;
  const auto plausible = read_values(result, "plausible"), not_held = read_values(result, "not_held");
  std::size_t count = 0;
  for (std::size_t i = 0; i < not_held.size(); ++i) {
    count += not_held[i] == 1 ? 1 : 0;
    EXPECT_EQ(not_held[i] == 1, plausible[i] == 1) << i;
  }
  EXPECT_GT(count, 3u);
  EXPECT_TRUE(has(swept.output, "hold; " + std::to_string(count) + " not held, ")) << swept.output;
  EXPECT_TRUE(has(swept.output, "\ncanister: no grip holds it: the strength of the hand fails first. Nearest to holding is grip "))
      << swept.output;
  EXPECT_TRUE(has(swept.output, " times the strength")) << swept.output;
  EXPECT_TRUE(has(swept.output, "; `wholehand rank " + result + " --least-bad` lists such grips\n")) << swept.output;
  EXPECT_FALSE(has(swept.output, "\n  rank  ")) << "nothing ranks as good";
  const std::string list = file_text(folder / "a.best.csv");
  EXPECT_EQ(list.find('\n'), list.size() - 1) << list;

  const std::size_t at = swept.output.find("no grip holds it: ");
  const std::string line = swept.output.substr(at, swept.output.find("; `wholehand", at) - at);
  const Outcome ranked = run("PROGRAM rank " + result + " 2>&1");
  EXPECT_TRUE(has(ranked.output, "canister: " + line + "; --least-bad lists such grips\n  " + std::to_string(count) +
                                     " grips are feasible and plausible; of these " + std::to_string(count) + " not held\n"))
      << ranked.output;
  const Outcome least_bad = run("PROGRAM rank " + result + " --least-bad --best 3 -o " + (folder / "l.csv") + " 2>&1");
  ASSERT_EQ(least_bad.code, 0) << least_bad.output;
  EXPECT_TRUE(has(least_bad.output, "\n     1  0.000")) << least_bad.output;
  EXPECT_TRUE(has(least_bad.output, "canister: no grip holds; ")) << least_bad.output;
  const std::string listed = file_text(folder / "l.csv");
  EXPECT_TRUE(has(listed, ",held_margin,not_held,refined_score,")) << listed;
  EXPECT_TRUE(has(listed, ",1,,,,,,,")) << "not held, and so not refined: " << listed;
  const Outcome grip = run("PROGRAM grip " + result + " --vessel canister --rank 1 --list " + (folder / "l.csv"));
  EXPECT_TRUE(has(grip.output, ": the grip does not hold\n")) << grip.output;
  const Outcome unlisted = run("PROGRAM grip " + result + " --vessel canister --rank 1 2>&1");
  EXPECT_EQ(unlisted.code, 2);
  EXPECT_TRUE(has(unlisted.output, "lists 0 grips of canister; `wholehand rank " + result +
                                       " --least-bad -o LIST.csv`, where none holds, "
                                       "and --list LIST.csv show the nearest to holding\n"))
      << unlisted.output;
  const auto json =
      parse_json(run("PROGRAM grip " + result + " --vessel canister --rank 1 --json --list " + (folder / "l.csv")).output);
  EXPECT_EQ(json["not_held"], true);
  EXPECT_EQ(json["plausible"], true);
  EXPECT_EQ(json["score"], 0);
  EXPECT_LT(json["held_margin"], 1);
  EXPECT_NEAR(json["held_margin"].get<double>() * json["worst_effort"].get<double>(), 1, 1e-12);
  ASSERT_EQ(run("PROGRAM report " + result + " -o " + (folder / "p.html") + " 2>&1").code, 0);
  const std::string page = file_text(folder / "p.html");
  EXPECT_TRUE(has(page, "No grip holds it: the strength of the hand fails first."));
  EXPECT_TRUE(has(page, "no grip is feasible and plausible and holds"));
}

TEST_F(CommandUnheld, WhereSomeHoldTheListSaysByHowMuch) {
  write_scene("1");
  const Outcome swept = sweep();
  ASSERT_EQ(swept.code, 0) << swept.output;
  EXPECT_FALSE(has(swept.output, "no grip holds")) << swept.output;
  EXPECT_TRUE(has(swept.output, "\ncanister: grip 1 holds with ")) << swept.output;
  EXPECT_TRUE(has(run("PROGRAM rank " + result + " --wide").output, "  effort  margin  push N\n"));
  std::ifstream file(folder / "a.best.csv");
  std::string head, row;
  std::getline(file, head);
  std::getline(file, row);
  const auto cell = [&](const std::string& column) {
    std::vector<std::string> titles, cells;
    for (const auto& [line, words] : {std::pair{&head, &titles}, {&row, &cells}}) {
      std::size_t from = 0;
      for (std::size_t to = 0; to != std::string::npos; from = to + 1) {
        to = line->find(',', from);
        words->push_back(line->substr(from, to - from));
      }
    }
    for (std::size_t k = 0; k < titles.size(); ++k)
      if (titles[k] == column) return std::stod(cells.at(k));
    ADD_FAILURE() << column << " is not in " << head;
    return 0.0;
  };
  EXPECT_GT(cell("held_margin"), 1);
  EXPECT_EQ(cell("not_held"), 0);
  EXPECT_NEAR(cell("held_margin") * cell("worst_effort"), 1, 1e-6);
  const Outcome own = run("PROGRAM rank " + result + " 2>&1"), least_bad = run("PROGRAM rank " + result + " --least-bad 2>&1");
  EXPECT_EQ(own.output, least_bad.output) << "a list of grips that hold stays as it is";
  expect_error("rank " + result + " --where 'not_held_' ", 2, "the nearest is 'not_held'");
}

// Each of several hand scales has a verdict, also where the others hold.
TEST_F(CommandUnheld, AHandThatIsTooSmallHasItsOwnVerdict) {
  write_scene("4", 1, "[0.8, 1]");
  const Outcome swept = sweep();
  ASSERT_EQ(swept.code, 0) << swept.output;
  // the nearest one by hand
  const auto scales = read_values(result, "hand_scale"), efforts = read_values(result, "worst_effort");
  ASSERT_EQ(scales.size(), 2u);
  std::vector<double> least{1e9, 1e9};
  const Scene scene = read_scene_file(folder / "a.toml");
  const sweeps::Plan plan(scene, false);
  for (std::uint64_t grip = 0; grip < plan.grips(); ++grip) {
    double& known = least[plan.hand_scale_of(grip)];
    if (efforts[grip] < known) known = efforts[grip];
  }
  ASSERT_GT(least[0], 1);
  ASSERT_LT(least[1], 1);
  const std::string start = "\ncanister, hand scale 0.8: no grip holds it: ";
  const std::size_t at = swept.output.find(start);
  ASSERT_NE(at, std::string::npos) << swept.output;
  const std::string line = swept.output.substr(at + 1, swept.output.find('\n', at + 1) - at - 1);
  EXPECT_TRUE(has(line, "the strength of the hand fails first. Nearest to holding is grip ")) << line;
  EXPECT_TRUE(has(line, fmt::format("whose worst effort is {:.3f}. ", least[0]))) << line;
  EXPECT_TRUE(has(line, "hand scale 0.800), ")) << line;
  EXPECT_TRUE(has(line, " times the strength")) << line;
  EXPECT_TRUE(has(swept.output, "\ncanister, hand scale 1: grip 1 holds with ")) << swept.output;
}

// The line about the gate, or nothing.
std::string gate_line(const std::string& output) {
  const std::size_t at = output.find(" of the gate, where another backend may decide otherwise\n");
  if (at == std::string::npos) return "";
  const std::size_t begin = output.rfind('\n', at) + 1;
  return output.substr(begin, at - begin);
}

TEST_F(CommandUnheld, GripsThatAnotherBackendMayHoldOrNotAreCounted) {
  // so many plausible grips are within the tolerance of an effort of 1, by the formula of docs/method.md
  const auto by_hand = [&](double strength, double& half_width) {
    const double rounded = 256 * 0x1p-23 * 80 * strength / (9.81 * read_values(result, "empty_mass").at(0));
    half_width = (2.4e-3 + rounded) / 4;
    std::size_t count = 0;
    for (const double effort : read_values(result, "worst_effort")) count += std::abs(1 / (1 + effort) - 0.5) <= half_width ? 1 : 0;
    return count;
  };
  write_scene("1");
  Outcome swept = sweep();
  ASSERT_EQ(swept.code, 0) << swept.output;
  double half_width = 0;
  ASSERT_EQ(by_hand(1, half_width), 0u);
  EXPECT_EQ(gate_line(swept.output), "") << swept.output;
  EXPECT_EQ(gate_line(run("PROGRAM rank " + result).output), "");

  double least = 1e9;  // effort: with so much of the strength this grip just holds
  for (const double effort : read_values(result, "worst_effort"))
    if (effort < least) least = effort;
  write_scene("1", least);
  std::string line;
  for (const char* threads : {" --threads 1", " --threads 2", " --threads 3"}) {
    swept = sweep(threads);
    ASSERT_EQ(swept.code, 0) << swept.output;
    const std::size_t count = by_hand(least, half_width);
    ASSERT_GT(count, 0u);
    line = fmt::format("  {} within {:.2g} %", count == 1 ? "1 grip is" : std::to_string(count) + " grips are", 400 * half_width);
    EXPECT_EQ(gate_line(swept.output), line) << swept.output;
  }
  EXPECT_EQ(gate_line(run("PROGRAM rank " + result + " --best 1").output), line);
}

TEST_F(CommandUnheld, WithoutStrengthThereIsNoSuchGrip) {
  const std::string scene = folder / "no_efforts.toml";
  write_file(scene, file_text(find_scene("small")) + "\n[strength]\nefforts = false\n");
  ASSERT_EQ(run("PROGRAM sweep " + scene + " --on core --best 2 -o " + result + " >/dev/null").code, 0);
  expect_error("rank " + result + " --least-bad", 2, "--least-bad: needs efforts");
}

}  // namespace
}  // namespace wholehand
