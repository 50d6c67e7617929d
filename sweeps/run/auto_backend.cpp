// SPDX-License-Identifier: MIT
#include "sweeps/run/auto_backend.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <exception>

#include "base/numbers/parallel.h"
#include "base/system/output.h"
#include "base/text/error.h"
#include "base/text/readable.h"
#include "core/planes.h"
#include "shaders/layout.h"
#include "sweeps/plan/plan.h"
#include "sweeps/result/mark.h"
#include "sweeps/result/output_names.h"
#include "sweeps/result/sweep_result.h"

namespace wholehand::sweeps {
namespace {

bool is_there(const std::string& path) {
  struct stat status {};
  return stat(path.c_str(), &status) == 0;
}

// Where the sweep of an unfinished or finished result ran. Nothing: there is no such result, or it does not say; resuming it reports what is wrong.
std::optional<BackendChoice> begun_choice(const OutputNames& names, const std::optional<Precision>& asked) try {
  if (is_there(names.partial)) {
    SweepMark mark;
    if (!load_mark(names.mark, mark)) return std::nullopt;
    const std::string on = mark.identity.at("backend") == "core" ? "core" : mark.identity.at("device");
    return named_backend(on, asked.value_or(mark.identity.at("precision") == "float" ? Precision::single : Precision::full));
  }
  if (!is_there(names.result)) return std::nullopt;
  const SweepResult result(names.result);
  const SweepOrigin& origin = result.origin();
  return named_backend(origin.backend == "core" ? "core" : origin.device, asked.value_or(origin.precision));
} catch (const std::exception&) {
  return std::nullopt;
}

// Fitted to sweeps of 27,648 to 195,840 grips (docs/results, "Core or device").
struct Cost {
  double start;    // s: opening, lists, charts, the end of the file
  double grip;     // s of one thread: closed, at rest, examined, written
  double effort;   // the same, of the worst effort without states
  double reserve;  // and of the three that are kept on request
};
constexpr Cost CORE{0.25, 30e-6, 18.5e-6, 87e-6}, CPU_DRIVER{0.45, 13.5e-6, 14.5e-6, 47e-6};
constexpr double EFFORT_STATES = 100, RESERVE_STATES = 300;  // states at which the cost of efforts and of reserves doubles
constexpr double ROBUST = 1;                                 // s of one thread, for the deviations of the lists
constexpr double DOUBLE = 1.8;                               // cost of a grip in double over float, on a CPU driver
constexpr int DRIVER_THREADS = 32;                           // most that llvmpipe uses

double seconds_of(const Cost& cost, const Workload& work, int threads) {
  const auto states = static_cast<double>(work.states);
  double grip = cost.grip;
  if (work.has_efforts) grip += cost.effort * (1 + states / EFFORT_STATES);
  if (work.has_reserves) grip += cost.reserve * (1 + states / RESERVE_STATES);
  return cost.start + (grip * static_cast<double>(work.grips) + (work.is_robust ? ROBUST : 0)) / threads;
}

std::string about(double seconds) { return fmt::format("about {} s", fixed_text(seconds, seconds < 10 ? 1 : 0)); }

}  // namespace

Workload workload_of(const Scene& scene, const std::vector<const Variable*>& variables, std::uint64_t grips) {
  Workload work;
  work.grips = grips;
  work.states = scene_fills(scene) * scene.tilts.size();
  const FieldSet computed = make_field_set(variable_fields(variables), scene);
  work.is_robust = scene.robust.has_value();
  work.has_efforts = has_effort(scene);
  work.has_reserves = computed.has(FIELD_TIPS_WORST_EFFORT) || computed.has(FIELD_PUSH) || computed.has(FIELD_FRICTION_NEEDED);
  return work;
}

bool pays_for_device(const Workload& work, int threads) { return core_seconds(work, thread_count(threads)) >= 1; }

double core_seconds(const Workload& work, int threads) { return seconds_of(CORE, work, threads); }
double cpu_driver_seconds(const Workload& work, int threads, Precision precision) {
  Cost cost = CPU_DRIVER;
  if (precision == Precision::full)
    for (double* part : {&cost.grip, &cost.effort, &cost.reserve}) *part *= DOUBLE;
  return seconds_of(cost, work, std::min(threads, DRIVER_THREADS));
}

BackendChoice named_backend(const std::string& on, const std::optional<Precision>& precision) {
  return {on, precision.value_or(on == "core" ? Precision::full : Precision::single)};
}

BackendChoice choose_backend(const Workload& work, int threads, const std::optional<Precision>& precision,
                             const std::vector<host::DeviceInfo>& devices) {
  const Precision on_core = precision.value_or(Precision::full), on_device = precision.value_or(Precision::single);
  if (!pays_for_device(work, threads)) return {"core", on_core, "; so little work does not pay for a device (`--on vulkan`)"};
  const host::DeviceInfo& device = host::choose_device(devices, "vulkan");
  if (on_device == Precision::full && !device.float64) return {"core", on_core, "; " + device.name + " has no double precision"};
  const double core_time = core_seconds(work, thread_count(threads));
  const char* core_precision = on_core == Precision::single ? "float" : "double";
  const BackendChoice vulkan{"vulkan", on_device,
                             fmt::format("; the CPU core, {}, would take {} (`--on core`)", core_precision, about(core_time)),
                             on_core};
  if (device.kind != host::DeviceKind::cpu) return vulkan;
  if (!is_llvmpipe(device))
    return {"core", on_core, fmt::format("; {} is a CPU driver that was never timed (`--on vulkan`)", device.name)};
  const double driver_time = cpu_driver_seconds(work, thread_count(0), on_device);
  if (driver_time < core_time) return vulkan;
  return {"core", on_core,
          fmt::format("; {}, a CPU driver, would take {} once its kernels are compiled (`--on vulkan`)", device.name,
                      about(driver_time))};
}

BackendChoice choose_backend(const Workload& work, int threads, const std::optional<Precision>& precision) try {
  const bool may_choose = pays_for_device(work, threads);
  return choose_backend(work, threads, precision, may_choose ? host::list_devices() : std::vector<host::DeviceInfo>{});
} catch (const Error& error) {
  return {"core", precision.value_or(Precision::full), fmt::format("; {}", error.what())};
}

BackendChoice choose_backend(const Scene& scene, const SweepOptions& options) {
  if (options.on != ON_AUTO) return named_backend(options.on, options.precision);
  if (options.resume) {
    const std::string output = options.output.empty() ? default_output(scene) : options.output;
    if (const auto begun = begun_choice(output_names(output), options.precision)) return *begun;
  }
  try {
    const std::vector<const Variable*> variables = choose_variables(scene);
    const Plan plan(scene, keeps_vectors(variables));
    const Workload work = workload_of(scene, variables, plan.grips() * scene.vessels.size());
    return choose_backend(work, options.threads, options.precision);
  } catch (const Error&) {
    return named_backend("core", options.precision);  // the sweep refuses it in its own words
  }
}

BackendChoice with_core_fallback(const BackendChoice& choice, const SweepHooks& hooks,
                                 const std::function<void(const BackendChoice&)>& work) {
  std::string why;
  try {
    work(choice);
    return choice;
  } catch (const Error& error) {
    if (!choice.fallback_precision) throw;
    why = error.what();
  }
  const BackendChoice core{"core", *choice.fallback_precision};
  work(core);
  const std::string line = "on core, since the device does not work: " + why;
  hooks.note ? hooks.note(line) : print_note(line);
  return core;
}

}  // namespace wholehand::sweeps
