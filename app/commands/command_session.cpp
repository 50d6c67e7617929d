// SPDX-License-Identifier: MIT
// wholehand session: statistics of a recording, and of recordings of several people together.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "app/commands/commands.h"
#include "app/commands/session_study.h"
#include "app/commands/validators.h"
#include "app/program/values.h"
#include "base/files/files.h"
#include "base/files/folder_files.h"
#include "base/files/pictures.h"
#include "base/system/output.h"
#include "device/recordings/grasp_collector.h"
#include "device/recordings/grip_scatter.h"
#include "device/recordings/session_plot.h"
#include "device/recordings/session_report.h"

namespace wholehand {
namespace {

struct SessionArguments {
  std::vector<std::string> recordings;
  std::string folder, seed;
  bool json = false, study = false;
};

constexpr FolderTable TABLES[] = {{"session.csv", "grasp,vessel,start_s,"}, {"states.csv", "start_s,duration_s,state,vessel\n"}};
constexpr const char* PICTURE = "session.svg";

// The tables, and the picture if there is something to draw. Returns what could not be drawn, and why.
std::string write_session_files(const std::string& folder, const device::Recording& recording,
                                const device::SessionReport& report) {
  const std::string picture = folder + "/" + PICTURE;
  const bool has_own_picture = has_mark(picture, PICTURE_MARK);
  write_whole_file(folder + "/session.csv", device::grasps_csv(report), false);
  write_whole_file(folder + "/states.csv", device::states_csv(report), false);
  if (has_own_picture) std::remove(picture.c_str());  // of another recording
  return recording.ticks.empty() ? "" : write_pictures({{picture, device::session_picture(recording, report)}});
}

// Throws Error (usage) if a recording is named twice: each counts once.
void check_different(const std::vector<std::string>& paths) {
  std::error_code unknown;
  for (std::size_t k = 0; k < paths.size(); ++k)
    for (std::size_t other = 0; other < k; ++other)
      if (std::filesystem::equivalent(paths[other], paths[k], unknown))
        throw usage_error(fmt::format("{}: is named twice; each recording counts once", paths[k]));
}

// `grip` of a GraspReport mirrors azimuth, roll and offset of a left hand.
bool is_left_handed(const device::RecordingInfo& info) {
  return !info.scene_text.empty() && device::scene_of_recording(info).hand.handedness == Handedness::left;
}

bool is_simulated(const device::RecordingInfo& info) { return info.device.address == "sim"; }

// A simulated session repeats with its seed, and a real one has its start.
bool is_same_session(const device::RecordingInfo& a, const device::RecordingInfo& b) {
  return is_simulated(a) ? is_simulated(b) && a.seed == b.seed : !a.start.empty() && a.start == b.start;
}

// The last of `infos` against those before it.
void check_same_person(const std::vector<device::RecordingInfo>& infos, const std::vector<std::string>& paths) {
  const device::RecordingInfo& first = infos.front();
  const device::RecordingInfo& last = infos.back();
  const std::string& path = paths[infos.size() - 1];
  // a seed and a number make a virtual person
  if (is_simulated(first) != is_simulated(last) || first.person != last.person || (first.person && first.seed != last.seed))
    throw usage_error(fmt::format("{}: is not of the same person as {}", path, paths.front()));
  for (std::size_t k = 0; k + 1 < infos.size(); ++k)
    if (is_same_session(infos[k], last)) throw usage_error(fmt::format("{}: is of the same session as {}", path, paths[k]));
}

// Prints the scatter of one person's grips, within a recording and between recordings.
ExitCode print_scatter(const std::vector<std::string>& paths) {
  std::vector<device::GraspReport> grasps;
  std::vector<device::RecordingInfo> infos;
  for (const std::string& path : paths) {
    const device::Recording recording = device::read_recording(path);
    if (!recording.note.empty()) print_note(recording.note);
    if (!infos.empty() && !has_same_vessels(infos.front(), recording.info))
      throw usage_error(fmt::format("{}: its vessels or their liquids are not those of {}", path, paths.front()));
    infos.push_back(recording.info);
    check_same_person(infos, paths);
    if (is_left_handed(infos.front()) != is_left_handed(recording.info))
      throw usage_error(fmt::format("{}: is of the other hand than {}", path, paths.front()));
    const std::vector<device::GraspReport> own = device::grasps_of(recording);
    grasps.insert(grasps.end(), own.begin(), own.end());
  }
  device::GripScatter scatter;
  scatter.add(grasps);
  print(scatter.table());
  return ExitCode::done;
}

ExitCode report_recording(const SessionArguments& arguments) {
  const device::Recording recording = device::read_recording(arguments.recordings.front());
  if (!arguments.folder.empty()) {
    make_output_folder(arguments.folder);
    check_folder_files(arguments.folder, "session", TABLES, {&PICTURE, 1});
  }
  if (!recording.note.empty()) print_note(recording.note);
  const device::SessionReport report = device::report_session(recording);
  const std::string error = arguments.folder.empty() ? "" : write_session_files(arguments.folder, recording, report);
  print(arguments.json ? device::session_json(report) + "\n" : device::session_table(report));
  if (!error.empty()) throw failure_error("session: " + error);
  return ExitCode::done;
}

ExitCode report_recordings(const SessionArguments& arguments) {
  if (arguments.recordings.size() == 1) return report_recording(arguments);
  if (arguments.json || !arguments.folder.empty())
    throw usage_error(
        "session: several recordings, of one person, give the scatter of the grips alone; --json and -o go with one recording");
  return print_scatter(arguments.recordings);
}

#ifdef HAS_EVIDENCE
ExitCode report_or_study(const SessionArguments& arguments) {
  check_different(arguments.recordings);
  if (!arguments.study) {
    if (!arguments.seed.empty()) throw usage_error("--seed: goes with --study, whose intervals are drawn by chance");
    return report_recordings(arguments);
  }
  if (arguments.json) throw usage_error("--json: goes without --study; study.csv and study.nc of -o have the numbers");
  RecordedPeople people{arguments.recordings, arguments.folder};
  if (!arguments.seed.empty()) people.seed = static_cast<std::uint64_t>(parse_integer(arguments.seed, "--seed", ranges::SEED));
  return study_recordings(people);
}
#else
ExitCode report_or_study(const SessionArguments& arguments) {
  check_different(arguments.recordings);
  return report_recordings(arguments);
}
#endif

}  // namespace

void add_session_command(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<SessionArguments>();
  CLI::App* command = app.add_subcommand(
      "session", "Compute from a recording what the paper measured: states, response times, grip forces, lost grips");
  command
      ->add_option("recording", arguments->recordings,
                   "Recording of `wholehand live --record`, or several of one person; with --study one for each person")
      ->type_name("FILE.nc")
      ->required()
      ->check(not_empty());
  command
      ->add_option(
          "-o,--output", arguments->folder,
          "Folder for session.csv, states.csv and session.svg; with --study for study.csv, study.nc, study.html and grasps.csv")
      ->type_name("DIR")
      ->check(not_empty());
  command->add_flag("--json", arguments->json, "Print one JSON object in one line");
#ifdef HAS_EVIDENCE
  command->add_flag("--study", arguments->study, "Compute the paper's statistics over all recordings, and compare with the paper");
  command->add_option("--seed", arguments->seed, "Seed of the intervals of --study (default: 1)")
      ->type_name("S")
      ->check(not_empty())
      ->check(not_an_option());
#endif
  command->callback([arguments, &action] { action = [arguments] { return report_or_study(*arguments); }; });
}

}  // namespace wholehand
