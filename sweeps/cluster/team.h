// SPDX-License-Identifier: MIT
// The ranks of an MPI job: their messages, and the counter from which they take work.
#pragma once

#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <string>

#include "base/text/error.h"
#include "sweeps/result/output_bytes.h"

namespace wholehand::sweeps {

// One object per process, on its main thread, from MPI_Init to MPI_Finalize. An error within MPI ends the job in MPI's way. Rank 0 leads: all others
// send to it, and only it sends to all.
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
  // Processors for this rank: its share of those on which it may run, if other ranks of the node may run there too.
  int own_processors() const { return own_processors_; }

  // Sends a message to rank 0 and returns at once. Rank 0 does not send.
  void send(const std::string& message);
  // The next message to rank 0, and its sender; false: none has come yet.
  bool receive(std::string& message, int& from);
  // Waits for the next message of one rank.
  std::string wait_for(int from);
  // Sends one message of every rank but rank 0, which reads them in rank order.
  void gather(const std::string& message, const std::function<void(int rank, const std::string& message)>& look);
  // Distributes rank 0's bytes to all: every rank calls it, and waits without using its processor.
  std::string share(const std::string& from_leader);
  // Returns once every rank has called it.
  void meet();
  // Sleeps briefly between two polls, which leaves the processor to working ranks; MPI's own waiting would not. The longer the wait so far (s), the
  // longer the sleep; returns its length.
  static double nap(double waited = 0);

  // Whether all ranks know that they end with an error.
  void mark_agreed() { is_agreed_ = true; }
  bool is_agreed() const { return is_agreed_; }
  // Ends the job, in MPI's way.
  [[noreturn]] static void abort(ExitCode code);

  // The counter, in a window of rank 0's memory. Every rank calls restart_counter, which sets it to 0.
  void restart_counter();
  // Requests the next `amount` numbers, without waiting; answer() waits for the first of them. One request at a time.
  void ask(std::uint64_t amount);
  std::uint64_t answer();
  // Every answer from now on is NO_MORE or higher: no sweep has so many grips, even if 8,000 ranks call it.
  void stop_counter();
  static constexpr std::uint64_t NO_MORE = std::uint64_t{1} << 50;
  // Whether the answer to the last request, if it has come, says so. Does not wait.
  bool is_stopped();

  // Writes with MPI's own calls (MPI_File_write_at), and syncs independently, whenever this rank wants to.
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
  std::list<Sent> sent_;          // messages that may still be in flight
  std::list<Arriving> arriving_;  // to rank 0, in the order in which they were found
};

}  // namespace wholehand::sweeps
