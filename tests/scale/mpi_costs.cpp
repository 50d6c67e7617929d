// SPDX-License-Identifier: MIT
// What MPI costs on a simulated machine beyond the network that SMPI simulates: calls of MPI's profiling interface that let time pass and then call
// SMPI's own. The counter is simulated here alone, because SMPI would make its questions wait for their answers.
#include <mpi.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <deque>
#include <map>
#include <simgrid/s4u.hpp>

#include "tests/scale/machine.h"

namespace wholehand::scale {
namespace {

struct Question {
  bool is_open = false, is_answered = false, is_last = false;
  double ready = 0;                          // when the answer is there
  simgrid::s4u::ActorPtr waiting = nullptr;  // who has to be woken
};

std::uint64_t counter_value = 0;
std::map<int, Question> questions;       // of each rank
std::deque<int> unanswered;              // ranks that wait until rank 0 calls MPI
std::map<MPI_Request, int> receives;     // of rank 0: bytes
std::map<long, std::uint64_t> seconds_;  // questions in each second

void charge(double seconds) {
  if (seconds > 0) sleep_until(now() + seconds);
}

void answer(Question& question) {
  const Machine& machine = simulation().job.machine;
  question.ready = simulation().counter.serve(now(), machine.counter_seconds) + machine.counter_latency;
  question.is_answered = true;
  if (question.waiting) question.waiting->resume();
  question.waiting = nullptr;
}

// Whatever rank 0 calls, MPI answers the questions that have come.
void make_progress() {
  if (own_rank() != 0) return;
  charge_mark();
  while (!unanswered.empty()) {
    answer(questions[unanswered.front()]);
    unanswered.pop_front();
  }
}

double depth() { return std::ceil(std::log2(std::max(2, simulation().job.machine.ranks))); }

}  // namespace
}  // namespace wholehand::scale

using namespace wholehand::scale;

extern "C" {

int MPI_Init_thread(int* argc, char*** argv, int required, int* provided) {
  // SMPI knows its own MPI_COMM_WORLD only where a rank runs, and compares messages elsewhere, too: a copy is good everywhere. One for all ranks,
  // as SMPI counts the messages of each.
  static const MPI_Comm own_world = MPI_COMM_WORLD;
  const int error = PMPI_Init_thread(argc, argv, required, provided);
  MPI_Comm copy = MPI_COMM_NULL;
  PMPI_Comm_dup(own_world, &copy);
  if (MPI_COMM_WORLD == own_world) MPI_COMM_WORLD = copy;
  charge(simulation().job.machine.init_seconds);
  return error;
}

int MPI_Isend(const void* data, int count, MPI_Datatype type, int to, int tag, MPI_Comm all, MPI_Request* request) {
  charge(simulation().job.machine.message_seconds);
  return PMPI_Isend(data, count, type, to, tag, all, request);
}

int MPI_Iprobe(int from, int tag, MPI_Comm all, int* flag, MPI_Status* status) {
  make_progress();
  return PMPI_Iprobe(from, tag, all, flag, status);
}

int MPI_Irecv(void* data, int count, MPI_Datatype type, int from, int tag, MPI_Comm all, MPI_Request* request) {
  const int error = PMPI_Irecv(data, count, type, from, tag, all, request);
  receives[*request] = count;
  return error;
}

// A message is taken: rank 0 puts its entries into its lists.
int MPI_Test(MPI_Request* request, int* flag, MPI_Status* status) {
  make_progress();
  const auto receive = receives.find(*request);
  const int error = PMPI_Test(request, flag, status);
  if (*flag == 0 || receive == receives.end()) return error;
  const Machine& machine = simulation().job.machine;
  const double bytes = receive->second > 128 ? static_cast<double>(receive->second) * ENTRY_WEIGHT : 0;
  receives.erase(receive);
  const bool is_report = bytes > 0;  // others are a flag or the number of an error
  const double seconds = is_report ? machine.report_seconds + bytes / 16 * machine.entry_seconds : machine.message_seconds;
  if (is_report) {
    ++simulation().outcome.reports;
    simulation().outcome.report_bytes += bytes;
    simulation().outcome.leader_seconds += seconds;
  }
  charge(seconds);
  return error;
}

// As a tree, of which SMPI simulates the root's messages.
int MPI_Ibcast(void* data, int count, MPI_Datatype type, int root, MPI_Comm all, MPI_Request* request) {
  charge(depth() * simulation().job.machine.message_seconds);
  return PMPI_Ibcast(data, count, type, root, all, request);
}

int MPI_Ibarrier(MPI_Comm all, MPI_Request* request) {
  charge(depth() * simulation().job.machine.message_seconds);
  return PMPI_Ibarrier(all, request);
}

// Does not exchange which rank may run on which processor, as ranks have one thread each.
int MPI_Allgather(const void*, int, MPI_Datatype, void*, int, MPI_Datatype, MPI_Comm) {
  charge(depth() * simulation().job.machine.message_seconds);
  return MPI_SUCCESS;
}

// The counter's window: all ranks make it at once, as MPI says.
int MPI_Win_allocate(MPI_Aint, int, MPI_Info, MPI_Comm all, void* memory, MPI_Win* window) {
  *static_cast<std::uint64_t**>(memory) = &counter_value;
  *window = MPI_WIN_NULL;
  charge(depth() * simulation().job.machine.message_seconds);
  return PMPI_Barrier(all);
}
int MPI_Win_lock(int, int, int, MPI_Win) { return MPI_SUCCESS; }
int MPI_Win_unlock(int, MPI_Win) { return MPI_SUCCESS; }
int MPI_Win_free(MPI_Win*) { return MPI_SUCCESS; }

int MPI_Fetch_and_op(const void* value, void* before, MPI_Datatype, int, MPI_Aint, MPI_Op op, MPI_Win) {
  std::uint64_t amount = 0;
  std::memcpy(&amount, value, sizeof amount);
  std::memcpy(before, &counter_value, sizeof counter_value);
  const bool is_last = op != MPI_REPLACE && counter_value >= simulation().job.grips;
  counter_value = op == MPI_REPLACE ? amount : counter_value + amount;
  Outcome& outcome = simulation().outcome;
  ++outcome.questions;
  outcome.most_questions = std::max(outcome.most_questions, static_cast<double>(++seconds_[static_cast<long>(now())]));
  Question& question = questions[own_rank()];
  question = {true, false, is_last, 0, nullptr};
  if (simulation().job.machine.counter_needs_leader && own_rank() != 0) {
    unanswered.push_back(own_rank());
  } else {
    answer(question);
  }
  return MPI_SUCCESS;
}

// The same with a request. It is complete at once, and the flush after it waits.
int MPI_Rget_accumulate(const void* value, int, MPI_Datatype type, void* before, int, MPI_Datatype, int rank, MPI_Aint place, int,
                        MPI_Datatype, MPI_Op op, MPI_Win window, MPI_Request* request) {
  *request = MPI_REQUEST_NULL;
  return MPI_Fetch_and_op(value, before, type, rank, place, op, window);
}

int MPI_Win_flush(int, MPI_Win) {
  make_progress();
  const double start = now();
  Question& question = questions[own_rank()];
  if (question.is_open && !question.is_answered) {
    question.waiting = simgrid::s4u::Actor::self();
    simgrid::s4u::this_actor::suspend();
  }
  sleep_until(question.ready);
  question.is_open = false;
  double& first_idle = simulation().outcome.first_idle;
  if (question.is_last && first_idle == 0) first_idle = now();
  simulation().outcome.longest_answer = std::max(simulation().outcome.longest_answer, now() - start);
  return MPI_SUCCESS;
}

}  // extern "C"
