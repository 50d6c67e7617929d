#include "sweeps/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "host/grip_backend.h"
#include "sweeps/compare.h"
#include "sweeps/domain.h"
#include "sweeps/plan.h"

namespace wholehand {
namespace {

constexpr std::size_t GRIPS_PER_VESSEL = 1536;

// Grips spread evenly over the plan; a step that shares no factor with the axes' lengths, so that every axis varies.
std::uint64_t sample_index(const Plan& plan, std::size_t i) {
  const std::uint64_t all = plan.grips();
  return all <= GRIPS_PER_VESSEL ? i : (i * 2654435761u + 12345u) % all;
}

std::vector<GripInput> sample_grips(const Plan& plan, std::size_t vessel) {
  const std::uint64_t count = std::min<std::uint64_t>(plan.grips(), GRIPS_PER_VESSEL);
  std::vector<GripInput> grips;
  for (std::size_t i = 0; i < count; ++i) grips.push_back(plan.grip(vessel, sample_index(plan, i)));
  return grips;
}

// Where a row is at its worst, as the options of `grip` (a state of the liquid: its fill and tilt).
std::string place_of(const Comparison& row, const Scene& scene, const Plan& plan) {
  const std::string& name = scene.vessels[row.vessel].name;
  if (row.compared == 0) return "-";
  if (row.kernel == "liquid") {
    const std::size_t tilts = scene.tilts.size();
    return fmt::format("{}, fill {:g}, tilt {:g} deg", name, scene.liquid->fills[row.grip / tilts],
                       degrees(scene.tilts[row.grip % tilts]));
  }
  const GripInput grip = plan.grip(row.vessel, sample_index(plan, row.grip));
  std::string place = fmt::format("{} --height-mm {:.9g}", name, grip.height * 1e3);
  const auto add = [&place](const char* option, double value, double usual) {
    if (value != usual) place += fmt::format(" {} {:.9g}", option, value);
  };
  add("--azimuth-deg", degrees(grip.azimuth), 0);
  add("--obliquity-deg", degrees(grip.obliquity), 0);
  add("--roll-deg", degrees(grip.roll), 0);
  add("--offset-mm", grip.offset * 1e3, 0);
  add("--hand-scale", grip.hand_scale, 1);
  return place;
}

void print_comparison(const std::string& title, const Scene& scene, const Comparer& comparer, const Plan& plan) {
  fmt::print("\n{}: {}\n", title, comparer.holds() ? "holds" : "DOES NOT HOLD");
  fmt::print("  {:<11} {:<18} {:>12} {:>12} {:<6} {:>9} {:>9} {:>8}  {}\n", "kernel", "quantity", "worst", "tolerance", "",
             "of its own", "compared", "outside", "worst at");
  for (const Comparison& row : comparer.rows()) {
    fmt::print("  {:<11} {:<18} {:>12.4g} {:>12.4g} {:<6} {:>9.3f} {:>9} {:>8}  {}\n", row.kernel, row.quantity, row.worst,
               row.tolerance, row.unit, row.worst_ratio, row.compared, row.outside, place_of(row, scene, plan));
  }
  fmt::print(
      "  {} grips; {} graze the glass and are left out; in {} a discrete outcome differs within the margin (at most 1 in 1,000 "
      "may)\n",
      comparer.grips(), comparer.grazing(), comparer.excluded());
}

}  // namespace

ExitCode run_check(const Scene& scene, const CheckOptions& options) {
  if (options.on == "core") throw usage_error("check: --on core is what the devices are compared with; name a Vulkan device");
  for (const std::string& line : domain_warnings(scene, Precision::single)) fmt::print(stderr, "wholehand: {}\n", line);
  const FieldSet fields = all_fields(scene);
  const std::shared_ptr<const Evaluator> core = make_core_evaluator(scene);
  const std::shared_ptr<const Evaluator> core_float = make_core_float_evaluator(scene);
  host::GripBackendOptions backend_options;
  backend_options.device = options.device;
  const Scene& device_scene = options.device_scene ? *options.device_scene : scene;
  const std::shared_ptr<const Evaluator> device_core = make_core_evaluator(device_scene);
  host::GripBackend on_float(device_scene, device_core, fields, options.on, backend_options);
  fmt::print("{}: {} ({}){}, against the core; up to {} grips of each vessel, every plane\n",
             scene.name.empty() ? "check" : scene.name, on_float.info().device, on_float.info().driver,
             on_float.info().is_cpu ? ", a CPU driver" : "", GRIPS_PER_VESSEL);
  std::fflush(stdout);
  std::unique_ptr<host::GripBackend> on_double;
  if (on_float.device().float64) {
    backend_options.precision = Precision::full;
    on_double = std::make_unique<host::GripBackend>(device_scene, device_core, fields, options.on, backend_options);
  }
  const Plan plan(scene, true);
  Comparer translation(scene, *core, allowance(Precision::single)), cost(scene, *core, float_against_double()),
      exact(scene, *core, allowance(Precision::full));
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    const auto grips = sample_grips(plan, v);
    const GatheredPlanes gpu = gather(on_float, v, grips), single = gather(*core_float, fields, v, grips),
                         full = gather(*core, fields, v, grips);
    translation.add(v, grips, gpu, single);
    cost.add(v, grips, single, full);
    const auto liquid_float = core_liquid(scene, *core_float, v), liquid = core_liquid(scene, *core, v);
    if (!scene.tilts.empty()) {
      translation.add_liquid(v, on_float.liquid(v), liquid_float);
      cost.add_liquid(v, liquid_float, liquid);
    }
    if (!on_double) continue;
    exact.add(v, grips, gather(*on_double, v, grips), full);
    if (!scene.tilts.empty()) exact.add_liquid(v, on_double->liquid(v), liquid);
  }
  print_comparison("device float against core float (is the translation right?)", scene, translation, plan);
  print_comparison("core float against core double (what does single precision cost?)", scene, cost, plan);
  if (on_double) {
    print_comparison("device double against core double", scene, exact, plan);
  } else {
    fmt::print("\nthe device has no double precision: the third comparison is left out\n");
  }
  if (translation.feasible() == 0) {
    fmt::print("\nno grip of the sample is feasible: nothing was compared\n");
    return ExitCode::no;
  }
  const bool device = translation.holds() && (!on_double || exact.holds()), holds = device && cost.holds();
  fmt::print("\n{}\n", holds    ? "the device computes what the core computes"
                       : device ? "the device computes what the core computes, but single precision costs this scene more than the "
                                  "tolerances; use --precision double"
                                : "the device does NOT compute what the core computes");
  return holds ? ExitCode::done : ExitCode::no;
}

}  // namespace wholehand
