// SPDX-License-Identifier: MIT
// The tick path only computes: no allocation, no lock, and no system call besides the clock's and the device's own. The tests watch
// everything between device calls, from the first touch to the slip.
// sanitizers: none
#include <gtest/gtest.h>

#include <dlfcn.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/ptrace.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <mutex>
#include <new>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "device/loop/haptic_loop.h"
#include "device/simulated/sim_gripper.h"
#include "tests/support/live_script.h"
#include "tests/support/osc_peer.h"

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

namespace {

// Counts of this thread, while it is between two calls of the device.
thread_local bool is_watched = false;
thread_local long allocations = 0, locks = 0;

using LockFunction = int (*)(pthread_mutex_t*);
LockFunction next_of(const char* name) {
  LockFunction function = nullptr;
  void* found = dlsym(RTLD_NEXT, name);
  static_assert(sizeof found == sizeof function);
  __builtin_memcpy(&function, &found, sizeof found);
  return function;
}

}  // namespace

// These replace the allocator of the whole executable, but they only count.
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);

void* malloc(std::size_t size) noexcept {
  allocations += is_watched;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  allocations += is_watched;
  return __libc_calloc(count, size);
}
void* realloc(void* block, std::size_t size) noexcept {
  allocations += is_watched;
  return __libc_realloc(block, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  allocations += is_watched;
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** block, std::size_t alignment, std::size_t size) noexcept {
  allocations += is_watched;
  *block = __libc_memalign(alignment, size);
  return *block ? 0 : ENOMEM;
}
void free(void* block) noexcept {
  allocations += is_watched;
  __libc_free(block);
}
int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  static std::atomic<LockFunction> next{nullptr};
  LockFunction function = next.load(std::memory_order_relaxed);
  if (!function) next.store(function = next_of("pthread_mutex_lock"), std::memory_order_relaxed);
  locks += is_watched;
  return function(mutex);
}
int pthread_mutex_trylock(pthread_mutex_t* mutex) noexcept {
  static std::atomic<LockFunction> next{nullptr};
  LockFunction function = next.load(std::memory_order_relaxed);
  if (!function) next.store(function = next_of("pthread_mutex_trylock"), std::memory_order_relaxed);
  locks += is_watched;
  return function(mutex);
}
}

namespace wholehand::device {
namespace {

const std::atomic<bool> GOES_ON{false};

// What a run reports; in memory that a child shares with the test.
struct Seen {
  std::atomic<bool> is_watched{false};  // as seen from outside
  std::array<std::atomic<int>, SESSION_STATES> states{};
  std::atomic<bool> poured{false};
  std::atomic<long> allocations{0}, locks{0}, ticks{0}, slipping{0};
};

// Follows the script. Its own calls are not watched, what lies between them is; `misbehave` is called in between.
class WatchingGripper : public Gripper {
 public:
  WatchingGripper(Seen& seen, const LiveScript& script, std::function<void()> misbehave)
      : seen_(seen), script_(script), misbehave_(std::move(misbehave)) {
    limits_.force = 12;
    limits_.grip = 8;
    limits_.gap = own_gap(paper_hand());
    limits_.rate = script.rate;
  }
  const GripperLimits& limits() const noexcept override { return limits_; }
  ReadOutcome read(GripperState& state, std::int64_t tick) noexcept override {
    watch(false);
    state = script_.at(tick);
    is_over_ = static_cast<double>(tick) > script_.seconds() * script_.rate;
    watch(true);
    return ReadOutcome::value;
  }
  bool write(const GripperForce&) noexcept override {
    watch(false);
    watch(true);
    return true;
  }
  void show(const Tick& tick) noexcept override {
    ++seen_.states[static_cast<std::size_t>(tick.state)];
    seen_.slipping += tick.slip_speed > 0;
    if (tick.arrived[0] > 10e-6 && tick.flow > 0) seen_.poured = true;
    ++seen_.ticks;
    if (misbehave_) misbehave_();
  }
  bool is_done() const noexcept override { return is_over_; }

  void watch(bool on) noexcept {
    is_watched = on;
    seen_.is_watched = on;
  }

 private:
  Seen& seen_;
  LiveScript script_;
  std::function<void()> misbehave_;
  GripperLimits limits_;
  bool is_over_ = false;
};

void run_loop(Seen& seen, bool is_simulated, double hurry, const std::function<void()>& misbehave, Scene scene = live_scene()) {
  scene.live.late_steps = 1 << 30;  // a tick that is looked into takes its time
  scene.live.jump = 1e3;
  LiveScript script;
  script.hurry = hurry;
  script.vessel = scene.vessels[0].place;
  WatchingGripper gripper(seen, script, misbehave);
  Session session(scene, gripper.limits().gap);
  std::vector<Tick> record(20000);
  std::size_t recorded = 0;
  LoopOptions options;
  options.is_simulated = is_simulated;
  HapticLoop loop(
      scene.live, gripper, session, [&](const Tick& tick) { return record[recorded++ % record.size()] = tick, true; }, options);
  allocations = locks = 0;
  loop.run(GOES_ON);
  gripper.watch(false);
  seen.allocations = allocations;
  seen.locks = locks;
}

void expect_every_state(const Seen& seen) {
  for (int k = 0; k < SESSION_STATES; ++k) {
    const auto state = static_cast<SessionState>(k);
    if (state == SessionState::released || state == SessionState::let_go) continue;  // the script lets go in the air
    EXPECT_GT(seen.states[static_cast<std::size_t>(k)], 0) << SESSION_STATE_NAMES[static_cast<std::size_t>(k)];
  }
  EXPECT_TRUE(seen.poured);
}

// ---- allocations and locks ----

TEST(TickPath, NeitherAllocatesNorLocks) {
  for (const bool is_simulated : {true, false}) {
    Seen seen;
    run_loop(seen, is_simulated, is_simulated ? 1 : 5, {});
    expect_every_state(seen);
    EXPECT_EQ(seen.allocations, 0);
    EXPECT_EQ(seen.locks, 0);
  }
}

// The vessel slides until it is lost, by the tips' and by the whole hand's hold force.
TEST(TickPath, SlidingNeitherAllocatesNorLocks) {
  for (const SlideBy by : {SlideBy::tips, SlideBy::hand}) {
    Scene scene = live_scene();
    scene.strength.emplace();
    scene.force.base = 3;
    scene.force.max = 12;
    scene.live.slide = true;
    scene.live.slide_by = by;
    Seen seen;
    run_loop(seen, true, 1, {}, scene);
    EXPECT_GT(seen.slipping, 50);
    EXPECT_EQ(seen.allocations, 0);
    EXPECT_EQ(seen.locks, 0);
  }
}

TEST(TickPath, TheWatchSeesAnAllocation) {
  const std::vector<std::function<void()>> ways{
      [] { delete new volatile int(1); },
      [] { std::free(std::realloc(std::malloc(10), 100)); },
      [] { std::free(std::calloc(1, 8)); },
      [] { std::vector<double>(3).swap(*std::make_unique<std::vector<double>>()); },
      [] {
        try {
          throw 1;
        } catch (int) {
        }
      },
      [] { ::operator delete(::operator new(64, std::align_val_t(64)), std::align_val_t(64)); },
  };
  for (std::size_t k = 0; k < ways.size(); ++k) {
    Seen seen;
    run_loop(seen, true, 5, ways[k]);
    EXPECT_GE(seen.allocations, seen.ticks) << k;
    EXPECT_GT(seen.ticks, 1000);
  }
}

TEST(TickPath, TheWatchSeesALock) {
  std::mutex mutex;
  Seen seen;
  run_loop(seen, true, 5, [&] { const std::lock_guard<std::mutex> lock(mutex); });
  EXPECT_EQ(seen.locks, seen.ticks);
}

// Sending and receiving happen in the kernel; this program makes the other calls.
TEST(TickPath, AHandOverTheNetworkNeitherAllocatesNorLocks) {
  const Scene scene = live_scene();
  const OscPeer peer;
  const std::string first = osc_state(1, GripperState{}), garbage = "garbage", hello = osc_hello({0, 0.1, 12, 8});
  const auto gripper = open_said(scene, peer, {first});
  const int port = port_of(gripper->limits().address);
  const OscPeer stranger;
  GripperState state;
  const auto watched = [](const auto& call) {
    is_watched = true;
    const bool answer = call();
    is_watched = false;
    return answer;
  };
  allocations = locks = 0;
  std::uint32_t sign = 0;
  int seen = 0;
  for (std::int64_t tick = 0; tick < 200; ++tick) {
    GripperState next;
    next.buttons = ++sign;
    peer.send(osc_state(tick + 2, next), port);
    peer.send(garbage, port);
    peer.send(hello, port);
    stranger.send(first, port);
    watched([&] { return gripper->read(state, tick) == ReadOutcome::value; });
    EXPECT_TRUE(watched([&] { return gripper->write({{1, 2, 3}, 4}); }));
    seen += state.buttons > 0;
  }
  EXPECT_TRUE(watched([&] { return gripper->release() == ReleaseResult::written; }));
  EXPECT_TRUE(watched([&] { return gripper->panic() == ReleaseResult::written; }));
  EXPECT_EQ(allocations, 0);
  EXPECT_EQ(locks, 0);
  EXPECT_GT(seen, 0) << "they were read: how soon is the system's choice";
  EXPECT_EQ(gripper->notes_for_report().size(), 2u) << "garbage and strangers";
}

// ---- system calls ----

// Runs the loop on the clock in a child that its parent traces; `calls` gets the numbers of the system calls meanwhile. False: this
// system does not allow tracing.
bool watched_calls(std::set<long>& calls, Seen& seen, const std::function<void()>& misbehave) {
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    if (ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) != 0) _exit(77);
    raise(SIGSTOP);
    run_loop(seen, false, 5, misbehave);
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  if (!WIFSTOPPED(status)) return false;
  if (ptrace(PTRACE_SETOPTIONS, child, nullptr, PTRACE_O_TRACESYSGOOD | PTRACE_O_EXITKILL) != 0) return false;
  int signal = 0;
  for (;;) {
    if (ptrace(PTRACE_SYSCALL, child, nullptr, signal) != 0) return false;
    waitpid(child, &status, 0);
    if (!WIFSTOPPED(status)) break;
    const bool is_call = WSTOPSIG(status) == (SIGTRAP | 0x80);
    signal = is_call ? 0 : WSTOPSIG(status);
    if (!is_call || !seen.is_watched) continue;
    __ptrace_syscall_info info{};
    if (ptrace(PTRACE_GET_SYSCALL_INFO, child, sizeof info, &info) <= 0) continue;
    if (info.op == PTRACE_SYSCALL_INFO_ENTRY) calls.insert(static_cast<long>(info.entry.nr));
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

class Shared {
 public:
  Shared() : seen_(new (mmap(nullptr, sizeof(Seen), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)) Seen) {}
  ~Shared() { munmap(seen_, sizeof(Seen)); }
  Shared(const Shared&) = delete;
  Shared& operator=(const Shared&) = delete;
  Seen& operator*() const { return *seen_; }

 private:
  Seen* seen_;
};

TEST(TickPath, CallsNothingButTheClock) {
  Shared seen;
  std::set<long> calls;
  ASSERT_TRUE(watched_calls(calls, *seen, {})) << "this system does not let a child be watched (ptrace)";
  expect_every_state(*seen);
  EXPECT_TRUE(calls.count(SYS_clock_nanosleep));
  for (const long call : calls) EXPECT_TRUE(call == SYS_clock_nanosleep || call == SYS_clock_gettime) << "system call " << call;
}

TEST(TickPath, TheWatchSeesASystemCall) {
  Shared seen;
  std::set<long> calls;
  ASSERT_TRUE(watched_calls(calls, *seen, [] { static_cast<void>(getppid()); }))
      << "this system does not let a child be watched (ptrace)";
  EXPECT_TRUE(calls.count(SYS_getppid));
}

// A person who is shown grips, and takes them, from the mailbox of another thread.
TEST(TickPath, TakingAShownGripAllocatesAndLocksNothing) {
  const Scene scene = live_scene();
  ShownGrips shown;
  const auto gripper = open_sim(scene, 1, Participant(scene.people), {SimJob{SimJob::Kind::show, 0, {0.05}, 0.08, 0, {}}}, &shown);
  ShownGrip grip;
  grip.vessel = 0;
  grip.grip.height = 0.07;
  grip.gap = 0.08;
  GripperState state;
  Tick tick;
  const long before = allocations + locks;
  for (std::int64_t n = 0; n < 2500; ++n) {  // reaches, looks, enters
    if (n % 200 == 0) shown.put(grip);
    is_watched = true;
    gripper->read(state, n);
    gripper->write({});
    gripper->show(tick);
    is_watched = false;
  }
  EXPECT_EQ(allocations + locks, before);
  EXPECT_NEAR(state.position[1], scene.vessels[0].place[1] + 0.07, 5e-3) << "it has gone to the grip that was shown";
}

}  // namespace
}  // namespace wholehand::device

#endif
