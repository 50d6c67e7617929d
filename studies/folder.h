// SPDX-License-Identifier: MIT
// The folder that a study is written to, by one process at a time.
#pragma once

#include <span>
#include <string>

#include "core/scene.h"
#include "studies/options.h"
#include "studies/output.h"
#include "studies/page.h"
#include "studies/row.h"
#include "system/output_lock.h"

namespace wholehand {

class StudyFolder {
 public:
  // Makes the folder, takes its lock, and removes what a killed run left unfinished. Throws Error as prepare_study_folder and
  // OutputLock do.
  explicit StudyFolder(const std::string& folder);

  // Writes the table, the dataset and the page. They get their names once all are whole. Throws Error (failure).
  void write(const Scene& scene, const StudyOptions& options, const StudyPage& page, std::span<const StudyRow> rows) const;

  const StudyFiles& files() const { return files_; }

  // "wrote a/study.csv, a/study.nc, a/study.html"
  std::string written() const;

 private:
  StudyFiles files_;
  OutputLock lock_;
};

}  // namespace wholehand
