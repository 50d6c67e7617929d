// SPDX-License-Identifier: MIT
// wholehand session: what a recording says about the one who gripped.
#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>

#include "app/commands.h"
#include "app/validators.h"
#include "recordings/session_plot.h"
#include "recordings/session_report.h"
#include "system/files.h"
#include "system/folder_files.h"
#include "system/output.h"
#include "system/pictures.h"

namespace wholehand {
namespace {

struct SessionArguments {
  std::string recording, folder;
  bool json = false;
};

constexpr FolderTable TABLES[] = {{"session.csv", "grasp,vessel,start_s,"}, {"states.csv", "start_s,duration_s,state,vessel\n"}};
constexpr const char* PICTURE = "session.svg";

// The tables, and the picture where there is something to draw. What could not be drawn, and why.
std::string write_session_files(const std::string& folder, const Recording& recording, const SessionReport& report) {
  const std::string picture = folder + "/" + PICTURE;
  const bool has_own_picture = is_own_picture(picture, is_there(folder, TABLES[0]));
  write_whole_file(folder + "/session.csv", grasps_csv(report), false);
  write_whole_file(folder + "/states.csv", states_csv(report), false);
  if (has_own_picture) std::remove(picture.c_str());  // of another recording
  return recording.ticks.empty() ? "" : write_pictures({{picture, session_picture(recording, report)}});
}

ExitCode report_recording(const SessionArguments& arguments) {
  const Recording recording = read_recording(arguments.recording);
  if (!arguments.folder.empty()) {
    make_output_folder(arguments.folder);
    check_folder_files(arguments.folder, "session", TABLES, {&PICTURE, 1});
  }
  if (!recording.note.empty()) std::fprintf(stderr, "wholehand: %s\n", recording.note.c_str());
  const SessionReport report = report_session(recording);
  const std::string trouble = arguments.folder.empty() ? "" : write_session_files(arguments.folder, recording, report);
  print(arguments.json ? session_json(report) + "\n" : session_table(report));
  if (!trouble.empty()) throw failure_error("session: " + trouble);
  return ExitCode::done;
}

}  // namespace

void add_session_command(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<SessionArguments>();
  CLI::App* command = app.add_subcommand(
      "session", "Compute from a recording what the paper measured: states, response times, grip forces, lost grips");
  command->add_option("recording", arguments->recording, "Recording of `wholehand live --record`")
      ->type_name("FILE.nc")
      ->required()
      ->check(not_empty());
  command->add_option("-o,--output", arguments->folder, "Folder for session.csv, states.csv and session.svg")
      ->type_name("DIR")
      ->check(not_empty());
  command->add_flag("--json", arguments->json, "Print one JSON object in one line");
  command->callback([arguments, &action] { action = [arguments] { return report_recording(*arguments); }; });
}

}  // namespace wholehand
