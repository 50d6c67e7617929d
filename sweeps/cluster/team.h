// SPDX-License-Identifier: MIT
// The ranks of an MPI job: what they say to each other, and the counter from which they take their work.
#pragma once

#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <string>

#include "base/text/error.h"
#include "sweeps/result/output_bytes.h"

namespace wholehand {

// One object a process, on its main thread, from MPI_Init to MPI_Finalize. What goes wrong within MPI ends the job in MPI's way. Rank 0 leads: all
// others send to it, and it alone speaks to all.
class Team {
 public:
  Team(int& argc, char**& argv);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  int rank() const { return rank_; }
  int size() const { return size_; }
  bool is_leader() const { return rank_ == 0; }
  int local_rank() const { return local_rank_; }  // among those of this node
  int local_size() const { return local_size_; }
  const std::string& node() const { return node_; }
  // Processors for this rank: its part of those that it may run on, where other ranks of the node may run on them too.
  int own_processors() const { return own_processors_; }

  // A message to rank 0; returns at once. Rank 0 does not send.
  void send(const std::string& message);
  // The next message to rank 0, and from whom; false: none is there yet.
  bool receive(std::string& message, int& from);
  // Waits for the next message of one rank.
  std::string wait_for(int from);
  // A message of every rank but rank 0, which reads them in the order of the ranks.
  void gather(const std::string& message, const std::function<void(int rank, const std::string& message)>& look);
  // What rank 0 gives, for all: every rank calls it, and waits without using its processor.
  std::string share(const std::string& from_leader);
  // Returns when every rank has called it.
  void meet();
  // Sleeps for a moment between two polls, which leaves the processor to working ranks: MPI's own waiting would not. The longer the wait so
  // far (s), the longer the moment; returns its length.
  static double nap(double waited = 0);

  // Whether all ranks know that they end with an error.
  void mark_agreed() { is_agreed_ = true; }
  bool is_agreed() const { return is_agreed_; }
  // Ends the job, in MPI's way.
  [[noreturn]] static void abort(ExitCode code);

  // The counter, in some window of rank 0's memory. Every rank calls restart_counter; it begins at 0.
  void restart_counter();
  // Asks for the next `amount` numbers, without waiting; answer() waits for the first of them. One question at a time.
  void ask(std::uint64_t amount);
  std::uint64_t answer();
  // Every answer from now on is NO_MORE or beyond: no sweep has so many grips, and 8,000 ranks may call it.
  void stop_counter();
  static constexpr std::uint64_t NO_MORE = std::uint64_t{1} << 50;
  // Whether the answer to the last question says so, as far as it is there. Does not wait.
  bool is_stopped();

  // Writes with MPI's own calls (MPI_File_write_at), and syncs alone, when this rank wants to.
  static std::unique_ptr<OutputBytes> open_output(const std::string& path);

 private:
  struct Mpi;
  struct Sent;
  struct Arriving;
  void look_for(int source);
  bool take(int source, std::string& message, int& from);
  std::unique_ptr<Mpi> mpi_;
  int rank_ = 0, size_ = 1, local_rank_ = 0, local_size_ = 1, own_processors_ = 1;
  std::string node_;
  bool is_agreed_ = false;
  std::list<Sent> sent_;          // messages that may still be under way
  std::list<Arriving> arriving_;  // to rank 0, in the order in which they were found
};

}  // namespace wholehand
