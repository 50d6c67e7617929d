// SPDX-License-Identifier: MIT
// What the built program prints and draws for people has numbers as they are read.
// sanitizers: none (it runs the program, for its words)
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <string>
#include <vector>

#include "tests/support/files.h"
#include "tests/support/program.h"

#ifdef WHOLEHAND_PROGRAM

namespace {

using wholehand::file_text;
using wholehand::Outcome;
using wholehand::run;
using wholehand::TemporaryFolder;
using wholehand::write_file;

// What is read of a page or a picture.
std::string visible_text(const std::string& markup) {
  std::string text;
  for (std::size_t at = 0; at < markup.size();) {
    if (markup[at] == '<') {
      const bool is_style = markup.compare(at, 6, "<style") == 0, is_source = markup.compare(at, 4, "<pre") == 0;
      at = markup.find(is_style ? "</style>" : is_source ? "</pre>" : ">", at);
      if (at == std::string::npos) break;
      at = markup.find('>', at) + 1;
      text += ' ';
    } else if (markup.compare(at, 2, "\u00a0") == 0) {
      text += ' ';
      at += 2;
    } else {
      text += markup[at++];
    }
  }
  return text;
}

void expect_readable(const std::string& text, const std::string& what) {
  struct Forbidden {
    const char *pattern, *why;
  };
  for (const auto& [pattern, why] :
       {Forbidden{"-0(\\.0*)?(?![0-9.eE])(?!-)", "zero has no sign"},
        {"(^|[ (])1 (grips|vessels|states|ticks|fingers|points|fills|values|triangles|elements|people)\\b", "one is one"},
        {"[0-9] ml\\b", "the unit is mL"},
        {"(^|[^0-9])[0-9]{1,3}(( |\u2009|\u202f)[0-9]{3})+ (grips|states|ticks|samples)", "thousands have commas"},
        {"[0-9]{5,} (grips|states|ticks|values)", "thousands have commas"},
        {"(^|[ (:])-?\\.[0-9]", "a number begins with a digit"},
        {"[0-9]\\.[0-9]{4,} (%|mL)", "more digits than the scene has"}}) {
    std::smatch found;
    const std::regex forbidden(pattern);
    for (std::size_t begin = 0, end; begin < text.size(); begin = end + 1) {
      end = std::min(text.find('\n', begin), text.size());
      const std::string line = text.substr(begin, std::min<std::size_t>(end - begin, 2000));
      EXPECT_FALSE(std::regex_search(line, found, forbidden)) << what << ": " << why << ": '" << found.str() << "' in\n" << line;
    }
  }
}

std::string scene_text(const std::string& rolls) {
  return "[scene]\nname = \"bench\"\n[[vessel]]\nname = \"cup\"\nshape = \"cylinder\"\ndiameter_mm = 75\nheight_mm = 105\n"
         "wall_mm = 1.8\n[liquid]\nfills_ml = [0, 250]\n[grips]\nheight_mm = [50]\nobliquity_deg = [-10]\nroll_deg = " +
         rolls + "\n[tilts]\ndeg = [0, 22.5, 45]\n[strength]\n";
}

TEST(ReadableOutput, OfEveryCommandThatPrintsNumbers) {
  const TemporaryFolder folder;
  write_file(folder / "many.toml", scene_text("[-60, -30]"));
  write_file(folder / "one.toml", scene_text("[-60]"));
  const std::string in = "cd " + folder.path() + " && PROGRAM ";
  for (const char* command :
       {"sweep many.toml --on core -o many.nc", "sweep one.toml --on core -o one.nc", "rank many.nc", "rank one.nc --best 1",
        "report many.nc", "report one.nc", "grip many.nc --vessel cup --rank 1 --svg grip.svg",
        "grip many.toml --vessel cup --height-mm 50 --fill-ml 100 --tilt-deg 0 30", "live --no-clock --seconds 3 --record live.nc",
        "session live.nc -o session", "scenes"}) {
    const Outcome outcome = run(in + command + " 2>&1");
    EXPECT_EQ(outcome.code, 0) << command << "\n" << outcome.output;
    expect_readable(outcome.output, command);
  }
  for (const char* page : {"many.html", "one.html", "grip.svg", "many.cup.svg", "session/session.svg"}) {
    const std::string text = file_text(folder / page);
    EXPECT_FALSE(text.empty()) << page;
    expect_readable(visible_text(text), page);
  }
}

// 250 mL are a share of a cup that nobody asked for; and where every tilt is safe, more than the last was not asked.
TEST(ReadableOutput, HasTheUnitsOfTheSceneAndTheEndOfARange) {
  const TemporaryFolder folder;
  write_file(folder / "one.toml", scene_text("[-60]"));
  const std::string in = "cd " + folder.path() + " && PROGRAM ";
  const Outcome swept = run(in + "sweep one.toml --on core -o one.nc 2>&1");
  EXPECT_NE(swept.output.find("bench: 1 grip of 1 vessel, 6 states each\n"), std::string::npos) << swept.output;
  EXPECT_NE(swept.output.find(" 45+ "), std::string::npos) << swept.output;
  const Outcome grip = run(in + "grip one.nc --vessel cup --rank 1 2>&1");
  EXPECT_NE(grip.output.find("over all tilts, 250 mL: peak force"), std::string::npos) << grip.output;
  EXPECT_NE(grip.output.find("safe at every tilt, up to 45 deg"), std::string::npos) << grip.output;
  EXPECT_EQ(grip.output.find("fill 0."), std::string::npos) << grip.output;
  run(in + "report one.nc");
  const std::string page = visible_text(file_text(folder / "one.html"));
  EXPECT_NE(page.find("with the vessel filled with 250 mL"), std::string::npos);
  EXPECT_EQ(page.find("60.5026"), std::string::npos);
}

}  // namespace

#endif
