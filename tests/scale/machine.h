// SPDX-License-Identifier: MIT
// A machine that is simulated: its ranks, its network, its counter and its file system, and what a job on it took.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace wholehand::scale {

// Times in s, sizes in bytes. docs/scale.md says where each number comes from.
struct Machine {
  std::string name = "CPU";
  int ranks = 1024;
  int ranks_per_node = 64;
  double rate = 42e3;           // grips a second of a rank: the kernels' measured time
  double chunk_seconds = 0.25;  // of the grips that a backend hands over at a time
  double leader_chunk = 0.012;  // the same of rank 0, which looks for reports after each
  int straggler = -1;           // the rank that has half the speed; -1: none
  double straggler_speed = 0.5;
  // the start
  double init_seconds = 0.5;   // MPI_Init
  double open_seconds = 0.09;  // until the device is open
  double opens = 5000;         // files that the file system opens a second
  // messages
  double latency = 2e-6, bandwidth = 12.5e9;  // of a node's link
  double message_seconds = 1e-6;              // of a rank's processor, for each message
  double report_seconds = 2e-5;               // of rank 0, for each report
  double entry_seconds = 1e-8;        // of rank 0, for each entry of a report: a candidate or a cell of a heat map, 16 bytes
  int entries = 32'768;               // the most that a report has
  double mark_line_seconds = 1.6e-6;  // of rank 0, for each line of a mark
  double mark_seconds = 5;            // least time between reports
  // the counter
  double counter_seconds = 1e-6;      // a question keeps it busy for so long
  double counter_latency = 4e-6;      // and takes so long on the way there and back
  bool counter_needs_leader = false;  // questions are answered only when rank 0 calls MPI
  double piece_seconds = 2;           // what a rank takes at a time, at least
  // the file system
  double bytes_per_grip = 9;
  double write_bandwidth = 10e9;  // of the file system
  double node_bandwidth = 5e9;    // of one node that writes or reads
  double sync_seconds = 0.01;
  bool reads_back_together = true;  // whether all ranks read the result back, or rank 0 alone
};

// Grips a second.
double rate_of_all(const Machine& machine);

// A simulated entry of a report stands for so many, and a simulated grip that gets into a list, too: the simulation's own time goes into them.
constexpr int ENTRY_WEIGHT = 64;

struct Job {
  Machine machine;
  std::uint64_t grips = 0;
};

// Simulated times in s, from the start of the processes.
struct Outcome {
  double first_chunk = 0;  // when the last rank has its first chunk
  double first_idle = 0;   // when the first rank finds no more work
  double last_chunk = 0;   // when the last chunk is done
  double end = 0;          // when the result is there
  double efficiency = 0;   // grips / (rates of all ranks x end)
  std::uint64_t grips = 0, questions = 0, reports = 0;
  double report_bytes = 0;
  double longest_answer = 0;  // that a rank has waited for the counter
  double most_questions = 0;  // in a second
  double written = 0;         // bytes
  double write_wait = 0;      // of all ranks for the file system, rank seconds
  double leader_seconds = 0;  // of rank 0 for reports and marks
  double real_seconds = 0;    // that the simulation took
};

// Serves one after the other.
class Server {
 public:
  // When it has served a request of this moment.
  double serve(double now, double seconds) {
    free_ = (now > free_ ? now : free_) + seconds;
    return free_;
  }

 private:
  double free_ = 0;
};

// The job under way. One in a process: SimGrid's engine can be made once.
struct Simulation {
  Job job;
  Outcome outcome;
  Server files, opens, counter;
  std::vector<Server> nodes;  // their ways to the file system
  std::uint64_t pieces = 0;   // that all ranks have done: lines of a mark
  std::string mark;           // its file
};
Simulation& simulation();

// If rank 0 has written a mark since the last call, the time of that passes. Called before whatever it does next.
void charge_mark();

// Simulated time, and until when a rank does nothing else.
double now();
void sleep_until(double time);
int own_rank();
int node_of(int rank);

// Simulates each job in a process of its own, some at a time, and calls `take` with the number of each that is done. Throws std::runtime_error where
// a process fails.
void simulate(const std::vector<Job>& jobs, int at_a_time, bool is_loud,
              const std::function<void(std::size_t, const Outcome&)>& take);

}  // namespace wholehand::scale
