// SPDX-License-Identifier: MIT
#include "sweeps/auto_backend.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <utility>

#include "core/parallel.h"
#include "host/device_info.h"
#include "sweeps/mark.h"
#include "sweeps/plan.h"
#include "sweeps/run_times.h"
#include "sweeps/sweep_result.h"
#include "system/cache_folder.h"
#include "system/files.h"
#include "system/output.h"
#include "system/readable.h"

namespace wholehand {
namespace {

std::string precision_text(const std::optional<Precision>& precision) {
  return !precision ? "" : *precision == Precision::single ? "float" : "double";
}

bool is_there(const std::string& path) {
  struct stat status {};
  return stat(path.c_str(), &status) == 0;
}

// Where the sweep of an unfinished or finished result ran, and its precision. False: no such result, or none that says so; whoever goes on
// with it says what is wrong.
bool origin_of(const OutputNames& names, std::string& on, Precision& precision) try {
  SweepMark mark;
  if (is_there(names.partial)) {
    if (!load_mark(names.mark, mark)) return false;
    on = mark.identity.at("backend") == "core" ? "core" : mark.identity.at("device");
    precision = mark.identity.at("precision") == "float" ? Precision::single : Precision::full;
    return true;
  }
  if (!is_there(names.result)) return false;
  const SweepResult result(names.result);
  on = result.origin().backend == "core" ? "core" : result.origin().device;
  precision = result.origin().precision;
  return true;
} catch (const std::exception&) {
  return false;
}

std::string cost_text(const CostEstimate& cost, const SweepTask& task) {
  const std::string source =
      cost.runs == 0 ? "a first guess" : fmt::format("the best of the last {} run{}", cost.runs, cost.runs == 1 ? "" : "s");
  return fmt::format("{} s and {} us a grip, so {} s, by {}", fixed_text(cost.fixed, 2), fixed_text(1e6 * cost.per_grip, 2),
                     fixed_text(cost.seconds(task.grips), 2), source);
}

}  // namespace

std::string precision_trouble(const host::DeviceInfo& device, const std::optional<Precision>& precision) {
  return precision == Precision::full && !device.float64 ? device.name + " has no double precision" : "";
}

AutoBackend::AutoBackend(const Scene& scene, SweepOptions& options) : options_(options), is_auto_(options.on == ON_AUTO) {
  if (is_auto_ && options.resume && resume(scene)) return;
  const std::string folder = cache_limit() > 0 ? cache_folder() : "";
  if (!folder.empty()) file_ = run_times_file(folder);
  try {
    const Plan plan(scene, false);
    task_ =
        sweep_task(scene, plan.grips() * scene.vessels.size(), thread_count(options.threads), precision_text(options.precision));
  } catch (const Error&) {
    // the sweep refuses it in its own words
    if (is_auto_) options_.on = "core";
    return;
  }
  keeps_times_ = !file_.empty() && !options.explain && !options.resume && options.glb == 0;
  if (is_auto_) decide();
}

bool AutoBackend::resume(const Scene& scene) {
  Precision precision{};
  const OutputNames names = output_names(options_.output.empty() ? default_output(scene) : options_.output);
  if (!origin_of(names, options_.on, precision)) return false;
  if (!options_.precision) options_.precision = precision;
  return true;
}

void AutoBackend::decide() {
  if (!file_.empty()) history_ = read_run_times(file_, file_trouble_);
  core_ = estimate(history_, machine_name(), task_, true, guess_core(task_));
  device_ = device_cost();
  scale_guess(task_, core_, device_);
  BackendChoice choice;
  if (no_device_.empty()) choice = choose_backend(task_, core_, device_);
  may_change_ = choice.on_device;
  options_.on = choice.on_device ? "vulkan" : "core";
  options_.choice = no_device_.empty() ? choice_line(task_, choice, core_, device_) : "chosen: core, since " + no_device_;
}

// Asks for the devices only where their cost is unknown or old and a device might be worth it: asking alone takes a twentieth of a second.
CostEstimate AutoBackend::device_cost() {
  const CostEstimate known = estimate(history_, machine_name(), task_, false, guess_device(task_, true));
  const bool is_known = known.runs > 0 && known.age < RUNS_TO_OLD;
  if (is_known || core_.seconds(task_.grips) <= QUICK_CORE) return known;
  try {
    const std::vector<host::DeviceInfo> devices = host::list_devices();
    const host::DeviceInfo& device = host::choose_device(devices, "vulkan");
    no_device_ = precision_trouble(device, options_.precision);
    if (device.name == known.device) return known;
    CostEstimate guess = guess_device(task_, device.kind == host::DeviceKind::cpu);
    guess.device = device.name;
    guess.age = known.age;
    return guess;
  } catch (const Error& error) {
    no_device_ = error.what();
    return known;
  }
}

void AutoBackend::take_core() {
  may_change_ = false;
  options_.on = "core";
  options_.choice = "";
}

void AutoBackend::say_on_core(const std::string& why) const {
  const std::string line = "on core, since the device does not work: " + why;
  options_.note ? options_.note(line) : say_note(line);
}

void AutoBackend::remember(const SweepTimes& times, std::uint64_t grips, const BackendInfo& info) {
  const bool is_core = info.backend == "core";
  if (!keeps_times_ || grips == 0 || (!is_core && options_.on != "vulkan")) return;
  std::string trouble;
  std::vector<RunTime> history = read_run_times(file_, trouble);  // another program may have added to it meanwhile
  if (trouble.starts_with("it is none")) return;
  RunTime run{machine_name(), kind_of(task_), is_core ? "core" : info.device, 0, grips, 0, times.kernels + times.writing};
  run.fixed = std::max(0.0, times.wall - run.growing);
  add_run(history, std::move(run));
  write_run_times(file_, history);
}

std::string AutoBackend::explanation() const {
  if (!is_auto_ || task_.grips == 0) return "";
  std::string text = fmt::format("how core or device was chosen, for {} ({})\n", counted(task_.grips, "grip"), kind_of(task_));
  text += "  core: " + cost_text(core_, task_) + "\n";
  text += no_device_.empty() ? "  device: " + cost_text(device_, task_) + "\n" : "  device: " + no_device_ + "\n";
  if (file_.empty()) return text + "  times of earlier sweeps are not kept, as there is no cache\n";
  return text + (file_trouble_.empty() ? "  times of earlier sweeps: " + file_ + "\n"
                                       : "  " + file_ + " is ignored: " + file_trouble_ + "\n");
}

}  // namespace wholehand
