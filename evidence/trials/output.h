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
  // From 1 on. The name within the folder, and with it.
  static std::string recording_name(std::size_t number);
  std::string recording(std::size_t number) const { return folder_ + recording_name(number); }

 private:
  std::string folder_;  // with its slash
};

// By what a recording of a trial is known: the name of its device begins so.
inline constexpr const char* TRIAL_DEVICE = "wholehand trials: ";
// What the page has in its head, before the identity of its trials.
inline constexpr const char* TRIALS_PAGE_MARK = "<meta name=\"wholehand-trials\" content=\"";

// What helps where a file cannot be written: the journal is there.
inline constexpr const char* TRIALS_REMEDY = "make room, then go on with --resume";

// Makes the folder where it is missing. Throws Error: (usage) one of the files is there and is not of trials, or the folder cannot
// be; (failure) no file can be made in it.
void prepare_trials_folder(const std::string& folder);

// Removes what a run that was killed left of files that it had not given their names. Only who holds the lock may ask.
void remove_unfinished(const TrialFiles& files);

// Whether the folder has all files of trials of this identity.
bool has_finished_trials(const std::string& folder, const std::string& identity);

}  // namespace wholehand
