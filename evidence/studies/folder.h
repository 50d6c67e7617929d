// SPDX-License-Identifier: MIT
// The folder that a study is written to, by one process at a time.
#pragma once

#include <span>
#include <string>

#include "base/files/output_lock.h"
#include "core/scene.h"
#include "evidence/studies/options.h"
#include "evidence/studies/output.h"
#include "evidence/studies/page.h"
#include "evidence/studies/row.h"

namespace wholehand {

class StudyFolder {
 public:
  // Makes the folder, takes its lock, and removes what a killed run left. Throws Error as prepare_study_folder and OutputLock do.
  explicit StudyFolder(const std::string& folder);

  // Writes the table, the dataset and the page, and renames them once all are complete. Throws Error (failure).
  void write(const Scene& scene, const StudyOptions& options, const StudyPage& page, std::span<const StudyRow> rows) const;

  const StudyFiles& files() const { return files_; }

  // "wrote a/study.csv, a/study.nc, a/study.html"
  std::string written() const;

 private:
  StudyFiles files_;
  OutputLock lock_;
};

}  // namespace wholehand
