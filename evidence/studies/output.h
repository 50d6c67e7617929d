// SPDX-License-Identifier: MIT
// The files of a study in their folder.
#pragma once

#include <string>
#include <string_view>

namespace wholehand {

struct StudyFiles {
  explicit StudyFiles(const std::string& folder);
  std::string csv, nc, page, grasps, people, journal, lock;
};

// The first characters of the tables: columns.
inline constexpr std::string_view STUDY_CSV_START = "experiment,pose,vessel,statistic,subject,value,low,high,paper,inside";
inline constexpr std::string_view GRASPS_CSV_START =
    "experiment,pose,vessel,subject,person,sex,hand_length_mm,hand_breadth_mm,grasp,";
inline constexpr std::string_view PEOPLE_CSV_START = "person,sex,hand_length_mm,hand_breadth_mm,";
// How the journal begins.
inline constexpr std::string_view STUDY_JOURNAL_START = "wholehand study journal ";
// The identifying mark in the page's head.
inline constexpr const char* STUDY_PAGE_MARK = "<meta name=\"wholehand-study\"";

inline constexpr const char* STUDY_REMEDY = "make room, or name another folder with -o";

// Makes the folder if it is missing. Throws Error: (usage) one of the files exists and is not a study's, or the path cannot be a folder; (failure) no
// file can be made in it.
void prepare_study_folder(const std::string& folder);

// Removes the unnamed files that a killed run left. Call only while holding the lock.
void remove_unfinished_study(const StudyFiles& files);

}  // namespace wholehand
