// SPDX-License-Identifier: MIT
#include "system/gnuplot.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "system/files.h"
#include "tests/support/environment.h"
#include "tests/support/files.h"

namespace wholehand {
namespace {

std::string line_script(const std::string& file) {
  return gnuplot_style(300, 200) + gnuplot_output(file) + "plot '-' with lines title 'a line'\n0 0\n1 1\ne\nset output\n";
}

std::ptrdiff_t entries(const TemporaryFolder& folder) {
  return std::distance(std::filesystem::directory_iterator(folder.path()), {});
}

TEST(Gnuplot, DrawsOnItsOwnGround) {
  const TemporaryFolder folder;
  const std::string file = folder / "it's a line.svg";
  ASSERT_EQ(draw_with_gnuplot(line_script(file), {file}), "");
  const std::string svg = file_text(file);
  EXPECT_NE(svg.find("</svg>"), std::string::npos);
  EXPECT_NE(svg.find("a line"), std::string::npos);
  EXPECT_NE(svg.find("#ffffff"), std::string::npos);
  EXPECT_EQ(entries(folder), 1) << "nothing else is left";
}

TEST(Gnuplot, FailureIsASentenceAndLeavesNothing) {
  const TemporaryFolder folder;
  const std::string file = folder / "a.svg";
  EXPECT_NE(draw_with_gnuplot(line_script(file) + "no such command\n", {file}), "");
  EXPECT_EQ(entries(folder), 0);
  const ScopedVariable path("PATH", folder.path().c_str());
  const std::string failure = draw_with_gnuplot(line_script(file), {file});
  EXPECT_NE(failure.find("gnuplot-nox"), std::string::npos) << failure;
}

// One that leaves half a picture, reads nothing and stays: itself, or for a child of its own.
TEST(Gnuplot, IsStoppedWhereItHangs) {
  for (const char* hang : {"exec sleep 1000", "sleep 1000 & sleep 1000"}) {
    const TemporaryFolder folder;
    const std::string file = folder / "a.svg", stand_in = folder / "gnuplot";
    std::ofstream(stand_in) << "#!/bin/sh\nPATH=/usr/bin:/bin\nfor half in '" << folder.path()
                            << "'/*.new; do echo half >\"$half\"; done\n"
                            << hang << "\n";
    std::filesystem::permissions(stand_in, std::filesystem::perms::owner_all);
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);  // open in whatever the stand-in starts
    const ScopedVariable path("PATH", folder.path().c_str());
    const std::string script = line_script(file) + std::string(1 << 20, '\n');  // more than a pipe holds
    EXPECT_EQ(draw_with_gnuplot(script, {file}, std::chrono::milliseconds(1500)),
              "no pictures: gnuplot had not ended after 1.5 s and was stopped");
    EXPECT_EQ(entries(folder), 1) << "the stand-in alone";
    close(ends[1]);
    pollfd closed{ends[0], POLLIN, 0};
    EXPECT_EQ(poll(&closed, 1, 20000), 1) << "something of it still runs: " << hang;
    close(ends[0]);
  }
}

TEST(Gnuplot, MayEndBeforeItsInput) {
  const TemporaryFolder folder;
  const std::string file = folder / "a.svg";
  EXPECT_EQ(draw_with_gnuplot("exit\n" + std::string(1 << 20, '\n'), {file}), "no pictures: gnuplot failed to write " + file);
}

TEST(Gnuplot, WhatLiesAtTheTemporaryNameStays) {
  const TemporaryFolder folder;
  const std::string first = folder / "a.svg", second = folder / "b.svg", mine = folder / "mine";
  std::ofstream(mine) << "mine";
  const std::string link = temporary_name(second);
  std::filesystem::create_symlink(mine, link);
  EXPECT_EQ(draw_with_gnuplot(line_script(first) + line_script(second), {first, second}),
            "no pictures: cannot make " + link + ": File exists");
  EXPECT_EQ(file_text(mine), "mine");
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_EQ(entries(folder), 2);
}

TEST(Gnuplot, TextStaysText) { EXPECT_EQ(gnuplot_quoted("it's\n$(x)"), "'it''s $(x)'"); }

}  // namespace
}  // namespace wholehand
