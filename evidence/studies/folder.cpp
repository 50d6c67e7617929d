// SPDX-License-Identifier: MIT
#include "evidence/studies/folder.h"

#include <fmt/format.h>

#include "base/files/file_set.h"
#include "base/text/error.h"
#include "base/text/printable.h"
#include "evidence/studies/table.h"

namespace wholehand {
namespace {

StudyFiles prepared(const std::string& folder) {
  prepare_study_folder(folder);
  return StudyFiles(folder);
}

}  // namespace

StudyFolder::StudyFolder(const std::string& folder) : files_(prepared(folder)), lock_(files_.lock, "folder") {
  remove_unfinished_study(files_);
}

void StudyFolder::write(const Scene& scene, const StudyOptions& options, const StudyPage& page,
                        std::span<const StudyRow> rows) const {
  FileSet set;
  try {
    // renames the table first: beside it a folder's study.nc is recognized as ours
    set.write(files_.csv, study_csv(rows), STUDY_REMEDY);
    write_study_dataset(set.temporary_path(files_.nc), scene, options, rows);
    set.write(files_.page, study_page(page), STUDY_REMEDY);
    set.commit(STUDY_REMEDY);
  } catch (const Error& error) {
    throw Error(error.code, set.with_own_names(error.what()), error.remedy);
  }
}

std::string StudyFolder::written() const { return one_line(fmt::format("wrote {}, {}, {}", files_.csv, files_.nc, files_.page)); }

}  // namespace wholehand
