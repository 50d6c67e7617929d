// SPDX-License-Identifier: MIT
#include "sweeps/run/resume.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include "base/system/version.h"
#include "base/text/error.h"
#include "base/text/readable.h"
#include "base/text/text.h"
#include "core/meshes/vessel.h"
#include "sweeps/result/output_names.h"
#include "sweeps/result/sweep_result.h"
#include "sweeps/run/code_id.h"

namespace wholehand::sweeps {

void check_complete(const std::string& result, const Scene& scene, bool on_core, Precision precision,
                    const std::vector<const Variable*>& variables) {
  const SweepResult there(result);
  const SweepOrigin& origin = there.origin();
  const auto refuse_for = [&result](const std::string& why) {
    throw usage_error(
        fmt::format("--resume: {} is complete, but {}; name another file, or start again without --resume", result, why));
  };
  const auto refuse = [&refuse_for](const std::string& what) { refuse_for("has another " + what); };
  there.check_all();
  if (origin.scene != scene.text) refuse("text of the scene");
  Scene read = scene;
  const std::string refusal = reload_meshes(read, scene.file, origin.mesh_keys, origin.mesh_lattices, true);
  if (!refusal.empty()) refuse_for(refusal);
  if ((origin.backend == "core") != on_core) refuse("backend: " + origin.backend);
  if (origin.precision != precision) refuse(origin.precision == Precision::single ? "precision: float" : "precision: double");
  for (const Variable* variable : variables) {
    if (!there.find(variable->name)) refuse(fmt::format("set of variables: it lacks {}", variable->name));
  }
}

std::map<std::string, std::string> sweep_identity(const Scene& scene, const Plan& plan, const BackendInfo& info, std::size_t best,
                                                  const std::vector<const Variable*>& variables) {
  std::vector<std::string> names;
  for (const Variable* variable : variables) names.push_back(variable->name);
  return {{"text of the scene", scene.text},
          {"version", version()},
          {"code", code_id()},  // other code may give other bits
          {"backend", info.backend},
          // the core gives the same on any number of threads
          {"device", info.backend == "core" ? "core" : info.device},
          {"driver", info.driver},
          {"precision", info.precision == Precision::single ? "float" : "double"},
          {"number of best grips", std::to_string(best)},
          {"number of grips", fmt::format("{} x {} x {}", scene.vessels.size(), plan.grips(), plan.copies())},
          {"set of meshes", mesh_keys(scene)},
          {"set of variables", joined(names, " ")}};
}

bool load_usable_mark(const OutputNames& names, const std::map<std::string, std::string>& identity, const MarkBounds& bounds,
                      SweepMark& mark, std::string& note) {
  struct stat partial {};
  if (stat(names.partial.c_str(), &partial) != 0 || !load_mark(names.mark, mark)) return false;
  check_identity(names.partial, mark, identity);
  check_progress(names.mark, mark, bounds);
  if (has_structure(names.partial, mark)) return true;
  note = fmt::format("{} is damaged: it changed after the progress mark was written", names.partial);
  return false;
}

std::string lost_line(const OutputNames& names) {
  struct stat partial {};
  SweepMark earlier;
  try {
    if (stat(names.partial.c_str(), &partial) != 0 || !load_mark(names.mark, earlier)) return "";
  } catch (const Error&) {
    return "";  // nothing could have gone on from there
  }
  std::uint64_t kept = 0;
  for (const VesselProgress& vessel : earlier.vessels) kept += vessel.done;
  if (kept == 0) return "";
  return fmt::format("{} held {} of an interrupted sweep; this sweep starts again without them (--resume keeps them)",
                     names.partial, counted(kept, "grip"));
}

}  // namespace wholehand::sweeps
