// SPDX-License-Identifier: MIT
// The scene of a result file that an earlier version wrote.
#include "app/result_scene.h"

#include <gtest/gtest.h>
#include <netcdf.h>

#include "core/planes.h"
#include "system/version.h"
#include "tests/support/scene_texts.h"
#include "tests/support/sweep_results.h"

namespace wholehand {
namespace {

// The weights of a result of this scene whose file says that the version wrote it.
std::array<double, 6> weights_of(const std::string& text, const std::string& written_by) {
  const TemporaryFolder folder;
  const std::string path = folder / "result.nc";
  write_result(scene_from(text), path);
  int file = -1;
  EXPECT_EQ(nc_open(path.c_str(), NC_WRITE, &file), NC_NOERR);
  EXPECT_EQ(nc_put_att_text(file, NC_GLOBAL, "version", written_by.size(), written_by.data()), NC_NOERR);
  EXPECT_EQ(nc_close(file), NC_NOERR);
  renew_checksums(path);
  return effective_weights(whole_scene_of_result(SweepResult(path)));
}

TEST(ResultScene, HasTheDefaultWeightsOfTheVersionThatWroteIt) {
  EXPECT_EQ(weights_of(RESULT_SCENE, version()), effective_weights(scene_from(RESULT_SCENE)));
  EXPECT_EQ(weights_of(RESULT_SCENE, "0.2.0"), (std::array<double, 6>{0.20, 0.10, 0.15, 0.10, 0.15, 0.30}));
  EXPECT_EQ(weights_of(RESULT_SCENE, "0.1.1"), (std::array<double, 6>{0.30, 0.10, 0.20, 0.10, 0.15, 0.15}));
}

TEST(ResultScene, KeepsTheWeightsThatItsSceneNames) {
  const std::string text = edited(RESULT_SCENE, RESULT_TILTS, "[score]\ndepth = 0.5\n\n" + RESULT_TILTS);
  EXPECT_EQ(weights_of(text, "0.2.0"), (std::array<double, 6>{0.20, 0.10, 0.5, 0.10, 0.15, 0.30}));
  EXPECT_EQ(weights_of(text, version()), effective_weights(scene_from(text)));
}

}  // namespace
}  // namespace wholehand
