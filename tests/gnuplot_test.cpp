#include "sweeps/gnuplot.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/support/result_reader.h"

namespace wholehand {
namespace {

std::string line_script(const std::string& file) {
  return gnuplot_style(300, 200) + gnuplot_output(file) + "plot '-' with lines title 'a line'\n0 0\n1 1\ne\nset output\n";
}

TEST(Gnuplot, DrawsOnItsOwnGround) {
  const TemporaryFolder folder;
  const std::string file = folder / "it's a line.svg";
  ASSERT_EQ(draw_with_gnuplot(line_script(file), {file}), "");
  const std::string svg = file_text(file);
  EXPECT_NE(svg.find("</svg>"), std::string::npos);
  EXPECT_NE(svg.find("a line"), std::string::npos);
  EXPECT_NE(svg.find("#ffffff"), std::string::npos);
  EXPECT_FALSE(file_exists(file + ".partial"));
}

TEST(Gnuplot, FailureIsASentenceAndLeavesNothing) {
  const TemporaryFolder folder;
  const std::string file = folder / "a.svg";
  EXPECT_NE(draw_with_gnuplot(line_script(file) + "no such command\n", {file}), "");
  EXPECT_FALSE(file_exists(file));
  EXPECT_FALSE(file_exists(file + ".partial"));
  const std::string path = std::getenv("PATH");
  setenv("PATH", folder.path().c_str(), 1);
  const std::string failure = draw_with_gnuplot(line_script(file), {file});
  setenv("PATH", path.c_str(), 1);
  EXPECT_NE(failure.find("gnuplot-nox"), std::string::npos) << failure;
}

TEST(Gnuplot, TextStaysText) { EXPECT_EQ(gnuplot_quoted("it's\n$(x)"), "'it''s $(x)'"); }

}  // namespace
}  // namespace wholehand
