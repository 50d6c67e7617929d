// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include "tests/scale/machine.h"
using namespace wholehand::scale;
int main(int argc, char** argv) {
  Job job;
  job.machine.ranks = argc > 1 ? std::atoi(argv[1]) : 16;
  job.grips = argc > 2 ? static_cast<std::uint64_t>(std::atof(argv[2])) : 10'000'000;
  if (argc > 3) job.machine.entries = std::atoi(argv[3]);
  const Outcome o = simulate(job, true);
  fmt::print(
      "first {} idle {} last {} end {} eff {:.4f} grips {} q {} most {} wait {} reports {} MB {} leader {} wwait {} real {}\n",
      o.first_chunk, o.first_idle, o.last_chunk, o.end, o.efficiency, o.grips, o.questions, o.most_questions, o.longest_answer,
      o.reports, o.report_bytes / 1e6, o.leader_seconds, o.write_wait, o.real_seconds);
}
