// SPDX-License-Identifier: MIT
#include "sweeps/run.h"

#include "core/evaluator.h"
#include "host/open_backend.h"
#include "objects/vessel.h"
#include "sweeps/sweep.h"

namespace wholehand {
namespace {

void read_meshes(Scene& scene, const SweepOptions& options) {
  const auto device_bytes = [&] { return largest_buffer(options.on); };
  if (!options.note) return load_meshes(scene, device_bytes);
  if (!has_meshes(scene)) return;  // what is found of them is no note: the other program asks for it where it wants to
  MeshOptions mesh_options;
  mesh_options.is_quiet = true;
  mesh_options.most_bytes = largest_lattice(device_bytes());
  load_meshes(scene, mesh_options);
}

}  // namespace

ExitCode run_sweep(const Scene& given, const SweepOptions& options) {
  Scene scene = given;
  const Precision precision = options.precision.value_or(options.on == "core" ? Precision::full : Precision::single);
  const SweepParts parts{
      [&](const FieldSet& fields) { return open_backend(scene, fields, options.on, precision, options.threads); },
      [&] { return make_core_evaluator(scene); },
      [&] { read_meshes(scene, options); },
      [&](const Scene& other, const FieldSet& fields) {
        return open_backend(other, fields, options.on, precision, options.threads);
      },
  };
  return run_sweep(scene, options, parts);
}

ExitCode run_sweep(const Scene& scene, const SweepOptions& options, const SweepParts& parts) {
  return Sweep(scene, options, parts).run();
}

}  // namespace wholehand
