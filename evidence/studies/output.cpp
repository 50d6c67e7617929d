// SPDX-License-Identifier: MIT
#include "evidence/studies/output.h"

#include <cstdio>
#include <span>

#include "base/files/file_set.h"
#include "base/files/files.h"
#include "base/files/folder_files.h"

namespace wholehand {

StudyFiles::StudyFiles(const std::string& folder) {
  const std::string start = folder.ends_with('/') ? folder : folder + "/";
  csv = start + "study.csv";
  nc = start + "study.nc";
  page = start + "study.html";
  grasps = start + "grasps.csv";
  people = start + "people.csv";
  journal = start + "study.journal";
  lock = start + "study.lock";
}

void prepare_study_folder(const std::string& folder) {
  make_output_folder(folder);
  const StudyFiles files(folder);
  constexpr FolderTable TABLES[] = {
      {"study.csv", STUDY_CSV_START}, {"grasps.csv", GRASPS_CSV_START}, {"people.csv", PEOPLE_CSV_START}};
  check_folder_files(folder, "study", TABLES, {});
  check_overwrites_marked(files.journal, STUDY_JOURNAL_START, "journal of wholehand study", "-o");
  check_overwrites_marked(files.page, STUDY_PAGE_MARK, "page of wholehand study", "-o");
  // a NetCDF-4 file has no mark of ours near its beginning: beside our table it counts as ours
  if (!begins_with(files.csv, STUDY_CSV_START)) check_overwrites_nothing(files.nc, "-o");
  check_overwrites_result(files.nc);
}

void remove_unfinished_study(const StudyFiles& files) {
  for (const std::string& path : {files.csv, files.nc, files.page, files.grasps, files.people, files.journal})
    std::remove(FileSet::temporary_name(path).c_str());
}

}  // namespace wholehand
