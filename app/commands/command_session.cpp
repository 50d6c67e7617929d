// SPDX-License-Identifier: MIT
// wholehand session: statistics of a recording, and of recordings of several people together.
#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "app/commands/commands.h"
#include "app/commands/session_study.h"
#include "app/commands/validators.h"
#include "app/program/values.h"
#include "base/files/files.h"
#include "base/files/folder_files.h"
#include "base/files/pictures.h"
#include "base/system/output.h"
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

#ifdef HAS_EVIDENCE
ExitCode report_or_study(const SessionArguments& arguments) {
  if (!arguments.study) {
    if (arguments.recordings.size() > 1)
      throw usage_error("session: more than one recording; add --study to see what they say together");
    if (!arguments.seed.empty()) throw usage_error("--seed: goes with --study, whose intervals are drawn by chance");
    return report_recording(arguments);
  }
  if (arguments.json) throw usage_error("--json: goes without --study; study.csv and study.nc of -o have the numbers");
  RecordedPeople people{arguments.recordings, arguments.folder};
  if (!arguments.seed.empty()) people.seed = static_cast<std::uint64_t>(parse_integer(arguments.seed, "--seed", ranges::SEED));
  return study_recordings(people);
}
#else
ExitCode report_or_study(const SessionArguments& arguments) {
  if (arguments.recordings.size() > 1) throw usage_error("session: more than one recording; this program reads one at a time");
  return report_recording(arguments);
}
#endif

}  // namespace

void add_session_command(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<SessionArguments>();
  CLI::App* command = app.add_subcommand(
      "session", "Compute from a recording what the paper measured: states, response times, grip forces, lost grips");
  command
      ->add_option("recording", arguments->recordings, "Recording of `wholehand live --record`; with --study one for each person")
      ->type_name("FILE.nc")
      ->required()
      ->check(not_empty());
  command
      ->add_option("-o,--output", arguments->folder,
                   "Folder for session.csv, states.csv and session.svg; with --study for study.csv, study.nc and study.html")
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
