// SPDX-License-Identifier: MIT
#include "sweeps/result/companions.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>
#include <vector>

#include "base/files/files.h"
#include "base/files/pictures.h"
#include "base/text/error.h"
#include "core/scene.h"
#include "sweeps/grips/glb.h"
#include "sweeps/lists/best.h"
#include "sweeps/result/grip_lists.h"
#include "sweeps/result/heat_map_plot.h"
#include "sweeps/result/mark.h"
#include "sweeps/result/output_names.h"

namespace wholehand::sweeps {

void check_best_glb(const Scene& scene, const Plan& plan, const OutputNames& names, int glb) {
  for (const std::string& part : list_file_parts(scene, plan)) {
    for (int rank = 1; rank <= glb; ++rank) {
      const std::string path = names.grip_glb(part, static_cast<std::size_t>(rank));
      check_not_the_scene(path, scene);
      check_overwrites_marked(path, GRIP_GLB_MARK, "glTF binary of wholehand's", "-o");
    }
  }
}

bool is_best_list(const std::string& path) { return has_mark(path, BEST_CSV_START); }

void check_companions(const Scene& scene, const OutputNames& names, bool best, bool pictures, int glb) {
  const auto check = [&scene](const std::string& path, std::string_view mark, const char* what) {
    check_not_the_scene(path, scene);
    check_overwrites_marked(path, mark, what, "-o");
  };
  const std::string other = names.result == names.stem ? names.stem + ".nc" : names.stem;
  if (begins_with(other, NETCDF4_START))
    throw usage_error(
        fmt::format("-o {}: {} exists, and its list and pictures have the same names; name another file", names.result, other));
  std::error_code not_there;
  if (std::filesystem::is_symlink(std::filesystem::symlink_status(names.partial, not_there)))
    throw usage_error(fmt::format("-o {}: is a link, and the sweep would replace it with a file; remove it", names.partial));
  // what check_room reserved and is not yet defined is zeros
  if (!begins_with(names.partial, std::string_view("\0\0\0\0\0\0\0\0", 8)))
    check_overwrites_kind(names.partial, NETCDF4_START, "partial result", "-o");
  check(names.mark, MARK_START, "progress mark of wholehand's");
  if (best) check(names.best, BEST_CSV_START, "list of wholehand's");
  for (const std::string& part : pictures ? file_name_parts(scene) : std::vector<std::string>())
    check(names.heat_map(part), PICTURE_MARK, "picture of wholehand's");
  if (glb > 0) check_best_glb(scene, Plan(scene, false), names, glb);
}

}  // namespace wholehand::sweeps
