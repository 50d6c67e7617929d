// SPDX-License-Identifier: MIT
// The files of trials in their folder.
#pragma once

#include <cstddef>
#include <string>

namespace wholehand {

constexpr std::size_t MOST_DISAGREEMENTS = 10;

struct TrialFiles {
  explicit TrialFiles(const std::string& folder);
  std::string csv, nc, page, journal, lock;
  // From 1 on. The name within the folder, and the path with it.
  static std::string recording_name(std::size_t number);
  std::string recording(std::size_t number) const { return folder_ + recording_name(number); }

 private:
  std::string folder_;  // with its slash
};

// The prefix of the device's name, which identifies a recording of a trial.
inline constexpr const char* TRIAL_DEVICE = "wholehand trials: ";
// The identifying mark in the page's head, before the identity of its trials.
inline constexpr const char* TRIALS_PAGE_MARK = "<meta name=\"wholehand-trials\" content=\"";

// The remedy if a file cannot be written: the journal exists.
inline constexpr const char* TRIALS_REMEDY = "make room, then go on with --resume";

// Makes the folder if it is missing. Throws Error: (usage) one of the files exists and is not a trials file, or the path cannot be a folder;
// (failure) no file can be made in it.
void prepare_trials_folder(const std::string& folder);

// Removes unrenamed files that a killed run left. Call only while holding the lock.
void remove_unfinished(const TrialFiles& files);

// Whether the folder has all files of trials of this identity.
bool has_finished_trials(const std::string& folder, const std::string& identity);

}  // namespace wholehand
