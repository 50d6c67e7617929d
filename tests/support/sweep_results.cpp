// SPDX-License-Identifier: MIT
#include "tests/support/sweep_results.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <netcdf.h>
#include <unistd.h>

#include <filesystem>

#include "core/core_backend.h"
#include "core/reader/reader.h"
#include "sweeps/lists/hand_lists.h"
#include "sweeps/result/output_names.h"
#include "sweeps/result/result_file.h"

namespace wholehand {

const std::string RESULT_SCENE = R"toml(
[scene]
name = "cups"

[[vessel]]
name = "cup"  # <b>bold & "quoted"</b>
shape = "cylinder"
diameter_mm = 70
height_mm = 95
wall_mm = 1.5
guidance_mm = [[55, 0], [35, 180]]

[[vessel]]
name = "flask"
shape = "flask"
diameter_mm = 85
neck_mm = 34
height_mm = 140
wall_mm = 1.5
force_range_N = 2
guidance_mm = [[42, 90]]

[liquid]
fills = [0, 0.6]

[grips]
height_fraction = { from = 0.1, to = 0.95, count = 12 }
azimuth_deg = [0, 60, 120]
obliquity_deg = [-10, 10]
roll_deg = [-90, -30, 0]

[strength]
efforts = false

[tilts]
deg = [0, 45, 90, 135]

[output]
best = 5
apart_mm = 0
)toml";

void write_result(const Scene& scene, const std::string& path, Precision precision, bool has_ending) {
  const auto variables = sweeps::choose_variables(scene);
  const sweeps::Plan plan(scene, sweeps::keeps_vectors(variables));
  const std::shared_ptr<const Evaluator> core =
      precision == Precision::full ? make_core_evaluator(scene) : make_core_float_evaluator(scene);
  CoreBackend backend(core, scene, make_field_set(sweeps::variable_fields(variables), scene), precision, 2);
  const auto best_wanted = static_cast<std::size_t>(scene.output.best);
  const sweeps::ResultContents contents{scene,          plan,    variables,  sweeps::vessel_facts(scene, backend, *core),
                                        backend.info(), "1.2.3", best_wanted};
  const sweeps::OutputNames names = sweeps::output_names(path);
  sweeps::ResultFile file(names, contents, backend.fields(), sweeps::FileStart::reserved);
  sweeps::BestLists best;
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    sweeps::HandLists lists(plan, best_wanted, {});
    RunRequest request;
    request.vessel = v;
    request.last = plan.grips();
    request.best = plan.hand_scales() > 1 ? static_cast<std::size_t>(plan.grips()) : best_wanted;
    request.grips = [&plan](std::size_t w, std::uint64_t first, std::size_t count, GripInput* out) {
      plan.fill(w, first, count, out);
    };
    request.sink = [&file](const PlaneChunk& chunk) { file.write(chunk); };
    lists.offer(backend.run(request).best);
    for (std::size_t s = 0; s < plan.hand_scales(); ++s) {
      best.emplace_back();
      for (const Candidate& candidate : lists.sorted(s)) best.back().push_back(sweeps::bare_grip(plan, v, candidate));
    }
  }
  if (has_ending) file.write_ending(best, 12.5, 3.25);
  file.finish();
}

namespace {

void change_values(const std::string& path, const std::string& variable, const std::vector<double>& values) {
  int file = -1, id = -1, dims = 0;
  ASSERT_EQ(nc_open(path.c_str(), NC_WRITE, &file), NC_NOERR);
  EXPECT_EQ(nc_inq_varid(file, variable.c_str(), &id), NC_NOERR) << variable;
  nc_inq_varndims(file, id, &dims);
  std::vector<int> ids(dims);
  nc_inq_vardimid(file, id, ids.data());
  std::vector<std::size_t> lengths(dims), place(dims, 0);
  for (int k = 0; k < dims; ++k) nc_inq_dimlen(file, ids[k], &lengths[k]);
  for (const double value : values) {
    const int status = nc_put_var1_double(file, id, place.data(), &value);
    EXPECT_TRUE(status == NC_NOERR || status == NC_ERANGE) << nc_strerror(status);  // an infinity is out of range, and written
    for (int k = dims; k-- > 0;) {
      if (++place[k] < lengths[k]) break;
      place[k] = 0;
    }
  }
  EXPECT_EQ(nc_close(file), NC_NOERR);
  renew_checksums(path);
}

}  // namespace

void renew_checksums(const std::string& path) {
  const int file = open(path.c_str(), O_RDWR | O_CLOEXEC);
  EXPECT_NO_THROW(sweeps::write_checksums(file, path, sweeps::checksum_parts(path)));
  close(file);
}

std::string edited(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  if (at != std::string::npos) text.replace(at, from.size(), to);
  return text;
}

SweptScene::SweptScene(const std::string& text, Precision precision)
    : scene(parse_scene(text, "test.toml")), path(folder / "result.nc") {
  write_result(scene, path, precision);
  open();
}

void SweptScene::open() {
  result = std::make_unique<sweeps::SweepResult>(path);
  plan = std::make_unique<sweeps::Plan>(scene, sweeps::keeps_vectors(result->variables()));
  result->use(scene, *plan);
  source = std::make_unique<ReportSource>(ReportSource{*result, scene, *plan, make_core_evaluator(scene), ""});
}

GripInput SweptScene::best_grip(std::size_t vessel) const { return plan->grip(vessel, result->best(vessel).at(0).index); }

void SweptScene::change(const std::string& variable, const std::vector<double>& values) {
  source.reset();
  result.reset();
  change_values(path, variable, values);
  open();
}

}  // namespace wholehand
