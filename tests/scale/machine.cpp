// SPDX-License-Identifier: MIT
#include "tests/scale/machine.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <smpi/smpi.h>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <simgrid/s4u.hpp>
#include <stdexcept>

#include "base/system/clock.h"
#include "base/system/interrupt.h"
#include "sweeps/cluster/cluster_sweep.h"
#include "sweeps/cluster/team.h"
#include "sweeps/result/output_names.h"
#include "tests/scale/simulated_backend.h"

namespace wholehand::scale {
namespace {

namespace s4u = simgrid::s4u;

// Nodes on one switch, each with a link of its own.
std::vector<s4u::Host*> make_nodes(const Machine& machine) {
  auto* zone = s4u::create_star_zone("machine");
  std::vector<s4u::Host*> nodes;
  const int count = (machine.ranks + machine.ranks_per_node - 1) / machine.ranks_per_node;
  for (int node = 0; node < count; ++node) {
    s4u::Host* host = zone->create_host(fmt::format("node{}", node), 1e9);
    host->set_core_count(machine.ranks_per_node);
    auto* link = zone->create_split_duplex_link(fmt::format("link{}", node),
                                                machine.bandwidth / ENTRY_WEIGHT);  // nearly all bytes are entries
    link->set_latency(machine.latency / 2);                                         // a message takes two links
    link->seal();
    zone->add_route(host->get_netpoint(), nullptr, nullptr, nullptr, {{link, s4u::LinkInRoute::Direction::UP}}, true);
    host->seal();
    nodes.push_back(host);
  }
  zone->seal();
  return nodes;
}

// After the grips, the result is read back.
double read_back_seconds(const Job& job) {
  const Machine& machine = job.machine;
  const double bytes = static_cast<double>(job.grips) * machine.bytes_per_grip;
  const double nodes = std::ceil(static_cast<double>(machine.ranks) / machine.ranks_per_node);
  const double bandwidth = machine.reads_back_together ? nodes * machine.node_bandwidth : machine.node_bandwidth;
  return bytes / std::min(bandwidth, machine.write_bandwidth);
}

// What wholehand-mpi does on each rank.
void run_rank(const Scene& scene, const std::string& folder, InterruptGuard& interrupt) {
  int argc = 0;
  char** argv = nullptr;
  sweeps::Team team(argc, argv);
  const Job& job = simulation().job;
  const sweeps::SweepOptions options{
      .output = folder + "/simulated.nc",
      .on = "core",
      .refine = false,
      .threads = 1,
      .started = 0,
      .tuning = {.mark_seconds = job.machine.mark_seconds, .piece_seconds = job.machine.piece_seconds}};
  if (sweeps::run_cluster_sweep(team, scene, options, simulated_parts(scene), interrupt) != ExitCode::done)
    throw std::runtime_error("the sweep did not end as it should");
  if (team.is_leader()) {
    pause_for(read_back_seconds(job));
    simulation().outcome.end = now();
  }
}

Outcome run(const Job& job, const std::string& folder) {
  const auto began = std::chrono::steady_clock::now();
  Simulation& all = simulation();
  all.job = job;
  all.mark = sweeps::output_names(folder + "/simulated.nc").mark;
  std::string name = "wholehand-scale", quiet = "--log=root.thresh:warning";
  std::vector<char*> argv{name.data(), quiet.data(), nullptr};
  int argc = 2;
  s4u::Engine engine(&argc, argv.data());
  // no time passes for the host's own work; MPI's polling costs nothing beyond our own naps; latencies and bandwidths as they are stated
  for (const char* setting : {"smpi/simulate-computation:no", "smpi/test:0", "smpi/iprobe:0", "smpi/grow-injected-times:no",
                              "smpi/async-small-thresh:65536", "smpi/send-is-detached-thresh:65536", "network/model:CM02",
                              "network/loopback-bw:10e9", "network/loopback-lat:5e-7", "contexts/stack-size:1024"})
    engine.set_config(setting);
  const std::vector<s4u::Host*> nodes = make_nodes(job.machine);
  all.nodes.resize(nodes.size());
  SMPI_init();
  SMPI_app_instance_register("sweep", nullptr, job.machine.ranks);
  const Scene scene = simulated_scene(job.grips, job.machine.entries / ENTRY_WEIGHT);
  InterruptGuard interrupt;
  for (int rank = 0; rank < job.machine.ranks; ++rank) {
    const auto actor = s4u::Actor::init(fmt::format("rank{}", rank), nodes[static_cast<std::size_t>(node_of(rank))]);
    actor->set_property("instance_id", "sweep");
    actor->set_property("rank", std::to_string(rank));
    actor->start([&] { run_rank(scene, folder, interrupt); });
  }
  engine.run();
  SMPI_finalize();
  Outcome outcome = all.outcome;
  const double rates = job.machine.rate * (job.machine.ranks - (job.machine.straggler >= 0 ? 1 - job.machine.straggler_speed : 0));
  outcome.efficiency = static_cast<double>(job.grips) / rates / outcome.end;
  outcome.real_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return outcome;
}

// Each rank has the result file open.
void raise_limits() {
  rlimit limit{};
  getrlimit(RLIMIT_NOFILE, &limit);
  limit.rlim_cur = limit.rlim_max;
  setrlimit(RLIMIT_NOFILE, &limit);
}

}  // namespace

Simulation& simulation() {
  static Simulation all;
  return all;
}

void charge_mark() {
  static std::array<std::int64_t, 3> last{};
  Simulation& all = simulation();
  struct stat file {};
  if (own_rank() != 0 || stat(all.mark.c_str(), &file) != 0) return;
  const std::array<std::int64_t, 3> now_there{static_cast<std::int64_t>(file.st_ino), file.st_mtim.tv_sec, file.st_mtim.tv_nsec};
  if (now_there == last) return;
  last = now_there;
  const double seconds = (static_cast<double>(all.pieces) + all.job.machine.entries) * all.job.machine.mark_line_seconds;
  all.outcome.leader_seconds += seconds;
  sleep_until(now() + seconds + all.job.machine.sync_seconds);  // a mark is synced, too
}

double rate_of_all(const Machine& machine) {
  return machine.rate * (machine.ranks - (machine.straggler >= 0 ? 1 - machine.straggler_speed : 0));
}

double now() { return monotonic_now(); }

void sleep_until(double time) {
  if (time > now()) s4u::this_actor::sleep_until(time);
}

int own_rank() {
  thread_local const char* name = nullptr;
  name = s4u::Actor::self()->get_property("rank");
  return std::atoi(name);
}

int node_of(int rank) { return rank / simulation().job.machine.ranks_per_node; }

namespace {

// A job in a process of its own.
struct Running {
  std::size_t number = 0;
  pid_t process = -1;
  int from = -1;
};

[[noreturn]] void run_child(const Job& job, bool is_loud, int to) {
  if (!is_loud) {
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
  }
  raise_limits();
  std::string folder = (std::filesystem::temp_directory_path() / "wholehand-scale.XXXXXX").string();
  bool is_well = mkdtemp(folder.data()) != nullptr;
  if (is_well) {
    try {
      const Outcome outcome = run(job, folder);
      is_well = write(to, &outcome, sizeof outcome) == sizeof outcome;
    } catch (const std::exception& error) {
      fmt::print(stderr, "wholehand-scale: {}\n", error.what());
      is_well = false;
    }
    std::filesystem::remove_all(folder);
  }
  std::fflush(nullptr);
  _exit(is_well ? 0 : 1);
}

Running begin(const std::vector<Job>& jobs, std::size_t number, bool is_loud) {
  int ends[2] = {-1, -1};
  if (pipe(ends) != 0) throw std::runtime_error("no pipe can be made");
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no process can be started");
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // nobody would read its outcome
    run_child(jobs[number], is_loud, ends[1]);
  }
  close(ends[1]);
  return {number, child, ends[0]};
}

}  // namespace

void simulate(const std::vector<Job>& jobs, int at_a_time, bool is_loud,
              const std::function<void(std::size_t, const Outcome&)>& take) {
  std::vector<Running> running;
  for (std::size_t next = 0; next < jobs.size() || !running.empty();) {
    while (next < jobs.size() && running.size() < static_cast<std::size_t>(at_a_time))
      running.push_back(begin(jobs, next++, is_loud));
    const pid_t ended = waitpid(-1, nullptr, 0);
    const auto one = std::find_if(running.begin(), running.end(), [ended](const Running& job) { return job.process == ended; });
    if (one == running.end()) continue;
    Outcome outcome;
    const bool is_there = read(one->from, &outcome, sizeof outcome) == sizeof outcome;
    close(one->from);
    if (!is_there)
      throw std::runtime_error(fmt::format("the simulation of {} ranks failed; --loud shows why", jobs[one->number].machine.ranks));
    take(one->number, outcome);
    running.erase(one);
  }
}

}  // namespace wholehand::scale
