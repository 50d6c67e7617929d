// SPDX-License-Identifier: MIT
#include "sweeps/cluster/team.h"

#include <mpi.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <utility>
#include <vector>

#include "base/system/clock.h"
#include "base/text/error.h"
#include "sweeps/cluster/processors.h"

namespace wholehand::sweeps {
namespace {

constexpr int MESSAGE_TAG = 1;
constexpr std::size_t MOST_AT_ONCE = std::size_t{1} << 30;  // bytes of one call, whose counts are ints
constexpr std::size_t MOST_ARRIVING = 16;                   // messages that are received at a time, whose room rank 0 needs
constexpr double SHORTEST_NAP = 1e-3, LONGEST_NAP = 0.02;   // s
constexpr double NAP_SHARE = 1.0 / 8;                       // of the time waited so far: what a nap may add to it

bool is_done(MPI_Request& request) {
  int flag = 0;
  MPI_Test(&request, &flag, MPI_STATUS_IGNORE);
  return flag != 0;
}

void wait_quietly(MPI_Request& request) {
  for (double waited = 0; !is_done(request);) waited += Team::nap(waited);
}

int system_error(int mpi_error) {
  int kind = MPI_ERR_OTHER;
  MPI_Error_class(mpi_error, &kind);
  switch (kind) {
    case MPI_ERR_NO_SPACE:
      return ENOSPC;
    case MPI_ERR_QUOTA:
      return EDQUOT;
    case MPI_ERR_ACCESS:
      return EACCES;
    case MPI_ERR_READ_ONLY:
      return EROFS;
    case MPI_ERR_NO_SUCH_FILE:
      return ENOENT;
    default:
      return EIO;
  }
}

// Each rank opens the file itself, so that it can sync when it wants to, without waiting for others. No two ranks write to one place.
class MpiFile final : public OutputBytes {
 public:
  explicit MpiFile(const std::string& path) {
    const int error = MPI_File_open(MPI_COMM_SELF, path.c_str(), MPI_MODE_RDWR, MPI_INFO_NULL, &file_);
    if (error != MPI_SUCCESS) throw failure_error(path + ": cannot be opened by MPI; is its folder there on every node?");
  }
  ~MpiFile() override { MPI_File_close(&file_); }
  MpiFile(const MpiFile&) = delete;
  MpiFile& operator=(const MpiFile&) = delete;

  int write(const void* data, std::size_t size, std::uint64_t offset) override {
    const auto* from = static_cast<const char*>(data);
    while (size > 0) {
      const int wanted = static_cast<int>(std::min(size, MOST_AT_ONCE));
      MPI_Status status;
      errno = 0;
      const int error = MPI_File_write_at(file_, static_cast<MPI_Offset>(offset), from, wanted, MPI_BYTE, &status);
      int written = 0;
      if (error == MPI_SUCCESS) MPI_Get_count(&status, MPI_BYTE, &written);
      // a library that does not say which error it was has left the system's own
      if (error != MPI_SUCCESS) return system_error(error) == EIO && errno != 0 ? errno : system_error(error);
      if (written <= 0) return errno != 0 ? errno : ENOSPC;
      from += written;
      size -= static_cast<std::size_t>(written);
      offset += static_cast<std::uint64_t>(written);
    }
    return 0;
  }

  int sync() override {
    errno = 0;
    const int error = MPI_File_sync(file_);
    return error == MPI_SUCCESS ? 0 : errno != 0 ? errno : system_error(error);
  }

 private:
  MPI_File file_ = MPI_FILE_NULL;
};

// How many of the node's processors this rank may use. Collective over the ranks of the node.
int share_processors(MPI_Comm local, int rank, int size) {
  std::vector<cpu_set_t> sets(static_cast<std::size_t>(size));
  cpu_set_t& own = sets[static_cast<std::size_t>(rank)];
  CPU_ZERO(&own);
  if (sched_getaffinity(0, sizeof own, &own) != 0)
    for (long p = 0; p < std::min<long>(CPU_SETSIZE, sysconf(_SC_NPROCESSORS_ONLN)); ++p)
      CPU_SET(static_cast<std::size_t>(p), &own);
  MPI_Allgather(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, sets.data(), sizeof(cpu_set_t), MPI_BYTE, local);
  std::vector<std::vector<bool>> allowed;
  for (const cpu_set_t& set : sets) {
    allowed.emplace_back(CPU_SETSIZE);
    for (std::size_t p = 0; p < CPU_SETSIZE; ++p) allowed.back()[p] = CPU_ISSET(p, &set);
  }
  return deal_processors(allowed)[static_cast<std::size_t>(rank)];
}

}  // namespace

struct Team::Mpi {
  MPI_Win window = MPI_WIN_NULL;
  std::uint64_t* counter = nullptr;  // of rank 0
  std::uint64_t amount = 0, first = 0;
  MPI_Request question = MPI_REQUEST_NULL;
  bool is_asked = false;
};

struct Team::Sent {
  std::string message;
  MPI_Request request = MPI_REQUEST_NULL;
};

struct Team::Arriving {
  int from = 0;
  std::string message;
  MPI_Request request = MPI_REQUEST_NULL;
};

Team::Team(int& argc, char**& argv) : mpi_(std::make_unique<Mpi>()) {
  // Open MPI 4.1 chooses RDMA windows even between nodes that only have TCP, and then cannot make them (MPI_ERR_WIN). A choice of the user's stays.
  setenv("OMPI_MCA_osc", "^rdma", 0);
  int level = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &level);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
  MPI_Comm local = MPI_COMM_NULL;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &local);
  MPI_Comm_rank(local, &local_rank_);
  MPI_Comm_size(local, &local_size_);
  own_processors_ = share_processors(local, local_rank_, local_size_);
  MPI_Comm_free(&local);
  std::array<char, MPI_MAX_PROCESSOR_NAME + 1> name{};
  int length = 0;
  MPI_Get_processor_name(name.data(), &length);
  node_ = name.data();
  const MPI_Aint bytes = rank_ == 0 ? sizeof(std::uint64_t) : 0;
  MPI_Win_allocate(bytes, sizeof(std::uint64_t), MPI_INFO_NULL, MPI_COMM_WORLD, &mpi_->counter, &mpi_->window);
  MPI_Win_lock(MPI_LOCK_SHARED, 0, MPI_MODE_NOCHECK, mpi_->window);
}

Team::~Team() {
  if (mpi_->is_asked) answer();
  for (Sent& sent : sent_) wait_quietly(sent.request);
  MPI_Win_unlock(0, mpi_->window);
  MPI_Win_free(&mpi_->window);
  MPI_Finalize();
}

double Team::nap(double waited) {
  const double length = std::clamp(waited * NAP_SHARE, SHORTEST_NAP, LONGEST_NAP);
  pause_for(length);
  return length;
}

void Team::send(const std::string& message) {
  sent_.remove_if([](Sent& sent) { return is_done(sent.request); });
  sent_.push_back({message});
  Sent& sent = sent_.back();
  MPI_Isend(sent.message.data(), static_cast<int>(sent.message.size()), MPI_BYTE, 0, MESSAGE_TAG, MPI_COMM_WORLD, &sent.request);
}

// Begins to receive what a source has sent. A large message takes time, because its sender may be working; rank 0 does not wait for it.
void Team::look_for(int source) {
  while (source != MPI_ANY_SOURCE || arriving_.size() < MOST_ARRIVING) {
    int is_there = 0, size = 0;
    MPI_Status status;
    MPI_Iprobe(source, MESSAGE_TAG, MPI_COMM_WORLD, &is_there, &status);
    if (is_there == 0) return;
    MPI_Get_count(&status, MPI_BYTE, &size);
    Arriving& arriving = arriving_.emplace_back();
    arriving.from = status.MPI_SOURCE;
    arriving.message.resize(static_cast<std::size_t>(size));
    MPI_Irecv(arriving.message.data(), size, MPI_BYTE, arriving.from, MESSAGE_TAG, MPI_COMM_WORLD, &arriving.request);
    if (source != MPI_ANY_SOURCE) return;
  }
}

// The first complete message of a source, with no earlier one of the same rank.
bool Team::take(int source, std::string& message, int& from) {
  for (auto one = arriving_.begin(); one != arriving_.end(); ++one) {
    if (source != MPI_ANY_SOURCE && source != one->from) continue;
    const bool is_next = std::none_of(arriving_.begin(), one, [&](const Arriving& earlier) { return earlier.from == one->from; });
    if (!is_next || !is_done(one->request)) continue;
    message = std::move(one->message);
    from = one->from;
    arriving_.erase(one);
    return true;
  }
  return false;
}

bool Team::receive(std::string& message, int& from) {
  look_for(MPI_ANY_SOURCE);
  return take(MPI_ANY_SOURCE, message, from);
}

std::string Team::wait_for(int from) {
  std::string message;
  int sender = 0;
  for (double waited = 0;; waited += nap(waited)) {
    const bool is_arriving =
        std::any_of(arriving_.begin(), arriving_.end(), [from](const Arriving& arriving) { return arriving.from == from; });
    if (!is_arriving) look_for(from);
    if (take(from, message, sender)) return message;
  }
}

void Team::gather(const std::string& message, const std::function<void(int rank, const std::string& message)>& look) {
  if (!is_leader()) return send(message);
  for (int rank = 1; rank < size_; ++rank) look(rank, wait_for(rank));
}

std::string Team::share(const std::string& from_leader) {
  std::string bytes = from_leader;
  std::uint64_t size = bytes.size();
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Ibcast(&size, 1, MPI_UINT64_T, 0, MPI_COMM_WORLD, &request);
  wait_quietly(request);
  bytes.resize(size);
  for (std::size_t at = 0; at < size; at += MOST_AT_ONCE) {
    MPI_Ibcast(bytes.data() + at, static_cast<int>(std::min(size - at, MOST_AT_ONCE)), MPI_BYTE, 0, MPI_COMM_WORLD, &request);
    wait_quietly(request);
  }
  return bytes;
}

void Team::meet() {
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Ibarrier(MPI_COMM_WORLD, &request);
  wait_quietly(request);
}

void Team::abort(ExitCode code) {
  MPI_Abort(MPI_COMM_WORLD, static_cast<int>(code));
  std::abort();  // which MPI does not come back to
}

void Team::restart_counter() {
  mpi_->first = 0;
  meet();
  if (is_leader()) {
    std::uint64_t zero = 0, before = 0;
    MPI_Fetch_and_op(&zero, &before, MPI_UINT64_T, 0, 0, MPI_REPLACE, mpi_->window);
    MPI_Win_flush(0, mpi_->window);
  }
  meet();
}

void Team::ask(std::uint64_t amount) {
  mpi_->amount = amount;
  mpi_->is_asked = true;
  // like MPI_Fetch_and_op, but with a request that can be tested
  MPI_Rget_accumulate(&mpi_->amount, 1, MPI_UINT64_T, &mpi_->first, 1, MPI_UINT64_T, 0, 0, 1, MPI_UINT64_T, MPI_SUM, mpi_->window,
                      &mpi_->question);
}

std::uint64_t Team::answer() {
  MPI_Wait(&mpi_->question, MPI_STATUS_IGNORE);
  MPI_Win_flush(0, mpi_->window);
  mpi_->is_asked = false;
  return mpi_->first;
}

bool Team::is_stopped() {
  if (mpi_->question != MPI_REQUEST_NULL) {
    int is_there = 0;
    MPI_Test(&mpi_->question, &is_there, MPI_STATUS_IGNORE);
    if (is_there == 0) return false;
  }
  return mpi_->first >= NO_MORE;
}

void Team::stop_counter() {
  std::uint64_t end = NO_MORE, before = 0;
  MPI_Fetch_and_op(&end, &before, MPI_UINT64_T, 0, 0, MPI_SUM, mpi_->window);  // of one kind with the others, as MPI wants it
  MPI_Win_flush(0, mpi_->window);
}

std::unique_ptr<OutputBytes> Team::open_output(const std::string& path) { return std::make_unique<MpiFile>(path); }

}  // namespace wholehand::sweeps
