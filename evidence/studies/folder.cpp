// SPDX-License-Identifier: MIT
#include "evidence/studies/folder.h"

#include <fmt/format.h>

#include "base/files/files.h"
#include "base/text/error.h"
#include "base/text/printable.h"
#include "evidence/studies/grasp_table.h"
#include "evidence/studies/table.h"

namespace wholehand {
namespace {

StudyFiles prepared(const std::string& folder) {
  prepare_study_folder(folder);
  return StudyFiles(folder);
}

}  // namespace

StudyFolder::StudyFolder(const std::string& folder, std::uint64_t grasps) : files_(prepared(folder)), lock_(files_.lock, "folder") {
  constexpr std::uint64_t HEAD = 2048, OF_ROW = 250;  // bytes, with a vessel's name of some ten letters
  remove_unfinished_study(files_);
  with_own_names([&] { check_room(set_.temporary_path(files_.grasps), HEAD + grasps * OF_ROW, STUDY_REMEDY); });
  add_grasps(grasps_csv_head());
}

void StudyFolder::add_people(const PeopleData& people, std::uint64_t seed, std::uint64_t count) {
  constexpr std::uint64_t AT_ONCE = 1000;  // people in memory
  std::string rows = people_csv_head();
  for (std::uint64_t person = 0; person < count; ++person) {
    rows += person_row(people, seed, person);
    if (person % AT_ONCE != AT_ONCE - 1 && person + 1 < count) continue;
    set_.append(files_.people, rows, STUDY_REMEDY);
    rows.clear();
  }
  has_people_ = true;
}

void StudyFolder::write(const Scene& scene, const StudyOptions& options, const StudyPage& page, std::span<const StudyRow> rows) {
  with_own_names([&] {
    // renames the table before the dataset: beside it a folder's study.nc is recognized as ours
    set_.write(files_.csv, study_csv(rows), STUDY_REMEDY);
    write_study_dataset(set_.temporary_path(files_.nc), scene, options, rows);
    set_.write(files_.page, study_page(page), STUDY_REMEDY);
    if (!has_people_) set_.remove_on_commit(files_.people);
    set_.commit(STUDY_REMEDY);
  });
}

std::string StudyFolder::written() const {
  return one_line(fmt::format("wrote {}, {}, {}, {}{}", files_.csv, files_.nc, files_.page, files_.grasps,
                              has_people_ ? ", " + files_.people : ""));
}

template <class Work>
void StudyFolder::with_own_names(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    throw Error(error.code, set_.with_own_names(error.what()), error.remedy);
  }
}

}  // namespace wholehand
