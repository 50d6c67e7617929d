// SPDX-License-Identifier: MIT
#include "sweeps/run/run.h"

#include <cstdint>

#include "base/system/output.h"
#include "core/evaluator.h"
#include "core/meshes/vessel.h"
#include "host/open_backend.h"
#include "sweeps/run/auto_backend.h"
#include "sweeps/run/sweep.h"

namespace wholehand {
namespace {

void read_meshes(Scene& scene, const SweepOptions& options, std::uint64_t device_bytes) {
  if (!options.hooks.note) return load_meshes(scene, [&] { return device_bytes; });
  MeshOptions mesh_options;  // findings are not notes: the other program asks for them where it wants
  mesh_options.is_quiet = true;
  mesh_options.most_bytes = largest_lattice(device_bytes);
  load_meshes(scene, mesh_options);
}

}  // namespace

ExitCode run_sweep(const Scene& given, const SweepOptions& options) {
  Scene scene = given;
  const auto note = options.hooks.note ? options.hooks.note : print_note;
  const SweepParts parts{
      [&](const BackendChoice& choice, const FieldSet& fields) {
        return open_backend(scene, fields, choice.on, choice.precision, options.threads,
                            options.hooks.note ? host::CompileWatch() : show_compiling());
      },
      [&] { return make_core_evaluator(scene); },
      [&](const BackendChoice& asked) {
        if (!has_meshes(scene)) return asked;
        std::uint64_t bytes = 0;
        // by itself, so that a note comes before meshes that take long
        const BackendChoice choice =
            with_core_fallback(asked, note, [&](const BackendChoice& here) { bytes = largest_buffer(here.on); });
        return with_core_fallback(choice, note, [&](const BackendChoice& here) {
          read_meshes(scene, options, here.on == choice.on ? bytes : largest_buffer(here.on));
        });
      },
      [&](const Scene& other, const FieldSet& fields) {
        return open_backend(other, fields, "core", Precision::full, options.threads);
      },
  };
  return run_sweep(scene, options, choose_backend(scene, options), parts);
}

ExitCode run_sweep(const Scene& scene, const SweepOptions& options, const SweepParts& parts) {
  return run_sweep(scene, options, named_backend(options.on, options.precision), parts);
}

ExitCode run_sweep(const Scene& scene, const SweepOptions& options, const BackendChoice& choice, const SweepParts& parts) {
  return Sweep(scene, options, choice, parts).run();
}

}  // namespace wholehand
