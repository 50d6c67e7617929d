// SPDX-License-Identifier: MIT
// Whatever a file holds, it is read as a mesh and checked, or refused: Error, with one line, is all that may come out.
#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "base/text/error.h"
#include "core/meshes/check.h"
#include "core/meshes/mesh.h"

namespace {

// A file in memory with these bytes, by the name under which it can be opened.
std::string file_of(const std::uint8_t* data, std::size_t size) {
  static const int file = memfd_create("mesh", 0);
  if (file < 0 || ftruncate(file, 0) != 0 || pwrite(file, data, size, 0) != static_cast<ssize_t>(size)) std::abort();
  return "/proc/self/fd/" + std::to_string(file);
}

// What every mesh that is read holds to.
void check_promises(const wholehand::TriangleMesh& mesh) {
  for (const wholehand::Triple& vertex : mesh.vertices)
    for (const double x : vertex)
      if (!std::isfinite(x)) std::abort();
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle)
      if (corner >= mesh.vertices.size()) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  wholehand::MeshData mesh;
  mesh.file = file_of(data, size);
  try {
    const wholehand::TriangleMesh triangles = read_mesh(mesh, "");
    check_promises(triangles);
    const wholehand::CheckedMesh checked = check_mesh(triangles, mesh.file);
    check_promises(checked.mesh);
    if ((checked.facts.has_sure_volume() && !(checked.facts.volume > 0)) || mesh_check_text(checked.facts).empty()) std::abort();
  } catch (const wholehand::Error& error) {
    const std::string_view line = error.what();
    const bool is_one_line = line.starts_with(mesh.file + ": ") && line.find('\n') == line.npos && line.size() < 1000;
    if (!is_one_line || error.code != wholehand::ExitCode::usage) std::abort();
  }
  return 0;
}
