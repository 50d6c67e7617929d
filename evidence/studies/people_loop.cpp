// SPDX-License-Identifier: MIT
#include "evidence/studies/people_loop.h"

#include "base/numbers/parallel.h"
#include "base/system/progress.h"

namespace wholehand {

std::vector<std::vector<double>> of_people(const std::string& experiment, std::uint64_t people, int threads, StudyJournal& journal,
                                           const std::atomic<bool>& stop,
                                           const std::function<std::vector<double>(std::uint64_t)>& work) {
  std::vector<std::vector<double>> all(people);
  std::vector<std::size_t> open;
  for (std::size_t person = 0; person < people; ++person) {
    if (const auto* found = journal.find(experiment, person)) {
      all[person] = *found;
    } else {
      open.push_back(person);
    }
  }
  Progress progress(people, people - open.size(), "people");
  std::atomic<std::uint64_t> done = people - open.size();
  in_parallel(
      open.size(), threads,
      [&](std::size_t k) {
        if (stop) return;
        std::vector<double> numbers = work(open[k]);
        if (stop) return;  // it may have been cut short
        journal.add(experiment, open[k], numbers);
        all[open[k]] = std::move(numbers);
        ++done;
      },
      [&](std::size_t) { progress.update(experiment, done); });
  progress.clear();
  return all;
}

}  // namespace wholehand
