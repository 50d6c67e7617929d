// SPDX-License-Identifier: MIT
// Result files read back: every value in its place, and whatever is no finished result of its own scene refused in one line.
// sanitizers: address
#include "sweeps/result/sweep_result.h"

#include <gtest/gtest.h>
#include <netcdf.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>

#include "base/text/error.h"
#include "core/reader/ranges.h"
#include "core/reader/reader.h"
#include "tests/support/files.h"
#include "tests/support/refusal.h"
#include "tests/support/result_reader.h"
#include "tests/support/scenes.h"
#include "tests/support/sweep_results.h"

namespace wholehand::sweeps {
namespace {

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

// One line with the file in it, and exit code 2.
void expect_refused(const std::string& path, const std::string& gist, const std::function<void()>& act) {
  try {
    act();
    ADD_FAILURE() << "accepted; wanted: " << gist;
  } catch (const Error& error) {
    const std::string line = error.what();
    EXPECT_EQ(error.code, ExitCode::usage) << line;
    EXPECT_EQ(line.rfind(path, 0), 0u) << line;
    EXPECT_NE(line.find(gist), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  }
}

void expect_refused(const std::string& path, const std::string& gist) {
  expect_refused(path, gist, [&path] { SweepResult result(path); });
}

TEST(SweepResultTest, TellsWhereItComesFrom) {
  for (const Precision precision : {Precision::single, Precision::full}) {
    const SweptScene swept(RESULT_SCENE, precision);
    const SweepOrigin& origin = swept.result->origin();
    EXPECT_EQ(origin.scene, RESULT_SCENE);
    EXPECT_EQ(origin.version, "1.2.3");
    EXPECT_EQ(origin.backend, "core");
    EXPECT_EQ(origin.device, "core, 2 threads");
    EXPECT_EQ(origin.precision, precision);
    EXPECT_EQ(origin.wall_seconds, 12.5);
    EXPECT_EQ(origin.kernel_seconds, 3.25);
    EXPECT_EQ(origin.bytes, static_cast<double>(std::filesystem::file_size(swept.path)));
  }
}

TEST(SweepResultTest, HasTheVariablesThatWereKept) {
  const SweptScene swept(edited(RESULT_SCENE, "best = 5", "best = 5\nkeep = [\"touch_mask\", \"score\"]"));
  ASSERT_EQ(swept.result->variables().size(), 2u);
  EXPECT_STREQ(swept.result->variables()[0]->name, "score");
  EXPECT_STREQ(swept.result->variables()[1]->name, "touch_mask");
  EXPECT_EQ(swept.result->find("gap"), nullptr);
  EXPECT_EQ(swept.result->find("pouring_tilt"), nullptr) << "no variable of the grips";
}

TEST(SweepResultTest, AnyRangeOfEveryVariableIsAsInTheFile) {
  const SweptScene swept(
      edited(RESULT_SCENE, "best = 5",
             "best = 5\nkeep = [\"score\", \"reason\", \"touch_mask\", \"peak_feedback_force\", \"hold_force\", \"posed\"]"));
  const std::uint64_t grips = swept.plan->stored_grips();
  ASSERT_EQ(grips, 3u * 2 * 3 * 12);
  for (const Variable* variable : swept.result->variables()) {
    const std::vector<double> all = read_values(swept.path, variable->name);
    const std::size_t planes = variable_planes(*variable, swept.scene);
    ASSERT_EQ(all.size(), 2 * planes * grips);
    // whole axes, single grips, ranges that begin and end anywhere
    for (const auto& [first, count] : {std::pair<std::uint64_t, std::size_t>{0, grips},
                                       {0, 1},
                                       {grips - 1, 1},
                                       {5, 14},
                                       {12, 24},
                                       {11, 2},
                                       {35, 100},
                                       {36, 36},
                                       {1, grips - 1},
                                       {7, 0}}) {
      std::vector<double> values(count, -7);
      for (const std::size_t plane : {std::size_t{0}, planes / 2, planes - 1}) {
        swept.result->read(*variable, 1, plane, first, count, values.data());
        for (std::size_t i = 0; i < count; ++i)
          ASSERT_TRUE(same(values[i], all[(planes + plane) * grips + first + i])) << variable->name << " " << first << " + " << i;
      }
    }
  }
}

TEST(SweepResultTest, PickedGripsAreTheRangesOwn) {
  const SweptScene swept(RESULT_SCENE);
  const Variable& gap = *swept.result->find("gap");
  const std::vector<std::uint64_t> places{200, 3, 3, 0, 215, 100};
  const std::vector<double> picked = swept.result->pick(gap, 0, 0, places);
  ASSERT_EQ(picked.size(), places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    double value = 0;
    swept.result->read(gap, 0, 0, places[i], 1, &value);
    EXPECT_TRUE(same(picked[i], value)) << places[i];
  }
  EXPECT_TRUE(swept.result->pick(gap, 0, 0, {}).empty());
}

TEST(SweepResultTest, SobolPointsAreOneDimension) {
  const SweptScene swept(
      edited(RESULT_SCENE, "roll_deg = [-90, -30, 0]", "roll_deg = [-90, -30, 0]\nsampling = \"sobol\"\ncount = 70"));
  const std::vector<double> all = read_values(swept.path, "score");
  std::vector<double> values(30);
  swept.result->read(*swept.result->find("score"), 1, 0, 40, 30, values.data());
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(values[i], all[70 + 40 + i]);
}

TEST(SweepResultTest, ListsTheBestGripsInTheirOrder) {
  const SweptScene swept(RESULT_SCENE);
  for (std::size_t v = 0; v < 2; ++v) {
    const auto best = swept.result->best(v);
    ASSERT_EQ(best.size(), 5u);
    const std::vector<double> scores = read_values(swept.path, "score");
    for (std::size_t rank = 0; rank < best.size(); ++rank) {
      EXPECT_EQ(best[rank].score, scores[v * swept.plan->stored_grips() + best[rank].index]);
      if (rank > 0) {
        EXPECT_GE(best[rank - 1].score, best[rank].score);
      }
    }
  }
  EXPECT_TRUE(swept.result->lists_best());
}

TEST(SweepResultTest, AVesselThatNobodyCanHoldHasNoBest) {
  const SweptScene swept(edited(RESULT_SCENE, "diameter_mm = 70", "diameter_mm = 300"));
  EXPECT_TRUE(swept.result->best(0).empty());
  EXPECT_EQ(swept.result->best(1).size(), 5u);
  const SweptScene none(edited(RESULT_SCENE, "best = 5", "best = 0"));
  EXPECT_FALSE(none.result->lists_best());
  EXPECT_TRUE(none.result->best(1).empty());
}

TEST(SweepResultTest, TellsHeightsAndWherePouringStarts) {
  const SweptScene swept(RESULT_SCENE);
  EXPECT_EQ(swept.result->vessel_heights(), (std::vector<double>{0.095, 0.14}));
  const auto tilts = swept.result->pouring_tilts(1);
  ASSERT_EQ(tilts.size(), 2u);
  EXPECT_TRUE(std::isnan(tilts[0]));
  EXPECT_EQ(tilts[1], swept.source->core->pouring_tilt(1, 0.6));
}

TEST(SweepResultTest, WhatIsNoFinishedResultIsRefused) {
  const TemporaryFolder folder;
  const Scene scene = parse_scene(RESULT_SCENE, "test.toml");
  expect_refused(folder / "none.nc", "No such file");
  expect_refused(folder.path(), "is a directory");
  expect_refused("/dev/null", "is a device or pipe");
  std::ofstream(folder / "empty.nc").close();
  expect_refused(folder / "empty.nc", "is not a result file");
  std::ofstream(folder / "text.nc") << RESULT_SCENE;
  expect_refused(folder / "text.nc", "is a scene file (TOML) and not a result of a sweep");
  std::ofstream(folder / "classic.nc") << "CDF\x02";
  expect_refused(folder / "classic.nc", "wholehand session");
  write_result(scene, folder / "open.nc", Precision::full, false);
  expect_refused(folder / "open.nc", "was not finished; finish it with wholehand sweep --resume");
}

TEST(SweepResultTest, AnInterruptedSweepIsNamed) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a.nc.partial").close();
  expect_refused(folder / "a.nc", "a.nc.partial is of a sweep that was not finished");
}

TEST(SweepResultTest, TruncatedFilesAreRefusedAtEveryLength) {
  const SweptScene swept(RESULT_SCENE);
  const std::string whole = file_text(swept.path), path = swept.folder / "cut.nc";
  for (std::size_t k = 0; k < 24; ++k) {
    std::ofstream(path, std::ios::binary) << whole.substr(0, whole.size() * k / 24);
    EXPECT_THROW(SweepResult{path}, Error) << k;
  }
}

TEST(SweepResultTest, DamageOfEveryKindIsSurvived) {
  const SweptScene swept(edited(RESULT_SCENE, "best = 5", "best = 5\nkeep = [\"score\"]"));
  const std::string whole = file_text(swept.path), path = swept.folder / "damaged.nc";
  Random random(7);
  int refused = 0;
  for (int k = 0; k < 60; ++k) {
    std::string damaged = whole;
    for (int n = 0; n < 4;) {
      const auto at = static_cast<std::size_t>(random.uniform(0, static_cast<double>(whole.size())));
      if (whole[at] == 0) continue;  // mostly room that nothing is in
      damaged[at] = static_cast<char>(static_cast<int>(random.uniform(0, 256)));
      ++n;
    }
    std::ofstream(path, std::ios::binary) << damaged;
    try {
      SweepResult result(path);
      result.use(swept.scene, *swept.plan);
      result.best(0);
      std::vector<double> scores(swept.plan->stored_grips());
      result.read(*swept.result->find("score"), 1, 0, 0, scores.size(), scores.data());
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ExitCode::usage);
      ++refused;
    }
  }
  EXPECT_GT(refused, 5);
}

// A NetCDF-4 file with so much of a result as `make` adds.
std::string foreign_file(const TemporaryFolder& folder, const std::function<void(int file)>& make) {
  const std::string path = folder / "foreign.nc";
  std::filesystem::remove(path);
  int file = -1;
  EXPECT_EQ(nc_create(path.c_str(), NC_NETCDF4, &file), NC_NOERR);
  make(file);
  int id = -1;
  const bool has_checksums = nc_inq_varid(file, CHECKSUMS, &id) == NC_NOERR;
  EXPECT_EQ(nc_close(file), NC_NOERR);
  if (has_checksums) renew_checksums(path);
  return path;
}

// All that a file needs before its variables are read.
void put_texts(int file, const char* program) {
  int dim = -1, id = -1;
  nc_def_dim(file, CHECKSUMS, 4000, &dim);
  nc_def_var(file, CHECKSUMS, NC_CHAR, 1, &dim, &id);
  nc_def_var_chunking(file, id, NC_CONTIGUOUS, nullptr);
  const std::string room(4000, ' ');
  nc_put_var_text(file, id, room.data());
  nc_put_att_text(file, NC_GLOBAL, "program", std::string(program).size(), program);
  for (const char* name : {"version", "backend", "device", "driver", "precision"}) nc_put_att_text(file, NC_GLOBAL, name, 1, "x");
  nc_put_att_text(file, NC_GLOBAL, "scene", RESULT_SCENE.size(), RESULT_SCENE.data());
  const double seconds = 1;
  for (const char* name : {"wall_time_s", "kernel_time_s"}) nc_put_att_double(file, NC_GLOBAL, name, NC_DOUBLE, 1, &seconds);
}

TEST(SweepResultTest, FilesOfVersionsBefore04AreRefused) {
  const TemporaryFolder folder;
  const auto refusal = [&folder](const std::string& version) {
    const std::string path = foreign_file(folder, [&](int file) {
      put_texts(file, "wholehand");
      nc_put_att_text(file, NC_GLOBAL, "version", version.size(), version.data());
    });
    return refusal_line([&] { SweepResult result(path); });
  };
  const std::string line = "; this version reads files from 0.4.0 on: run the sweep again";
  EXPECT_EQ(refusal("0.1.1"), folder / "foreign.nc: written by version 0.1.1" + line);
  EXPECT_EQ(refusal("0.3.0"), folder / "foreign.nc: written by version 0.3.0" + line);
  EXPECT_EQ(refusal("0.4.0"), "");
  EXPECT_EQ(refusal("1.0.0"), "");
}

TEST(SweepResultTest, FilesOfOtherProgramsAreRefused) {
  const TemporaryFolder folder;
  expect_refused(foreign_file(folder, [](int) {}), "it lacks the attribute scene");
  expect_refused(foreign_file(folder, [](int file) { put_texts(file, "other"); }), "another program wrote it");
  // attributes of other types
  expect_refused(foreign_file(folder,
                              [](int file) {
                                put_texts(file, "wholehand");
                                const int number = 3;
                                nc_put_att_int(file, NC_GLOBAL, "wall_time_s", NC_INT, 1, &number);
                              }),
                 "it lacks the attribute wall_time_s");
}

TEST(SweepResultTest, VariablesOfAnotherShapeOrTypeAreRefused) {
  const TemporaryFolder folder;
  const Scene scene = parse_scene(RESULT_SCENE, "test.toml");
  const Plan plan(scene, false);
  const auto expect_unusable = [&](const std::string& gist, const std::function<void(int)>& make) {
    const std::string path = foreign_file(folder, [&](int file) {
      put_texts(file, "wholehand");
      make(file);
    });
    SweepResult result(path);
    expect_refused(path, gist, [&] {
      result.use(scene, plan);
      result.best(0);
    });
  };
  expect_unusable("lacks the variable vessel_height", [](int) {});
  const auto put_heights = [](int file, std::size_t vessels) {
    int dim = -1, id = -1;
    nc_def_dim(file, "vessel", vessels, &dim);
    nc_def_var(file, "vessel_height", NC_DOUBLE, 1, &dim, &id);
    return dim;
  };
  expect_unusable("does not have the 2 vessels", [&](int file) { put_heights(file, 3); });
  expect_unusable("score does not have the shape", [&](int file) {
    const int dim = put_heights(file, 2);
    int id = -1;
    nc_def_var(file, "score", NC_DOUBLE, 1, &dim, &id);
  });
  expect_unusable("score is not as a sweep writes it", [&](int file) {
    const int dim = put_heights(file, 2);
    int id = -1;
    nc_def_var(file, "score", NC_STRING, 1, &dim, &id);
  });
  expect_unusable("best_grip is not as a sweep writes it", [&](int file) {
    const int dim = put_heights(file, 2);
    int id = -1;
    nc_def_var(file, "best_grip", NC_INT64, 1, &dim, &id);
  });
}

TEST(SweepResultTest, AbsurdLengthsAreRefusedBeforeRoomIsMade) {
  static_assert(MOST_BEST == static_cast<std::size_t>(ranges::BEST.high) && MOST_VESSELS == ranges::LARGEST_VESSELS);
  const TemporaryFolder folder;
  const Scene scene = parse_scene(RESULT_SCENE, "test.toml");
  const Plan plan(scene, false);
  const auto file_of = [&](std::size_t vessels, std::size_t ranks) {
    return foreign_file(folder, [&](int file) {
      put_texts(file, "wholehand");
      int dims[2] = {-1, -1}, id = -1;
      nc_def_dim(file, "vessel", vessels, &dims[0]);
      nc_def_var(file, "vessel_height", NC_DOUBLE, 1, dims, &id);
      nc_def_dim(file, "rank", ranks, &dims[1]);
      const std::size_t chunk[2] = {1, 1};  // takes no room in the file
      for (const char* name : {"best_grip", "best_score"}) {
        nc_def_var(file, name, NC_DOUBLE, 2, dims, &id);
        nc_def_var_chunking(file, id, NC_CHUNKED, chunk);
      }
    });
  };
  const std::size_t absurd = std::size_t{1} << 50;
  const std::string many_ranks = file_of(2, absurd);
  SweepResult ranked(many_ranks);
  ranked.use(scene, plan);
  expect_refused(many_ranks, "best_grip lists 1125899906842624 grips per vessel, and a sweep lists at most 100000",
                 [&] { ranked.best(0); });
  const std::string many_vessels = file_of(65, 1);
  SweepResult peopled(many_vessels);
  expect_refused(many_vessels, "vessel_height is not as a sweep writes it", [&] { peopled.vessel_heights(); });
}

TEST(SweepResultTest, ABestGripThatTheSweepDidNotHaveIsRefused) {
  SweptScene swept(RESULT_SCENE);
  swept.change("best_grip", {1e9});
  expect_refused(swept.path, "names a grip that the sweep did not have", [&] { swept.result->best(0); });
}

TEST(SweepResultTest, AnotherSceneThanTheFilesOwnIsRefused) {
  SweptScene swept(RESULT_SCENE);
  Scene other = swept.scene;
  other.grips.roll.values.push_back(1);
  const Plan plan(other, false);
  expect_refused(swept.path, "does not have the shape that its own scene asks for", [&] { swept.result->use(other, plan); });
}

}  // namespace
}  // namespace wholehand::sweeps
