// SPDX-License-Identifier: MIT
#include "evidence/check/error_time.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "base/files/files.h"
#include "base/files/folder_files.h"
#include "base/files/pictures.h"
#include "base/numbers/parallel.h"
#include "base/system/interrupt.h"
#include "base/system/output.h"
#include "base/system/progress.h"
#include "base/system/version.h"
#include "base/text/printable.h"
#include "base/text/readable.h"
#include "core/planes.h"
#include "core/prepare.h"
#include "evidence/check/error_plot.h"
#include "evidence/check/error_table.h"
#include "host/device.h"

namespace wholehand {
namespace {

constexpr FolderTable ERROR_TIME_TABLES[] = {{"error-time.csv", "variant,backend,precision,"},
                                             {"error-time-grips.csv", "vessel,index,height_m,"},
                                             {"error-time.md", "# Error against run time"}};
constexpr const char* ERROR_TIME_PICTURES[] = {"error-time.svg", "error-time-force.svg"};

// What a device that is there can take part in, with notes on what it cannot.
void choose_device_part(const Scene& scene, const std::string& on, VariantChoice& choice, ErrorContext& context) {
  const auto devices = host::list_devices();
  const host::DeviceInfo& device = host::choose_device(devices, on);
  context.device = device.name;
  context.driver = device.driver;
  choice.device = true;
  choice.device_double = device.float64;
  if (!device.float64) context.notes.push_back(device.name + " has no double precision: Vulkan double is left out");
  choice.outline_copies = std::all_of(scene.vessels.begin(), scene.vessels.end(), [](const VesselData& vessel) {
    return prepare_vessel(vessel, vessel.has_cavity()).outline.size() <= MAX_OUTLINE;
  });
  choice.device_outlines = choice.outline_copies || !host::is_llvmpipe(device);
  choice.outline_copies = choice.outline_copies && host::is_llvmpipe(device);
  if (!choice.device_outlines) {
    context.notes.push_back(
        fmt::format("{} does not take outlines of more than {} elements: its variants with such an outline are left out",
                    device.name, MAX_OUTLINE));
  }
}

void check_no_mesh(const Scene& scene) {
  for (const VesselData& vessel : scene.vessels) {
    if (!vessel.mesh) continue;
    throw usage_error(at_place(
        vessel.mesh->place,
        fmt::format(
            "vessel '{}' is a mesh; error-time compares a lattice with an exact outline, so it takes only shapes and outlines",
            vessel.name)));
  }
}

ErrorContext error_context_of(const Scene& scene, const ErrorTimeOptions& options) {
  ErrorContext context;
  context.scene = scene.name.empty() ? "scene" : scene.name;
  context.version = version();
  context.seed = options.seed;
  context.quick = options.quick;
  context.efforts = has_effort(scene);
  context.vessels = scene.vessels.size();
  context.states = scene_fills(scene) * scene.tilts.size();
  return context;
}

MeasureOptions measure_options_of(const Scene& scene, const ErrorTimeOptions& options, int threads, InterruptGuard& interrupt) {
  MeasureOptions measure_options;
  measure_options.on = options.on;
  measure_options.threads = threads;
  measure_options.seed = options.seed;
  // For all vessels together, so that more of them do not take longer. Efforts take most of the time.
  const std::size_t grips = (options.quick ? 768 : 6144) / (has_effort(scene) ? 4 : 1);
  measure_options.grips = std::clamp<std::size_t>(grips / scene.vessels.size(), 64, 4096);
  if (options.quick) measure_options.run_seconds = 0.015;
  measure_options.stop = &interrupt.flag();
  return measure_options;
}

bool asks_for_one_grip(const GripsData& asked) {
  const auto is_fixed = [](const Axis& axis) { return axis.values.size() == 1; };
  return is_fixed(asked.height) && is_fixed(asked.azimuth) && is_fixed(asked.obliquity) && is_fixed(asked.roll) &&
         is_fixed(asked.offset) && is_fixed(asked.hand_scale);
}

void write_error_results(const std::string& output, const std::vector<ErrorRow>& rows, const ErrorMeasure& measure,
                         const ErrorContext& context) {
  const std::string folder = output.back() == '/' ? output : output + "/";
  const std::string report = error_report(rows, context);
  write_whole_file(folder + "error-time.csv", error_csv(rows, context), false);
  write_whole_file(folder + "error-time-grips.csv", error_grips_csv(measure.grips()), false);
  write_whole_file(folder + "error-time.md", report, false);
  // pictures of another scene beside these tables would mislead
  for (const char* name : ERROR_TIME_PICTURES) std::remove((folder + name).c_str());
  const auto pictures = front_pictures(folder, rows, context);
  const std::string complaint = write_pictures(front_files(pictures, rows));
  print(report + "\n");
  if (!complaint.empty()) print_note(complaint);
  std::string written = fmt::format("wrote {0}error-time.csv, {0}error-time-grips.csv, {0}error-time.md", folder);
  if (complaint.empty())
    for (const FrontPicture& picture : pictures) written += ", " + picture.file;
  print(one_line(written) + "\n");
}

}  // namespace

ExitCode run_error_time(const Scene& scene, const ErrorTimeOptions& options) {
  check_no_mesh(scene);
  make_output_folder(options.output);
  check_folder_files(options.output, "error-time", ERROR_TIME_TABLES, ERROR_TIME_PICTURES);
  InterruptGuard interrupt;
  VariantChoice choice;
  choice.quick = options.quick;
  choice.threads = thread_count(options.threads);
  ErrorContext context = error_context_of(scene, options);
  if (options.on != "core") choose_device_part(scene, options.on, choice, context);
  const MeasureOptions measure_options = measure_options_of(scene, options, choice.threads, interrupt);
  ErrorMeasure measure(scene, measure_options);
  context.grips = measure_options.grips * scene.vessels.size();
  context.feasible = measure.feasible();
  context.grazing = measure.grazing();
  const auto variants = error_variants(scene, choice);
  const auto rows = measure.measure(variants, [&](std::size_t k, const std::string& what) {
    show_status(fmt::format("{} of {}  {}", k + 1, variants.size(), what));
  });
  show_status("");
  if (interrupt.flag()) {
    print_note(fmt::format("interrupted while comparing and timing {}; nothing was written", counted(variants.size(), "variant")));
    return ExitCode::interrupted;
  }
  if (options.on == "core" && !rows.empty()) {
    context.device = rows.front().device;
    context.driver = rows.front().driver;
  }
  for (const std::string& note : measure.notes()) context.notes.push_back(note);
  if (asks_for_one_grip(scene.grips)) {
    context.notes.push_back(
        "every axis of [grips] is one number, so all grips are the same grip; give ranges to get useful figures");
  }
  write_error_results(options.output, rows, measure, context);
  return ExitCode::done;
}

}  // namespace wholehand
