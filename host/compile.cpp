// SPDX-License-Identifier: MIT
#include "host/compile.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <numeric>
#include <optional>
#include <system_error>
#include <thread>

#include "base/numbers/parallel.h"
#include "base/system/clock.h"
#include "host/step_recorder.h"
#include "shaders/layout.h"

namespace wholehand::host {
namespace {

constexpr std::chrono::milliseconds BETWEEN_CALLS{100};  // of the watch
constexpr double READ_SECONDS = 0.05;         // an empty dispatch that takes longer compiles; reading finished code takes 0.01 s
constexpr std::size_t ANY_BUFFER = 16 << 10;  // bytes: no kernel has a larger uniform block
static_assert(2 * STATES_IN_BLOCK * 4 * sizeof(double) <= ANY_BUFFER && 4 * HAND_VECTORS * sizeof(double) <= ANY_BUFFER);

// Shared by the threads. A thread that never returns from the driver keeps it forever.
struct Compiling {
  std::vector<KernelRequest> requests;
  std::vector<std::optional<Kernel>> made;
  std::vector<std::size_t> order;  // order of taking kernels: the slowest first
  std::size_t taken = 0, done = 0;
  std::exception_ptr failure;
  bool is_over = false;       // no further kernel is taken
  bool is_abandoned = false;  // the driver keeps threads
  std::mutex mutex;
  std::condition_variable changed;

  // The next kernel; none if all are taken.
  std::optional<std::size_t> take() {
    const std::lock_guard lock(mutex);
    if (is_over || taken == order.size()) return {};
    return order[taken++];
  }

  void finish() {
    const std::lock_guard lock(mutex);
    ++done;
    changed.notify_all();
  }

  std::size_t left() {
    const std::lock_guard lock(mutex);
    return order.size() - taken;
  }

  void fail() {
    const std::lock_guard lock(mutex);
    if (!failure) failure = std::current_exception();
    is_over = true;
    changed.notify_all();
  }
};

// A dispatch of no groups: llvmpipe compiles the kernel for it.
class EmptyDispatch {
 public:
  EmptyDispatch(DeviceState& on, const Kernel& kernel, std::size_t texel_bytes)
      : on_(on), any_(on, ANY_BUFFER, Memory::device), recorder_(on, on.compute.family), done_(*on.device, vk::FenceCreateInfo()) {
    std::ranges::fill(any_.mapped(), std::byte{0});
    Commands commands;
    for (const auto& [binding, type] : kernel.state().bindings) {
      const bool is_texels = type == vk::DescriptorType::eUniformTexelBuffer;
      if (is_texels) texels_ = Buffer(on, texel_bytes, Memory::device);
      commands.bind(binding, is_texels ? texels_ : any_);
    }
    commands.dispatch(kernel, {0, 1, 1}, Push{});
    recorder_.begin();
    recorder_.steps(commands);
    recorder_.end();
    recorder_.submit(on.compute.queue, {}, {}, *done_);
  }
  ~EmptyDispatch() {
    try {
      if (!on_.hung && !wait(on_.wait_seconds)) on_.hung = true;
    } catch (const std::exception&) {
      // lost: nothing is at work any more
    }
    leave_behind(on_, done_);
  }
  EmptyDispatch(const EmptyDispatch&) = delete;
  EmptyDispatch& operator=(const EmptyDispatch&) = delete;

  bool wait(double seconds) { return wait_for(on_, *done_, seconds); }

 private:
  DeviceState& on_;
  Buffer any_, texels_;
  StepRecorder recorder_;
  vk::raii::Fence done_;
};

// Threads that end with the work, or are abandoned to a driver that does not return.
class Threads {
 public:
  explicit Threads(std::shared_ptr<Compiling> work) : work_(std::move(work)) {}
  ~Threads() {
    std::unique_lock lock(work_->mutex);
    work_->is_over = true;
    const bool is_abandoned = work_->is_abandoned;
    lock.unlock();
    for (std::thread& thread : threads_) is_abandoned ? thread.detach() : thread.join();
  }
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;

  // As many as the system grants. Returns whether it grants any.
  template <class Task>
  bool start(std::size_t count, const Task& task) {
    const auto guarded = [work = work_, task] {
      try {
        task(*work);
      } catch (...) {
        work->fail();
      }
    };
    try {
      for (std::size_t i = 0; i < count; ++i) threads_.emplace_back(guarded);
    } catch (const std::system_error&) {
      // those that there are do it
    }
    return !threads_.empty();
  }

  void join() {
    for (std::thread& thread : threads_) thread.join();
    threads_.clear();
  }

 private:
  std::shared_ptr<Compiling> work_;
  std::vector<std::thread> threads_;
};

// Calls the watch during the work, and abandons the device if no kernel completes for too long.
class Patience {
 public:
  Patience(Device& device, Compiling& work, const CompileWatch& watch) : device_(device), work_(work), watch_(watch) {}

  void restart() { since_ = monotonic_now(); }

  void wait_for_all() {
    std::unique_lock lock(work_.mutex);
    while (work_.done < work_.requests.size() && !work_.failure) {
      work_.changed.wait_for(lock, BETWEEN_CALLS);
      lock.unlock();
      check();
      lock.lock();
    }
  }

  void check() {
    std::unique_lock lock(work_.mutex);
    const std::size_t done = work_.done, count = work_.requests.size();
    if (done != last_) since_ = monotonic_now();
    last_ = done;
    const double limit = device_.state().wait_seconds;
    if (monotonic_now() - since_ > limit) {
      work_.is_over = work_.is_abandoned = true;
      const std::string name = device_.info().name;
      device_.abandon();
      throw DeviceLost(fmt::format("{} compiled {} of {} kernels, and no further one within {} s; try again", name, done, count,
                                   std::lround(limit)),
                       Remedy::or_core, true);
    }
    lock.unlock();
    if (watch_) watch_(device_.info(), done, count);
  }

 private:
  Device& device_;
  Compiling& work_;
  CompileWatch watch_;
  std::size_t last_ = 0;
  double since_ = monotonic_now();
};

void make(const DeviceState& device, Compiling& work) {
  while (const std::optional<std::size_t> k = work.take()) {
    const KernelRequest& request = work.requests[*k];
    work.made[*k].emplace(device, request.words, request.constants, request.name);
    work.finish();
  }
}

// Compiles kernels on its own device into Mesa's cache, where other llvmpipe devices find them. The driver writes there on a thread for which the end
// of its instance waits. Failures here are compiled later, by the device that needs the kernel.
void fill_cache(const DeviceInfo& info, DeviceOptions options, Compiling& work) {
  std::optional<std::size_t> k;
  try {
    options.has_own_instance = true;
    const Device own("vulkan:" + std::to_string(info.index), options);
    while ((k = work.take())) {
      const Kernel kernel(own.state(), work.made[*k]->words(), {}, work.requests[*k].name);
      EmptyDispatch dispatch(own.state(), kernel, work.requests[*k].texel_bytes);
      if (!dispatch.wait(options.wait_seconds)) own.state().hung = true;
      work.finish();
      if (own.state().hung) return;
    }
  } catch (const std::exception&) {
    if (k) work.finish();  // out of memory, perhaps
  }
}

// Has llvmpipe compile the kernels, or read what it compiled before.
void compile_on_llvmpipe(Device& device, const DeviceOptions& options, Compiling& work, Threads& threads, Patience patience) {
  std::vector<bool> is_there(work.requests.size());
  bool has_help = false;
  const auto run = [&](std::size_t k) {
    EmptyDispatch dispatch(device.state(), *work.made[k], work.requests[k].texel_bytes);
    if (dispatch.wait(READ_SECONDS)) return;
    patience.restart();
    if (!has_help)
      threads.start(std::min<std::size_t>(thread_count() - 1, work.left()),
                    [info = device.info(), options](Compiling& own) { fill_cache(info, options, own); });
    has_help = true;
    while (!dispatch.wait(std::chrono::duration<double>(BETWEEN_CALLS).count())) patience.check();
  };
  while (const std::optional<std::size_t> k = work.take()) {
    run(*k);
    is_there[*k] = true;
    work.finish();
  }
  patience.wait_for_all();
  threads.join();
  for (std::size_t k = 0; k < is_there.size(); ++k)
    if (!is_there[k]) run(k);
}

}  // namespace

std::vector<Kernel> compile(Device& device, const DeviceOptions& options, std::vector<KernelRequest> requests,
                            const CompileWatch& watch) {
  const auto work = std::make_shared<Compiling>();
  const std::size_t count = requests.size();
  work->requests = std::move(requests);
  work->made.resize(count);
  work->order.resize(count);
  std::iota(work->order.begin(), work->order.end(), std::size_t{0});
  std::ranges::stable_sort(work->order, std::greater(), [&](std::size_t k) { return work->requests[k].words.size(); });
  const DeviceInfo info = device.info();
  const auto done = [&] {
    if (watch) watch(info, count, count);
  };
  Threads threads(work);
  try {
    const bool is_lazy = is_llvmpipe(info);
    const auto make_some = [&on = device.state()](Compiling& own) { make(on, own); };
    if (!threads.start(std::min<std::size_t>(thread_count(), count), make_some)) make_some(*work);
    Patience(device, *work, is_lazy ? CompileWatch() : watch).wait_for_all();
    threads.join();
    if (work->failure) std::rethrow_exception(work->failure);
    if (is_lazy) {
      work->taken = work->done = 0;
      compile_on_llvmpipe(device, options, *work, threads, Patience(device, *work, watch));
    }
  } catch (...) {
    done();
    throw;
  }
  done();
  std::vector<Kernel> kernels;
  for (std::optional<Kernel>& kernel : work->made) kernels.push_back(std::move(*kernel));
  return kernels;
}

}  // namespace wholehand::host
