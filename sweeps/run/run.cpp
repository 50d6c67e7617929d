// SPDX-License-Identifier: MIT
#include "sweeps/run/run.h"

#include <cstdint>
#include <functional>

#include "core/evaluator.h"
#include "core/meshes/vessel.h"
#include "host/open_backend.h"
#include "sweeps/run/auto_backend.h"
#include "sweeps/run/sweep.h"

namespace wholehand {
namespace {

void read_meshes(Scene& scene, const SweepOptions& options, const std::function<std::uint64_t()>& device_bytes) {
  if (!options.hooks.note) return load_meshes(scene, device_bytes);
  if (!has_meshes(scene)) return;  // findings on them are not notes: the other program asks for them where it wants
  MeshOptions mesh_options;
  mesh_options.is_quiet = true;
  mesh_options.most_bytes = largest_lattice(device_bytes());
  load_meshes(scene, mesh_options);
}

}  // namespace

ExitCode run_sweep(const Scene& given, const SweepOptions& options) {
  Scene scene = given;
  SweepOptions own = options;
  AutoBackend chosen(scene, own);
  const auto open = [&](const FieldSet& fields) {
    const Precision usual = own.on == "core" ? Precision::full : Precision::single;
    return open_backend(scene, fields, own.on, own.precision.value_or(usual), own.threads,
                        own.hooks.note ? host::CompileWatch() : show_compiling());
  };
  // by itself, so that a note comes before meshes that take long
  const auto device_bytes = [&] { return chosen.with_core_fallback([&] { return largest_buffer(own.on); }); };
  const SweepParts parts{
      [&](const FieldSet& fields) { return chosen.with_core_fallback([&] { return open(fields); }); },
      [&] { return make_core_evaluator(scene); },
      [&] { chosen.with_core_fallback([&] { read_meshes(scene, own, device_bytes); }); },
      [&](const Scene& other, const FieldSet& fields) { return open_backend(other, fields, "core", Precision::full, own.threads); },
  };
  return run_sweep(scene, own, parts);
}

ExitCode run_sweep(const Scene& scene, const SweepOptions& options, const SweepParts& parts) {
  return Sweep(scene, options, parts).run();
}

}  // namespace wholehand
