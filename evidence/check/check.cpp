// SPDX-License-Identifier: MIT
#include "evidence/check/check.h"

#include <algorithm>
#include <functional>
#include <memory>

#include "base/system/progress.h"
#include "core/domain.h"
#include "evidence/check/check_sample.h"
#include "host/grip_backend.h"
#include "host/run_once.h"

namespace wholehand {
namespace {

// Where a row is at its worst.
CheckedQuantity located(const Comparison& row, const Scene& scene, const std::vector<CheckSample>& samples) {
  CheckedQuantity quantity{row, "", {}, {}};
  if (row.compared == 0 || row.worst == 0) return quantity;
  quantity.vessel = scene.vessels[row.vessel].name;
  if (row.kernel == "liquid") {
    const std::size_t tilts = scene.tilts.size();
    quantity.state = {scene.liquid ? vessel_fills(scene, scene.vessels[row.vessel])[row.grip / tilts] : 0,
                      scene.tilts[row.grip % tilts]};
  } else {
    quantity.grip = samples[row.vessel].grips[row.grip];
  }
  return quantity;
}

CheckedPair pair_of(const std::string& name, const std::string& question, const Comparer& comparer, const Scene& scene,
                    const std::vector<CheckSample>& samples) {
  CheckedPair pair;
  pair.name = name;
  pair.question = question;
  for (const Comparison& row : comparer.rows()) pair.quantities.push_back(located(row, scene, samples));
  pair.grips = comparer.grips();
  pair.feasible = comparer.feasible();
  pair.grazing = comparer.grazing();
  pair.excluded = comparer.excluded();
  pair.allowed = comparer.allowed();
  pair.holds = comparer.holds();
  return pair;
}

// The device in both precisions and the core in both, and what they are compared by.
class Checking {
 public:
  Checking(const Scene& scene, const CheckOptions& options)
      : scene_(scene),
        fields_(compared_fields(scene)),
        core_(make_core_evaluator(scene)),
        core_float_(make_core_float_evaluator(scene)),
        translation_(scene, *core_, allowance(Precision::single)),
        cost_(scene, *core_, float_against_double()),
        float_device_(scene, *core_, float_against_double()),
        exact_(scene, *core_, allowance(Precision::full)) {
    const Scene& device_scene = options.device_scene ? *options.device_scene : scene;
    const std::shared_ptr<const Evaluator> device_core = make_core_evaluator(device_scene);
    host::GripBackendOptions backend_options;
    backend_options.device = options.device;
    on_float_ = std::make_unique<host::GripBackend>(device_scene, device_core, fields_, options.on, backend_options);
    if (!on_float_->device().float64) return;
    backend_options.precision = Precision::full;
    on_double_ = std::make_unique<host::GripBackend>(device_scene, device_core, fields_, options.on, backend_options);
  }

  // Makes the device's kernels, which takes as long as its driver compiles.
  void make_kernels(std::size_t v, const std::vector<GripInput>& grips) {
    if (grips.empty()) return;
    gather(*on_float_, v, {grips.front()});
    if (on_double_) gather(*on_double_, v, {grips.front()});
  }

  std::size_t pairs() const { return on_double_ ? 3 : 2; }

  // Calls `done` after each comparison of the vessel's grips.
  void add(std::size_t v, const std::vector<GripInput>& grips, const std::function<void()>& done) {
    const GatheredPlanes single = gather(*core_float_, fields_, v, grips), full = gather(*core_, fields_, v, grips);
    const GatheredPlanes device = gather(*on_float_, v, grips);
    translation_.add(v, grips, device, single, full);
    done();
    cost_.add(v, grips, single, full, full);
    done();
    if (on_double_) {
      exact_.add(v, grips, gather(*on_double_, v, grips), full, full);
      done();
    }
    if (!translation_.outliers().empty()) float_device_.add(v, grips, device, full, full);  // whose fault that is
    if (!scene_.tilts.empty()) cost_.add_liquid(v, core_liquid(scene_, *core_float_, v), core_liquid(scene_, *core_, v));
  }

  void fill_report(CheckReport& report, const std::vector<CheckSample>& samples) const {
    const BackendInfo& info = on_float_->info();
    report.device = info.device;
    report.driver = info.driver;
    report.is_cpu = info.is_cpu;
    report.has_double = on_double_ != nullptr;
    report.translation = pair_of("device_float_core_float", "device float against core float (is the translation right?)",
                                 translation_, scene_, samples);
    report.cost = pair_of("core_float_core_double", "core float against core double (what does single precision cost?)", cost_,
                          scene_, samples);
    report.is_of_precision = is_of_precision(translation_, cost_, float_device_);
    if (on_double_)
      report.exact = pair_of("device_double_core_double", "device double against core double", exact_, scene_, samples);
  }

 private:
  const Scene& scene_;
  FieldSet fields_;
  std::shared_ptr<const Evaluator> core_, core_float_;
  std::unique_ptr<host::GripBackend> on_float_, on_double_;
  Comparer translation_, cost_, float_device_, exact_;
};

}  // namespace

std::vector<std::string> check_warnings(const Scene& scene) {
  std::vector<std::string> lines = domain_warnings(scene, Precision::single);
  for (std::string& line : lines) line += "; sweep with --precision double";
  return lines;
}

Error check_error(const Error& error) {
  const char* remedy = error.remedy == Remedy::core      ? "; sweep with --on core"
                       : error.remedy == Remedy::or_core ? ", or sweep with --on core"
                                                         : nullptr;
  return remedy ? Error(error.code, std::string(error.what()) + remedy) : error;
}

CheckReport check_scene(const Scene& scene, const CheckOptions& options) {
  if (options.on == "core")
    throw usage_error("check: --on core is the reference that devices are compared with; name a Vulkan device");
  CheckReport report;
  report.scene = scene.name;
  report.warnings = check_warnings(scene);
  const sweeps::Plan plan(scene, true);
  std::vector<CheckSample> samples;
  try {
    Checking checking(scene, options);
    std::uint64_t total = 0, done = 0;
    for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
      samples.push_back(check_sample(scene, plan, v));
      total += samples[v].grips.size() * checking.pairs();
    }
    checking.make_kernels(0, samples[0].grips);
    Progress progress(total, 0, "comparisons", options.is_quiet ? ProgressSink::none : progress_sink());
    for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
      const CheckSample& sample = samples[v];
      const std::string what = "comparing the grips of " + scene.vessels[v].name;
      progress.update(what, done);
      checking.add(v, sample.grips, [&] { progress.update(what, done += sample.grips.size()); });
      report.vessels.push_back({scene.vessels[v].name, sample.own, sample.grips.size() - sample.own});
    }
    for (const Precision precision : host::contracted_precisions(host::Device(options.on, options.device)))
      report.contracted.push_back(precision == Precision::single ? "float" : "double");
    checking.fill_report(report, samples);
  } catch (const Error& error) {
    throw check_error(error);
  }
  return report;
}

CheckVerdict verdict_of(const CheckReport& report) {
  if (report.translation.feasible == 0) return {false, "nothing was compared: no grip of the sample is feasible", ""};
  const bool in_float = report.translation.holds, in_double = report.exact && report.exact->holds;
  const bool double_fails = report.exact && !report.exact->holds;
  if (in_float && report.cost.holds && !double_fails) return {true, "the device computes what the core computes", ""};
  const char* remedy = in_double ? "sweep with --precision double, which holds" : "sweep with --on core";
  if (!in_float && !report.is_of_precision)
    return {false,
            in_double      ? "in float the device does NOT compute what the core computes"
            : double_fails ? "the device does NOT compute what the core computes, in float nor in double"
                           : "the device does NOT compute what the core computes, and has no double precision",
            remedy};
  if (!in_float || !report.cost.holds)
    return {false,
            std::string("single precision costs this scene more than the tolerances") +
                (in_double      ? ""
                 : double_fails ? ", and in double the device does NOT compute what the core computes"
                                : ", and the device has no double precision"),
            remedy};
  return {false, "in double the device does NOT compute what the core computes",
          "sweep with --precision float, which holds, or with --on core"};
}

}  // namespace wholehand
