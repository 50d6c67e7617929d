// SPDX-License-Identifier: MIT
// wholehand-scale: sweeps of many ranks on simulated machines, as a table and a picture (docs/scale.md).
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <string>
#include <thread>
#include <vector>

#include "base/files/files.h"
#include "base/text/error.h"
#include "tests/scale/machine.h"
#include "tests/scale/measure.h"
#include "tests/scale/picture.h"

namespace wholehand::scale {
namespace {

Machine cpu_nodes(int ranks) {
  Machine machine;
  machine.ranks = ranks;
  return machine;
}

Machine gpu_nodes(int ranks) {
  Machine machine;
  machine.ranks = ranks;
  machine.ranks_per_node = 8;
  machine.rate = 9e6;
  machine.chunk_seconds = machine.leader_chunk = 0.05;
  machine.open_seconds = 0.6;
  machine.bytes_per_grip = 5;
  return machine;
}

// A line of the table; those of a group with a label make a line of the picture.
Row row(const std::string& group, const std::string& label, const Machine& machine, std::uint64_t grips) {
  return {group, label, {machine, grips}, {}};
}

constexpr std::uint64_t CPU_GRIPS = 10'000'000'000, GPU_GRIPS = 100'000'000'000;

template <class Change>
Row changed(const std::string& group, const std::string& label, Machine machine, std::uint64_t grips, const Change& change) {
  change(machine);
  return row(group, label, machine, grips);
}

std::vector<Row> all_rows() {
  std::vector<Row> rows;
  const auto slow = [](Machine& machine) { machine.straggler = 1; };
  const auto keeps_nothing = [](Machine& machine) { machine.bytes_per_grip = 0; };
  for (const int ranks : {16, 64, 256, 1024, 2048, 4096}) {
    rows.push_back(row("cpu", "CPU nodes", cpu_nodes(ranks), CPU_GRIPS));
    rows.push_back(changed("cpu", "CPU nodes, a straggler", cpu_nodes(ranks), CPU_GRIPS, slow));
  }
  for (const int ranks : {16, 64, 256, 1024, 4096}) rows.push_back(row("gpu", "GPU nodes", gpu_nodes(ranks), GPU_GRIPS));
  for (const int ranks : {16, 64, 256, 1024, 4096})
    rows.push_back(changed("gpu", "GPU nodes, nothing kept", gpu_nodes(ranks), GPU_GRIPS, keeps_nothing));
  rows.push_back(changed("gpu", "GPU nodes, a straggler", gpu_nodes(64), GPU_GRIPS, slow));
  for (const int ranks : {1024, 4096})
    rows.push_back(changed("counter", "counter waits for rank 0", cpu_nodes(ranks), CPU_GRIPS,
                           [](Machine& m) { m.counter_needs_leader = true; }));
  for (const double seconds : {1e-4, 3e-4, 1e-3})
    rows.push_back(changed("counter", fmt::format("counter of {:.1f} ms", seconds * 1e3), cpu_nodes(4096), CPU_GRIPS,
                           [seconds](Machine& m) { m.counter_seconds = seconds; }));
  for (const double pieces : {0.5, 8.0})
    rows.push_back(changed("pieces", fmt::format("pieces of {} s, counter of 1 ms", pieces), cpu_nodes(4096), CPU_GRIPS,
                           [pieces](Machine& m) { m.counter_seconds = 1e-3, m.piece_seconds = pieces; }));
  for (const double pieces : {0.5, 8.0})
    rows.push_back(changed("pieces", fmt::format("pieces of {} s, a straggler", pieces), cpu_nodes(1024), CPU_GRIPS,
                           [pieces](Machine& m) { m.straggler = 1, m.piece_seconds = pieces; }));
  for (const double bandwidth : {1e9, 1e11}) {
    rows.push_back(changed("file", fmt::format("file system of {} GB/s", bandwidth * 1e-9), cpu_nodes(1024), CPU_GRIPS,
                           [bandwidth](Machine& m) { m.write_bandwidth = bandwidth; }));
  }
  rows.push_back(changed("file", "229 bytes a grip", cpu_nodes(1024), CPU_GRIPS, [](Machine& m) { m.bytes_per_grip = 229; }));
  rows.push_back(
      changed("file", "rank 0 alone reads back", cpu_nodes(1024), CPU_GRIPS, [](Machine& m) { m.reads_back_together = false; }));
  rows.push_back(changed("file", "nothing kept", cpu_nodes(1024), CPU_GRIPS, keeps_nothing));
  rows.push_back(changed("file", "nothing kept", cpu_nodes(4096), CPU_GRIPS, keeps_nothing));
  // a test of seconds
  for (const int ranks : {16, 64}) {
    rows.push_back(row("quick", "CPU nodes", cpu_nodes(ranks), CPU_GRIPS / 100));
    rows.push_back(changed("quick", "CPU nodes, a straggler", cpu_nodes(ranks), CPU_GRIPS / 100, slow));
  }
  return rows;
}

constexpr const char* HEADER =
    "| machine | ranks | grips | first chunk, s | first idle, s | last chunk, s | result, s | efficiency | questions/s, most | "
    "longest "
    "answer, ms | report MB | rank 0 busy, s | written GB/s |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|";

std::string line_of(const Row& row) {
  const Outcome& out = row.outcome;
  return fmt::format(
      "| {} | {} | 10^{:.0f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.1f} % | {:.0f} | {:.2g} | {:.0f} | {:.2f} | {:.2f} |",
      row.label, row.job.machine.ranks, std::log10(static_cast<double>(row.job.grips)), out.first_chunk, out.first_idle,
      out.last_chunk, out.end, 100 * out.efficiency, out.most_questions, out.longest_answer * 1e3, out.report_bytes * 1e-6,
      out.leader_seconds, out.last_chunk > 0 ? out.written * 1e-9 / out.last_chunk : 0);
}

std::string csv_of(const std::vector<Row>& rows) {
  std::string text =
      "group,machine,ranks,grips,done,rate_of_all,first_chunk_s,first_idle_s,last_chunk_s,result_s,efficiency,questions,most_"
      "questions_per_s,"
      "longest_answer_s,reports,report_bytes,leader_s,written_bytes,write_wait_rank_s\n";
  for (const Row& row : rows) {
    const Outcome& out = row.outcome;
    text +=
        fmt::format("{},\"{}\",{},{},{},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{},{},{:.17g},{},{},{:.17g},{},{:.17g}\n",
                    row.group, row.label, row.job.machine.ranks, row.job.grips, out.grips, rate_of_all(row.job.machine),
                    out.first_chunk, out.first_idle, out.last_chunk, out.end, out.efficiency, out.questions, out.most_questions,
                    out.longest_answer, out.reports, out.report_bytes, out.leader_seconds, out.written, out.write_wait);
  }
  return text;
}

int run(int argc, char** argv) {
  CLI::App app(
      "Sweeps of many ranks on simulated machines. The sources of wholehand-mpi run with the MPI of SimGrid (SMPI); kernels and "
      "files are "
      "replaced by the time that they take. Prints a table in simulated seconds; docs/scale.md says what it means.");
  std::string csv, svg;
  std::vector<std::string> groups;
  int at_a_time = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  bool is_loud = false, is_measured = false;
  app.add_option(
         "--only", groups,
         "Only these: cpu and gpu (more and more ranks), counter (slow ones), pieces (their size), file (its bandwidth and what "
         "is kept), quick (a test of seconds). All but quick, if none is named")
      ->check(CLI::IsMember({"cpu", "gpu", "counter", "pieces", "file", "quick"}))
      ->delimiter(',');
  app.add_option("--csv", csv, "Write the table as CSV, too");
  app.add_option("--svg", svg, "Draw efficiency over ranks");
  app.add_option("--jobs", at_a_time, "Simulations at a time; each takes up to 2 GB of memory")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  app.add_flag("--loud", is_loud, "Show what the sweeps print");
  app.add_flag("--measure", is_measured, "Instead, measure on this machine what rank 0 spends on reports and marks");
  app.footer("Exit codes: 0 done, 2 wrong usage, 3 failure.");
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    throw usage_error(fmt::format("{}; see wholehand-scale --help", error.what()));
  }
  // known before a run of many minutes
  if (!csv.empty()) check_output_path(csv, "--csv");
  if (!svg.empty()) check_output_path(svg, "--svg");
  if (!csv.empty() && csv == svg) throw usage_error("--csv and --svg: both name " + csv + "; name two files");
  if (is_measured) {
    measure();
    return 0;
  }
  std::vector<Row> rows = all_rows();
  std::erase_if(rows, [&](const Row& row) {
    return groups.empty() ? row.group == "quick" : std::find(groups.begin(), groups.end(), row.group) == groups.end();
  });
  std::vector<Job> jobs;
  for (const Row& row : rows) jobs.push_back(row.job);
  std::size_t done = 0, shown = 0;
  std::vector<bool> is_done(rows.size());
  fmt::print("{}\n", HEADER);
  simulate(jobs, at_a_time, is_loud, [&](std::size_t number, const Outcome& outcome) {
    rows[number].outcome = outcome;
    is_done[number] = true;
    fmt::print(stderr, "{} of {}: {} ranks took {:.1f} s\n", ++done, rows.size(), rows[number].job.machine.ranks,
               outcome.real_seconds);
    for (; shown < rows.size() && is_done[shown]; ++shown) fmt::print("{}\n", line_of(rows[shown]));
    std::fflush(stdout);
  });
  if (!csv.empty()) write_whole_file(csv, csv_of(rows), false, "name another file");
  if (!svg.empty()) write_whole_file(svg, scale_picture(rows), false, "name another file");
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) throw failure_error("cannot write all of the table to standard output");
  return 0;
}

}  // namespace
}  // namespace wholehand::scale

int main(int argc, char** argv) {
  try {
    return wholehand::scale::run(argc, argv);
  } catch (const wholehand::Error& error) {
    fmt::print(stderr, "wholehand-scale: {}\n", error.what());
    return static_cast<int>(error.code);
  } catch (const std::exception& error) {
    fmt::print(stderr, "wholehand-scale: {}\n", error.what());
    return 3;
  }
}
