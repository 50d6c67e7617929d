// SPDX-License-Identifier: MIT
#include "evidence/trials/output.h"

#include <fmt/format.h>

#include <cstdio>

#include "base/files/file_set.h"
#include "base/files/files.h"
#include "base/files/folder_files.h"
#include "base/text/error.h"
#include "evidence/trials/journal.h"
#include "evidence/trials/tried.h"

namespace wholehand {
namespace {

constexpr const char* OPTION = "-o";

}  // namespace

TrialFiles::TrialFiles(const std::string& folder) : folder_(folder.ends_with('/') ? folder : folder + "/") {
  csv = folder_ + "trials.csv";
  nc = folder_ + "trials.nc";
  page = folder_ + "trials.html";
  journal = folder_ + "trials.journal";
  lock = folder_ + "trials.lock";
}

std::string TrialFiles::recording_name(std::size_t number) { return fmt::format("disagreement-{}.nc", number); }

void prepare_trials_folder(const std::string& folder) {
  make_output_folder(folder);
  const TrialFiles files(folder);
  constexpr FolderTable TABLE{"trials.csv", TRIALS_CSV_START};
  check_folder_files(folder, "trials", std::span(&TABLE, 1), {});
  check_overwrites_kind(files.journal, JOURNAL_START, "journal of wholehand trials", OPTION);
  check_overwrites_marked(files.page, TRIALS_PAGE_MARK, "page of wholehand trials", OPTION);
  // a NetCDF-4 file has no mark of ours near its beginning: beside our table or our journal it counts as ours
  if (!begins_with(files.csv, TRIALS_CSV_START) && !begins_with(files.journal, JOURNAL_START))
    check_overwrites_nothing(files.nc, OPTION);
  check_overwrites_result(files.nc);
  for (std::size_t k = 1; k <= MOST_DISAGREEMENTS; ++k)
    check_overwrites_marked(files.recording(k), TRIAL_DEVICE, "recording of wholehand trials", OPTION);
}

void remove_unfinished(const TrialFiles& files) {
  for (const std::string& path : {files.csv, files.nc, files.page, files.journal})
    std::remove(FileSet::temporary_name(path).c_str());
  for (std::size_t k = 1; k <= MOST_DISAGREEMENTS; ++k) {
    const std::string name = FileSet::temporary_name(files.recording(k));
    std::remove(name.c_str());
    std::remove((name + ".partial").c_str());  // a recording's own name on the way
  }
}

bool has_finished_trials(const std::string& folder, const std::string& identity) {
  const TrialFiles files(folder);
  return begins_with(files.csv, TRIALS_CSV_START) && begins_with(files.nc, NETCDF4_START) &&
         has_mark(files.page, TRIALS_PAGE_MARK + identity);
}

}  // namespace wholehand
