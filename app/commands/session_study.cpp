// SPDX-License-Identifier: MIT
#include "app/commands/session_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include "base/system/output.h"
#include "base/text/readable.h"
#include "core/reader/reader.h"
#include "core/scene.h"
#include "device/recordings/grasp_collector.h"
#include "device/recordings/grip_scatter.h"
#include "device/recordings/recording.h"
#include "evidence/studies/answer.h"
#include "evidence/studies/folder.h"
#include "evidence/studies/grasp_table.h"
#include "evidence/studies/options.h"
#include "evidence/studies/session_charts.h"
#include "evidence/studies/session_page.h"
#include "evidence/studies/session_statistics.h"
#include "evidence/studies/summary.h"

namespace wholehand {
namespace {

// All recordings together.
struct RecordedSessions {
  Scene scene;  // of the first
  SessionVessels vessels;
  std::vector<SessionSubject> subjects;
  device::GripScatter scatter;
  bool are_simulated = true;  // all were made by virtual people
};

// Also where neither is known.
bool is_same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

// People of one study should have felt the same forces.
void note_differences(const device::RecordingInfo& first, const device::RecordingInfo& other, const std::string& path,
                      const std::string& first_path) {
  const bool has_same_ranges = std::equal(
      first.vessels.begin(), first.vessels.end(), other.vessels.begin(), other.vessels.end(),
      [](const device::RecordedVessel& a, const device::RecordedVessel& b) { return is_same(a.force_range, b.force_range); });
  if (is_same(first.force_base, other.force_base) && is_same(first.force_max, other.force_max) && has_same_ranges) return;
  print_note(fmt::format("{}: F_base, F_max or an F_range differ from those of {}; both count alike", path, first_path));
}

// One recording at a time is in memory.
RecordedSessions read_sessions(const std::vector<std::string>& paths) {
  RecordedSessions sessions;
  std::optional<device::RecordingInfo> first;
  for (std::size_t k = 0; k < paths.size(); ++k) {
    const std::string& path = paths[k];
    const device::Recording recording = device::read_recording(path);
    if (!recording.note.empty()) print_note(recording.note);
    if (!first) {
      first = recording.info;
      if (first->scene_text.empty())
        throw usage_error(path + ": the recording has no scene, which says from which vessels people pour");
      sessions.scene = parse_scene(first->scene_text, path);
      sessions.vessels = session_vessels(sessions.scene);
    } else if (!has_same_vessels(*first, recording.info)) {
      throw usage_error(fmt::format("{}: its vessels or their liquids are not those of {}; people of one study use the same", path,
                                    paths.front()));
    }
    note_differences(*first, recording.info, path, paths.front());
    sessions.are_simulated = sessions.are_simulated && recording.info.device.address == "sim";
    sessions.subjects.push_back({device::grasps_of(recording)});
    sessions.scatter.add(sessions.subjects.back().grasps);
  }
  return sessions;
}

StudyPage page_of_recordings(const RecordedSessions& sessions, const StudyOptions& options, const std::vector<StudyRow>& rows) {
  StudyPage page;
  const std::string note = few_people_note(sessions.subjects.size());
  page.title = study_title(sessions.scene);
  page.lead =
      fmt::format("{}, and {} samples of the paper's size; seed {}.{}", counted(sessions.subjects.size(), "recorded session"),
                  readable_number(static_cast<std::uint64_t>(options.resamples)), options.seed, note.empty() ? "" : " " + note);
  page.sections.push_back(answer_section(rows));
  page.sections.push_back(session_section(sessions.vessels, rows, sessions.are_simulated));
  page.sections.back().charts = session_charts(sessions.subjects, sessions.vessels, rows);
  page.seed = options.seed;
  return page;
}

// How many grasps each vessel of the study has.
std::string grasps_line(const RecordedSessions& sessions) {
  std::string line = counted(sessions.subjects.size(), "recording") + " of people; grasps";
  for (const SessionVessel& vessel : sessions.vessels) {
    std::ptrdiff_t grasps = 0;
    for (const SessionSubject& subject : sessions.subjects)
      grasps += std::count_if(subject.grasps.begin(), subject.grasps.end(), [&vessel](const device::GraspReport& grasp) {
        return grasp.vessel == static_cast<int>(vessel.place);
      });
    line += fmt::format("{} {}: {}", vessel.name == sessions.vessels.front().name ? "" : ",", vessel.name, grasps);
  }
  return line + "\n";
}

}  // namespace

ExitCode study_recordings(const RecordedPeople& people) {
  const RecordedSessions sessions = read_sessions(people.recordings);
  std::optional<StudyFolder> folder;
  if (!people.folder.empty()) folder.emplace(people.folder);
  StudyOptions options;
  options.folder = people.folder;
  options.people = {0, 0, sessions.subjects.size()};
  options.seed = people.seed;
  const std::vector<StudyRow> rows =
      session_rows(sessions.subjects, sessions.vessels, {options.seed, options.resamples, options.threads, sessions.are_simulated});
  if (folder) {
    for (std::size_t k = 0; k < sessions.subjects.size(); ++k)
      folder->add_grasps(session_grasp_rows(sessions.scene, {k}, sessions.subjects[k].grasps));
    folder->write(sessions.scene, options, page_of_recordings(sessions, options, rows), rows);
  }
  print(grasps_line(sessions) + study_summary(rows));
  if (sessions.subjects.size() < LEAST_SUBJECTS)
    print(fmt::format("Intervals need {} recordings or more.\n", LEAST_SUBJECTS));
  else if (const std::string note = few_people_note(sessions.subjects.size()); !note.empty())
    print(note + "\n");
  print("\n" + sessions.scatter.table());
  if (folder) print("\n" + folder->written() + "\n");
  return ExitCode::done;
}

}  // namespace wholehand
