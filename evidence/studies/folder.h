// SPDX-License-Identifier: MIT
// The folder that a study is written to, by one process at a time.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "base/files/file_set.h"
#include "base/files/output_lock.h"
#include "core/scene.h"
#include "evidence/studies/options.h"
#include "evidence/studies/output.h"
#include "evidence/studies/page.h"
#include "evidence/studies/row.h"

namespace wholehand {

class StudyFolder {
 public:
  // Makes the folder, takes its lock, and removes what a killed run left. Throws Error as prepare_study_folder and OutputLock do, and (failure) if
  // there is no room for so many rows of grasps.csv.
  explicit StudyFolder(const std::string& folder, std::uint64_t grasps = 0);

  // Adds rows to grasps.csv. Throws Error (failure).
  void add_grasps(const std::string& rows) { set_.append(files_.grasps, rows, STUDY_REMEDY); }
  // Adds the first `count` people of the population to people.csv; without them the folder has none. Throws Error (failure).
  void add_people(const PeopleData& people, std::uint64_t seed, std::uint64_t count);
  // Writes the table, the dataset and the page, and renames all files once they are complete; without this no file changes. Throws Error (failure).
  void write(const Scene& scene, const StudyOptions& options, const StudyPage& page, std::span<const StudyRow> rows);

  const StudyFiles& files() const { return files_; }

  // "wrote a/study.csv, a/study.nc, a/study.html, a/grasps.csv, a/people.csv"
  std::string written() const;

 private:
  // Runs `work`, whose errors name files by their temporary names.
  template <class Work>
  void with_own_names(const Work& work);

  StudyFiles files_;
  OutputLock lock_;
  FileSet set_;
  bool has_people_ = false;
};

}  // namespace wholehand
