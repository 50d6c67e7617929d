// SPDX-License-Identifier: MIT
// Error against run time as it is measured: the same each time, and the command.
// sanitizers: none
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "core/gather.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "evidence/check/error_measure.h"
#include "evidence/check/error_reference.h"
#include "evidence/check/error_table.h"
#include "evidence/check/error_variants.h"
#include "tests/support/files.h"
#include "tests/support/scenes.h"
#include "tests/support/vulkan_listener.h"

namespace wholehand {
namespace {

const char* const COLUMNS =
    "variant,backend,precision,threads,sdf,resolution,storage_bits,tolerance,effort_tolerance,points,left_out,"
    "seconds_per_grip,spread,memory_bytes,"
    "separation_um_median,separation_um_p999,separation_um_max,separation_um_worst_grip,"
    "posed_um_median,posed_um_p999,posed_um_max,posed_um_worst_grip,"
    "proxy_um_median,proxy_um_p999,proxy_um_max,proxy_um_worst_grip,"
    "closure_median,closure_p999,closure_max,closure_worst_grip,"
    "gap_um_median,gap_um_p999,gap_um_max,gap_um_worst_grip,"
    "volume_ml_median,volume_ml_p999,volume_ml_max,volume_ml_worst_grip,"
    "com_um_median,com_um_p999,com_um_max,com_um_worst_grip,"
    "torque_Nm_median,torque_Nm_p999,torque_Nm_max,torque_Nm_worst_grip,"
    "feedback_N_median,feedback_N_p999,feedback_N_max,feedback_N_worst_grip,"
    "hold_N_median,hold_N_p999,hold_N_max,hold_N_worst_grip,"
    "table_depth_um_median,table_depth_um_p999,table_depth_um_max,table_depth_um_worst_grip,"
    "self_depth_um_median,self_depth_um_p999,self_depth_um_max,self_depth_um_worst_grip,"
    "worst_effort_median,worst_effort_p999,worst_effort_max,worst_effort_worst_grip,"
    "tips_effort_median,tips_effort_p999,tips_effort_max,tips_effort_worst_grip,"
    "push_median,push_p999,push_max,push_worst_grip,"
    "friction_needed_median,friction_needed_p999,friction_needed_max,friction_needed_worst_grip,"
    "effort_bracket_median,effort_bracket_p999,effort_bracket_max,effort_bracket_worst_grip,"
    "touch_flips,touch_flips_outside_margin,feasible_flips,device,driver,seed";

// Cells of a CSV, quotes resolved.
std::vector<std::vector<std::string>> cells_of(const std::string& csv) {
  std::vector<std::vector<std::string>> rows(1, std::vector<std::string>(1));
  bool quoted = false;
  for (const char c : csv) {
    if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      rows.back().emplace_back();
    } else if (c == '\n' && !quoted) {
      rows.emplace_back(1);
    } else {
      rows.back().back() += c;
    }
  }
  rows.pop_back();
  return rows;
}

MeasureOptions few_grips(std::uint64_t seed = 1) {
  MeasureOptions options;
  options.on = "vulkan";
  options.seed = seed;
  options.grips = 60;
  options.runs = 1;
  options.run_seconds = 0;
  return options;
}

const ErrorVariant& find(const std::vector<ErrorVariant>& variants, const std::string& name) {
  const auto found = std::find_if(variants.begin(), variants.end(), [&](const ErrorVariant& v) { return v.name == name; });
  if (found == variants.end()) throw std::runtime_error("no variant " + name);
  return *found;
}

// ---- measuring ----

TEST(ErrorTime, RowsHaveTheirColumns) {
  const Scene scene = read_scene_file(find_scene("small"));
  ErrorMeasure measure(scene, few_grips());
  const auto variants = error_variants(scene, {true, 2, true, true, true, true});
  std::vector<ErrorRow> rows;
  for (const char* name : {"core double: 1 thread", "Vulkan float", "core double: grid 64^3 x 16 bits", "core double: pose rigged",
                           "core double: without liquid"})
    rows.push_back(measure.measure(find(variants, name)));
  ErrorContext context;
  context.seed = 7;
  context.states = 10;
  const auto cells = cells_of(error_csv(rows, context));
  ASSERT_EQ(cells.size(), rows.size() + 1);
  EXPECT_EQ(cells[0], cells_of(std::string(COLUMNS) + "\n")[0]);
  const auto cell = [&](std::size_t row, const std::string& column) {
    const auto at = std::find(cells[0].begin(), cells[0].end(), column);
    return cells[row + 1].at(static_cast<std::size_t>(at - cells[0].begin()));
  };
  for (std::size_t k = 0; k < rows.size(); ++k) {
    EXPECT_EQ(cells[k + 1].size(), cells[0].size());
    EXPECT_GT(std::stod(cell(k, "seconds_per_grip")), 0);
    EXPECT_GT(std::stod(cell(k, "memory_bytes")), 1000);
    EXPECT_EQ(cell(k, "seed"), "7");
    EXPECT_FALSE(cell(k, "device").empty());
    EXPECT_NE(cell(k, "gap_um_worst_grip").find(':'), std::string::npos);
  }
  EXPECT_EQ(cell(0, "tolerance"), "1e-09");
  EXPECT_EQ(cell(1, "backend") + cell(1, "precision") + cell(1, "threads"), "vulkanfloat");
  EXPECT_EQ(cell(2, "sdf") + cell(2, "resolution") + "x" + cell(2, "storage_bits"), "grid64x16");
  // another pose answers where the hand is otherwise, a scene without liquid what it weighs
  EXPECT_EQ(cell(3, "posed_um_max") + cell(3, "separation_um_max") + cell(3, "touch_flips"), "");
  EXPECT_FALSE(cell(3, "hold_N_max").empty());
  EXPECT_EQ(cell(4, "torque_Nm_max") + cell(4, "volume_ml_max"), "");
  EXPECT_FALSE(cell(4, "posed_um_max").empty());
  EXPECT_TRUE(std::isnan(rows[3].length_error()) && std::isnan(rows[4].force_error()));
  // what is exact is exact, and what is not is worse
  EXPECT_LT(rows[0].length_error(), 0.1);  // um: 1e-9 m, by the slopes of this scene's grips
  EXPECT_GT(rows[1].errors[ERROR_GAP].median, rows[0].errors[ERROR_GAP].median);
  EXPECT_GT(rows[2].errors[ERROR_GAP].median, rows[1].errors[ERROR_GAP].median);
  EXPECT_EQ(*rows[0].touch_flips, 0u);
  EXPECT_GT(rows[2].memory_bytes, rows[0].memory_bytes);
}

// The depth below the table is a height of the hand: it is compared where there is a table, and is as exact as where fingers rest.
// Fields that the scene lacks leave their cells empty.
TEST(ErrorTime, WholeHandsAreCompared) {
  Scene scene = three_beakers();
  scene.tilts.clear();
  const auto none = ErrorMeasure(scene, few_grips()).measure(error_variants(scene, {true, 1, false, false, false, false}).front());
  EXPECT_EQ(none.errors[ERROR_TABLE_DEPTH].compared, 0u);
  scene.table = TableData{};
  const auto variants = error_variants(scene, {false, 1, false, false, false, false});
  ErrorMeasure measure(scene, few_grips());
  const ErrorRow exact = measure.measure(find(variants, "core double: 1 thread")),
                 loose = measure.measure(find(variants, "core double: tolerance 1e-3 m"));
  const std::uint64_t compared = exact.errors[ERROR_TABLE_DEPTH].compared;
  EXPECT_EQ(compared, exact.errors[ERROR_SEPARATION].compared);
  EXPECT_GT(compared, 100u);
  EXPECT_LT(exact.errors[ERROR_TABLE_DEPTH].max, 0.1);  // um: two stop tolerances of 1e-9 m, by the slopes of the grips
  EXPECT_GT(loose.errors[ERROR_TABLE_DEPTH].max, 10);   // .. and of 1e-3 m
  EXPECT_LT(loose.errors[ERROR_TABLE_DEPTH].max, 1e5);
  EXPECT_EQ(exact.errors[ERROR_EFFORT].compared, 0u);  // without tilts no state
}

// A bracket of the tolerance's width holds the effort: no worst effort is further from the finest one than that. What holds with
// other contacts is an outcome, and a finger that rests a nanometer elsewhere moves an effort by a millionth.
TEST(ErrorTime, NoEffortIsWrongByMoreThanItsTolerance) {
  Scene scene = three_beakers();
  scene.strength.emplace();
  ErrorMeasure measure(scene, few_grips());
  const auto variants = error_variants(scene, {true, 1, false, false, false, false});
  std::vector<ErrorRow> rows;
  double before = 0;
  for (const char* tolerance : {"1e-5", "1e-3", "1e-2", "1e-1"}) {
    rows.push_back(measure.measure(find(variants, std::string("core double: effort tolerance ") + tolerance)));
    const ErrorFigures &error = rows.back().errors[ERROR_EFFORT], &bracket = rows.back().errors[ERROR_EFFORT_BRACKET];
    EXPECT_EQ(rows.back().variant.axis, SweptAxis::effort);
    EXPECT_EQ(rows.back().variant.effort_tolerance(), std::stod(tolerance));
    EXPECT_GT(error.compared, 50u);
    EXPECT_LE(error.max, std::stod(tolerance) + 1e-6) << tolerance;
    EXPECT_GT(error.max, before) << "coarser, and no better";
    before = error.max;
    EXPECT_GE(bracket.compared, error.compared);
    EXPECT_LE(bracket.max, std::stod(tolerance) * (1 + 1e-9)) << tolerance;
    EXPECT_GT(bracket.max, std::stod(tolerance) / 10) << "no tighter than asked";
    EXPECT_TRUE(std::isnan(rows.back().length_error())) << "no length depends on it";
    EXPECT_EQ(*rows.back().touch_flips, 0u);
  }
  EXPECT_EQ(measure.measure(find(variants, "core double: 1 thread")).errors[ERROR_EFFORT_BRACKET].compared, 0u);
  const std::string report = error_report(rows, {});
  EXPECT_NE(report.find("| core double: effort tolerance 1e-1 | "), report.npos) << report;
}

// The tolerance reaches a device's kernels. Its rounding alone is a hundredth of this one.
TEST(ErrorTime, ADeviceTakesTheToleranceOfEfforts) {
  Scene scene = three_beakers();
  scene.strength.emplace();
  const auto variants = error_variants(scene, {true, 1, true, false, true, true});
  const ErrorFigures error =
      ErrorMeasure(scene, few_grips()).measure(find(variants, "Vulkan float: effort tolerance 1e-1")).errors[ERROR_EFFORT];
  EXPECT_GT(error.compared, 20u);
  EXPECT_LE(error.p999, 0.1 + 1e-3);
  EXPECT_GT(error.max, 5e-3) << "the default's would be below 1e-3";
}

// Half the bytes a sample.
TEST(ErrorTime, MemoryTellsLatticesApart) {
  const Scene scene = scene_of({beaker1()});
  ErrorMeasure measure(scene, few_grips());
  const auto variants = error_variants(scene, {true, 1, false, false, false, false});
  const auto bytes = [&](const char* name) { return static_cast<double>(measure.measure(find(variants, name)).memory_bytes); };
  const double outline = bytes("core double: 1 thread");
  EXPECT_NEAR((bytes("core double: grid 64^3 x 32 bits") - outline) / (bytes("core double: grid 64^3 x 16 bits") - outline), 2,
              0.01);
}

// No variant is its own judge: what moves fingers, or stops before they touch, has its flips outside the margin.
TEST(ErrorTime, MarginIsNotTheVariantsOwnError) {
  const Scene scene = three_beakers();
  MeasureOptions options = few_grips();
  options.grips = 150;
  ErrorMeasure measure(scene, options);
  const auto variants = error_variants(scene, {false, 1, false, false, false, false});
  const auto row = [&](const std::string& name) { return measure.measure(find(variants, "core double: " + name)); };
  const ErrorRow loose = row("tolerance 1e-3 m"), tighter = row("tolerance 1e-4 m"), tight = row("tolerance 1e-6 m");
  EXPECT_GT(*loose.touch_flips, 100u);
  EXPECT_GT(*loose.touch_flips_outside, *loose.touch_flips / 2);
  EXPECT_GT(*loose.touch_flips_outside, *tighter.touch_flips_outside);
  EXPECT_GE(*tighter.touch_flips_outside, *tight.touch_flips_outside);
  EXPECT_EQ(*tight.touch_flips, 0u);
  ErrorVariant five_steps = find(variants, "core double: 8 steps");
  five_steps.options.trace_steps = five_steps.options.advance_steps = 5;
  const ErrorRow few = measure.measure(five_steps), base = row("1 thread");
  EXPECT_GT(*few.touch_flips_outside, 0u);
  EXPECT_EQ(*few.touch_flips_outside, *few.touch_flips);
  EXPECT_EQ(few.touch_margin, base.touch_margin);
  EXPECT_LT(base.touch_margin, 3e-9);
  const ErrorRow coarse = row("grid 32^3 x 32 bits"), fine = row("grid 128^3 x 32 bits");
  EXPECT_GT(coarse.touch_margin, 2 * fine.touch_margin);
  EXPECT_GT(fine.touch_margin, 1e-6);
  EXPECT_LT(coarse.touch_margin, 3e-3);
}

// Groups, and what is timed beside what, are of no account for errors.
TEST(ErrorTime, GroupsChangeNoError) {
  const Scene scene = read_scene_file(find_scene("small"));
  auto variants = error_variants(scene, {true, 1, true, false, true, true});
  std::erase_if(variants, [](const ErrorVariant& v) { return v.axis == SweptAxis::points || v.axis == SweptAxis::lattice; });
  variants.resize(6);
  const auto table = [&](std::size_t group, std::size_t bytes) {
    MeasureOptions options = few_grips();
    options.group = group;
    options.group_bytes = bytes;
    auto rows = ErrorMeasure(scene, options).measure(variants);
    EXPECT_EQ(rows.size(), variants.size());
    for (ErrorRow& row : rows) {
      EXPECT_GT(row.seconds_per_grip, 0) << row.variant.name;
      row.seconds_per_grip = row.spread = 0;
    }
    return error_csv(rows, {});
  };
  const std::string once = table(32, std::size_t(1) << 30);
  EXPECT_EQ(once, table(2, std::size_t(1) << 30));
  EXPECT_EQ(once, table(32, 1));
}

TEST(ErrorTime, StopsWhereItIsTold) {
  const Scene scene = read_scene_file(find_scene("small"));
  const auto variants = error_variants(scene, {true, 1, false, false, false, false});
  std::atomic<bool> stop = false;
  MeasureOptions options = few_grips();
  options.stop = &stop;
  ErrorMeasure measure(scene, options);
  const auto rows = measure.measure(variants, [&](std::size_t k, const std::string&) { stop = k == 2; });
  EXPECT_EQ(rows.size(), 3u);
}

// Two runs with one seed: the same errors to the bit; another seed: other grips.
TEST(ErrorTime, IsTheSameForOneSeed) {
  const Scene scene = read_scene_file(find_scene("small"));
  const auto variants = error_variants(scene, {true, 2, true, true, true, true});
  const auto table = [&](std::uint64_t seed) {
    ErrorMeasure measure(scene, few_grips(seed));
    std::vector<ErrorRow> rows;
    for (const char* name :
         {"core double: 2 threads", "core float: 2 threads", "Vulkan float", "Vulkan float: grid 64^3 x 32 bits"}) {
      rows.push_back(measure.measure(find(variants, name)));
      rows.back().seconds_per_grip = rows.back().spread = 0;
    }
    return error_csv(rows, {});
  };
  const std::string once = table(1);
  EXPECT_EQ(once, table(1));
  EXPECT_NE(once, table(2));
}

// ---- the command ----

#ifdef WHOLEHAND_PROGRAM

int code_of(const std::string& command, std::string* output = nullptr) {
  FILE* pipe = popen((std::string(WHOLEHAND_PROGRAM) + " " + command).c_str(), "r");
  std::array<char, 4096> buffer;
  for (std::size_t n; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    if (output) output->append(buffer.data(), n);
  const int status = pclose(pipe);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(ErrorTime, CommandWritesItsFiles) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "wholehand_error_time";
  std::filesystem::remove_all(folder);
  std::string output;
  EXPECT_EQ(code_of("error-time small --quick --on core --threads 1 --seed 5 -o " + folder.string(), &output), 0);
  EXPECT_NE(output.find("## The fastest variant under an error"), output.npos) << output;
  const std::string csv = file_text(folder / "error-time.csv");
  EXPECT_EQ(csv.substr(0, csv.find('\n')), COLUMNS);
  EXPECT_GT(cells_of(csv).size(), 15u);
  for (const char* name : {"error-time.svg", "error-time-force.svg", "error-time-grips.csv", "error-time.md"})
    EXPECT_GT(file_text(folder / name).size(), 500u) << name;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    EXPECT_EQ(entry.path().string().find(".partial"), std::string::npos) << entry.path();
  std::filesystem::remove_all(folder);
}

TEST(ErrorTime, InterruptLeavesNoFiles) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "wholehand_error_time_interrupted";
  std::filesystem::remove_all(folder);
  const std::string command =
      "error-time three_beakers --on core -o " + folder.string() + " >/dev/null 2>&1 & sleep 2; kill -INT $!; wait $!";
  EXPECT_EQ(code_of(command), 130);
  EXPECT_TRUE(std::filesystem::is_empty(folder));
  std::filesystem::remove_all(folder);
}

TEST(ErrorTime, CommandRefusesBadInput) {
  for (const char* arguments : {"", "-o ''", "--quick", "small -o /nowhere/at/all", "no_such_scene -o /tmp", "-o /tmp --seed x",
                                "-o /tmp --threads 0", "-o /tmp --on no_such_device"}) {
    std::string errors;
    EXPECT_EQ(code_of(std::string("error-time ") + arguments + " 2>&1 >/dev/null", &errors), 2) << arguments;
    EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 1) << errors;
  }
  const TemporaryFolder folder;
  std::ofstream(folder / "error-time.md") << "mine";
  std::string errors;
  EXPECT_EQ(code_of("error-time small --on core -o " + folder.path() + " 2>&1 >/dev/null", &errors), 2);
  EXPECT_NE(errors.find("error-time.md: is there and is no table of wholehand error-time"), std::string::npos) << errors;
  EXPECT_EQ(file_text(folder / "error-time.md"), "mine");
}

#endif

TEST(ErrorReference, EachJointCounts) {
  const Scene scene = read_scene_file(find_scene("small"));
  GripInput grip;
  grip.height = 55e-3;
  const ErrorReference reference(scene, {{grip}}, {});
  ASSERT_EQ(reference.feasible(), 1u);
  const auto core = make_core_evaluator(scene, reference_options());
  const GatheredPlanes exact = gather(*core, reference_fields(scene), 0, {grip});
  for (const auto& [field, quantity] : {std::pair{FIELD_POSED, ERROR_POSED}, {FIELD_PROXIES, ERROR_PROXY}})
    for (int value = 0; value < 3 * JOINT_COUNT; ++value) {
      GatheredPlanes moved = exact;
      moved.reals[exact.fields.plane[field] + value] += 5e-6;
      ErrorRow row;
      reference.compare({moved}, *core, row);
      EXPECT_NEAR(row.errors[quantity].max, 5, 1e-6) << value;
    }
}

}  // namespace
}  // namespace wholehand
