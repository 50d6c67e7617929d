// SPDX-License-Identifier: MIT
#include "host/stream.h"

#include <algorithm>
#include <cmath>
#include <deque>

#include "base/system/clock.h"
#include "host/slot.h"

namespace wholehand::host {
namespace {

constexpr std::size_t MAX_LOSSES = 3;  // of the device in one run; after that it is given up

std::string range_of(const Chunk& chunk) {
  return "items " + std::to_string(chunk.first) + " to " + std::to_string(chunk.first + chunk.count - 1);
}

struct Job {
  Chunk chunk;
  int failures = 0;  // of the device while it was in flight
};

struct Flight {
  Job job;
  std::unique_ptr<Slot> slot;
};

}  // namespace

struct Stream::Impl {
  ProgramFactory factory;
  StreamOptions options;
  std::unique_ptr<Program> program;         // null: lost, the next one is not made yet
  std::vector<std::unique_ptr<Slot>> idle;  // after the program: destroyed first
  std::vector<StreamInput> inputs;          // what the slots are made for
  std::vector<StreamOutput> outputs;
  std::size_t capacity = 0;             // of a slot, items
  std::size_t bound = ~std::size_t(0);  // items a chunk, after running out of memory
  std::size_t items = 0;                // in the next chunk
  std::size_t submits = 0;
  bool given_up = false;  // no device any more

  std::size_t multiple() const { return std::max<std::size_t>(1, options.item_multiple); }
  std::size_t round_up(std::size_t n) const { return (n + multiple() - 1) / multiple() * multiple(); }
};

namespace {

// The state of one run: what must be repeated, what is in flight (both in the order of the items), and where the rest starts.
class Run {
 public:
  Run(Stream::Impl& stream, const StreamRequest& request) : stream_(stream), request_(request), next_(request.first) {}

  StreamResult go() {
    try {
      while (step()) {
      }
    } catch (...) {
      release(true);
      throw;
    }
    return std::move(result_);
  }

 private:
  // Does one thing: submits while a slot is free, else delivers the oldest chunk in flight. False: everything is done.
  bool step() {
    std::unique_ptr<Slot> finished;
    try {
      if (shrinking_ && flights_.empty()) {
        release(true);
        shrinking_ = false;
      }
      const bool work = !again_.empty() || (next_ < request_.last && !stopping());
      const bool for_core = stream_.given_up || (!again_.empty() && again_.front().failures > 1);
      if (work && for_core && flights_.empty()) {
        fall_back();
        return true;
      }
      if (work && !for_core && !shrinking_ && prepare()) {
        submit();
        return true;
      }
      if (flights_.empty()) {
        return work;
      }
      try {
        finished = wait();
      } catch (const OutOfMemory& error) {
        throw DeviceLost(error.what());  // a running chunk cannot be halved any more
      }
    } catch (const OutOfMemory&) {
      on_out_of_memory();
      return true;
    } catch (const DeviceLost& error) {
      on_device_lost(error);
      return true;
    }
    finished->deliver(request_);  // outside: what the sink throws is the caller's
    count(finished->chunk);
    result_.bytes_in += finished->bytes_in;
    result_.bytes_out += finished->bytes_out;
    stream_.idle.push_back(std::move(finished));
    return true;
  }

  bool stopping() const { return request_.stop && request_.stop->load(std::memory_order_relaxed); }

  void count(const Chunk& chunk) {
    result_.items += chunk.count;
    result_.chunks++;
    result_.largest_chunk = std::max(result_.largest_chunk, chunk.count);
  }

  // A program and an idle slot; false when all slots are in flight, or when no program can be made.
  bool prepare() {
    if (!stream_.program) {
      try {
        stream_.program = stream_.factory();
      } catch (const std::exception& error) {
        stream_.given_up = true;
        result_.notes.push_back(std::string("no fresh device (") + error.what() + "): the rest is evaluated on the core");
        return false;
      }
    }
    DeviceState& device = stream_.program->device().state();
    const std::size_t slots = stream_.options.slots > 0 ? stream_.options.slots : device.info.unified_memory ? 2 : 3;
    if (flights_.empty()) {
      fit_slots(device, slots);
    }
    if (stream_.idle.empty() && flights_.size() < slots) {
      attempted_ = stream_.capacity;
      stream_.idle.push_back(
          checked("allocating the buffers of a chunk", [&] { return std::make_unique<Slot>(device, request_, stream_.capacity); }));
    }
    const auto [per_item, fixed] = Slot::bytes(device, request_);
    result_.slot_bytes =
        std::max(result_.slot_bytes, (stream_.idle.size() + flights_.size()) * (per_item * stream_.capacity + fixed));
    return !stream_.idle.empty();
  }

  // Makes slots for the largest chunk of this request that memory, limits and need allow, and keeps them for the next run if they fit.
  void fit_slots(const DeviceState& device, std::size_t slots) {
    const auto [per_item, fixed] = Slot::bytes(device, request_);
    const std::uint64_t budget = std::min<std::uint64_t>(stream_.options.slot_bytes, device.info.memory / (4 * slots));
    std::uint64_t most = std::min<std::uint64_t>(Slot::largest_capacity(device.info, request_), stream_.bound);
    most = std::min<std::uint64_t>(most, budget > fixed ? (budget - fixed) / std::max<std::size_t>(1, per_item) : 0);
    most = most / stream_.multiple() * stream_.multiple();
    if (most == 0) {
      throw failure_error("results of " + std::to_string(per_item) + " bytes an item do not fit the Vulkan device " +
                              device.info.name + "; keep fewer variables",
                          Remedy::or_core);
    }
    const std::size_t needed = stream_.round_up(std::min<std::uint64_t>(most, request_.last - request_.first));
    if (stream_.inputs != request_.inputs || stream_.outputs != request_.outputs || stream_.capacity < needed ||
        stream_.capacity > most) {
      stream_.idle.clear();
      stream_.inputs = request_.inputs;
      stream_.outputs = request_.outputs;
      stream_.capacity = needed;
    }
    const std::size_t items = stream_.items > 0 ? stream_.items : stream_.options.first_items;
    stream_.items = std::clamp(items / stream_.multiple() * stream_.multiple(), stream_.multiple(), stream_.capacity);
  }

  // The next chunk to evaluate, at the front of again_.
  Job& front() {
    if (again_.empty()) {
      const std::size_t items = stream_.items > 0 ? stream_.items : stream_.round_up(stream_.options.first_items);
      Job& job = again_.emplace_back();
      job.chunk.first = next_;
      job.chunk.count = std::min<std::uint64_t>(items, request_.last - next_);
      next_ += job.chunk.count;
    }
    Job& job = again_.front();
    if (!stream_.given_up && job.chunk.count > stream_.capacity) {  // it was planned when there was more memory
      Job rest = job;
      job.chunk.count = stream_.capacity;
      rest.chunk.first += job.chunk.count;
      rest.chunk.count -= job.chunk.count;
      again_.insert(again_.begin() + 1, rest);
    }
    again_.front().chunk.stride = stream_.round_up(again_.front().chunk.count);
    return again_.front();
  }

  void submit() {
    Job& job = front();
    Slot& slot = *stream_.idle.back();
    attempted_ = job.chunk.count;
    slot.fault = stream_.options.inject ? stream_.options.inject(stream_.submits) : SubmitFault::none;
    stream_.submits++;
    if (slot.fault == SubmitFault::out_of_memory) {
      throw OutOfMemory("injected");
    }
    checked("submitting a chunk", [&] { slot.submit(job.chunk, request_, *stream_.program); });
    flights_.push_back({job, std::move(stream_.idle.back())});
    stream_.idle.pop_back();
    again_.pop_front();
  }

  std::unique_ptr<Slot> wait() {
    Slot& slot = *flights_.front().slot;
    const double expected = 4 * seconds_per_item_ * static_cast<double>(slot.chunk.count);
    const double limit =
        stream_.options.timeout_seconds + (result_.kernel_seconds > 0 ? expected : stream_.program->device().state().wait_seconds);
    if (slot.fault == SubmitFault::device_lost) {
      throw DeviceLost("injected");
    }
    if (slot.fault == SubmitFault::timeout || !checked("waiting for a chunk", [&] { return slot.wait(limit); })) {
      throw DeviceLost("device timed out", Remedy::none, true);
    }
    const double now = monotonic_now();
    double seconds = checked("timing a chunk", [&] { return slot.seconds(); });
    if (seconds < 0) {
      seconds = now - std::max(slot.submitted, last_done_);
    }
    last_done_ = now;
    adapt(slot.chunk.count, std::max(seconds, 1e-9));
    std::unique_ptr<Slot> finished = std::move(flights_.front().slot);
    flights_.pop_front();
    return finished;
  }

  // Chooses the chunk size by the last chunk's time. A run's first chunk may include the kernel's compilation, so it does not shrink chunks; a chunk
  // much smaller than the present size (a rest, or one of the beginning) says little.
  void adapt(std::size_t count, double seconds) {
    const double target = stream_.options.target_seconds;
    const bool first = result_.kernel_seconds == 0;
    result_.kernel_seconds += seconds;
    seconds_per_item_ = seconds / static_cast<double>(count);
    if ((first && seconds > target) || 2 * count < stream_.items) {
      return;
    }
    const double wanted = std::min(4.0 * static_cast<double>(count), target / seconds_per_item_);
    const auto items = static_cast<std::size_t>(std::min(wanted, static_cast<double>(stream_.capacity)));
    stream_.items = std::clamp(items / stream_.multiple() * stream_.multiple(), stream_.multiple(), stream_.capacity);
  }

  // Retries half of what did not fit, after what is in flight; what cannot be halved goes to the core.
  void on_out_of_memory() {
    if (attempted_ <= stream_.multiple()) {
      front().failures = 2;
      note_once("out of memory", "out of memory for chunks of " + std::to_string(attempted_) + ": evaluated on the core");
    } else {
      stream_.bound = std::max(attempted_ / 2 / stream_.multiple(), std::size_t(1)) * stream_.multiple();
      stream_.items = std::min(stream_.items, stream_.bound);
      note_once("out of memory", "out of memory: chunks of " + std::to_string(stream_.bound) + " from here on");
    }
    shrinking_ = true;
  }

  // One line each, the latest.
  void note_once(const std::string& start, const std::string& line) {
    const auto place = std::ranges::find_if(result_.notes, [&](const std::string& note) { return note.starts_with(start); });
    if (place != result_.notes.end()) {
      *place = line;
    } else {
      result_.notes.push_back(line);
    }
  }

  // Repeats everything in flight on a fresh device; the oldest of it, or what was being submitted, counts as the cause.
  void on_device_lost(const DeviceLost& error) {
    std::vector<Job> lost;
    for (const Flight& flight : flights_) {
      lost.push_back(flight.job);
    }
    again_.insert(again_.begin(), lost.begin(), lost.end());
    Job& cause = front();
    cause.failures++;
    losses_++;
    const std::string what = (error.hung ? "device timed out: " : "device lost: ") + range_of(cause.chunk);
    result_.notes.push_back(what + (cause.failures > 1 ? " evaluated on the core" : " evaluated again on a fresh device"));
    if (losses_ > MAX_LOSSES) {
      stream_.given_up = true;
      result_.notes.push_back("device lost " + std::to_string(losses_) + " times: the rest is evaluated on the core");
    }
    release(false);
  }

  // Frees the slots and, unless it is kept, the program, once the device is done with them. If a device hangs, what it may still use is abandoned
  // instead of freed.
  void release(bool keep_program) {
    bool done = true;
    try {
      for (const Flight& flight : flights_) {
        done = done && flight.slot->wait(1);
      }
      if (done && stream_.program) {
        stream_.program->device().wait_idle();
      }
    } catch (const std::exception&) {
      // lost: nothing is at work any more
    }
    for (Flight& flight : flights_) {
      stream_.idle.push_back(std::move(flight.slot));
    }
    flights_.clear();
    if (!done) {
      stream_.program->device().state().hung = true;
    }
    stream_.idle.clear();
    if (!done || !keep_program) {
      stream_.program.reset();
    }
  }

  void fall_back() {
    const Chunk chunk = front().chunk;
    if (!request_.fallback) {
      throw failure_error("the Vulkan device failed at " + range_of(chunk) +
                              (result_.notes.empty() ? "" : " (" + result_.notes.back() + ")") + "; try again",
                          Remedy::or_core);
    }
    std::vector<std::vector<std::byte>> kept;
    std::vector<std::span<std::byte>> writable;
    std::vector<std::span<const std::byte>> readable;
    for (const StreamOutput& output : request_.outputs) {
      std::vector<std::byte>& bytes = kept.emplace_back(output.kept_per_item * chunk.stride + output.kept_fixed_bytes);
      writable.emplace_back(bytes);
      readable.emplace_back(bytes);
    }
    request_.fallback(chunk, writable);
    if (request_.sink) {
      request_.sink(chunk, readable);
    }
    count(chunk);
    result_.items_by_fallback += chunk.count;
    again_.pop_front();
  }

  Stream::Impl& stream_;
  const StreamRequest& request_;
  StreamResult result_;
  std::deque<Job> again_;
  std::deque<Flight> flights_;
  std::uint64_t next_;
  std::size_t attempted_ = 0;  // items of the last allocation or submit
  std::size_t losses_ = 0;
  bool shrinking_ = false;       // smaller slots are to be made once nothing is in flight
  double seconds_per_item_ = 0;  // of the last chunk
  double last_done_ = 0;         // when a chunk was, s of the clock
};

}  // namespace

Stream::Stream(ProgramFactory factory, StreamOptions options) : impl_(std::make_unique<Impl>()) {
  impl_->factory = std::move(factory);
  impl_->options = std::move(options);
  impl_->program = impl_->factory();
}

Stream::~Stream() = default;
Stream::Stream(Stream&&) noexcept = default;
Stream& Stream::operator=(Stream&&) noexcept = default;

Program& Stream::program() {
  if (!impl_->program) {
    impl_->program = impl_->factory();
  }
  return *impl_->program;
}

StreamResult Stream::run(const StreamRequest& request) { return Run(*impl_, request).go(); }

}  // namespace wholehand::host
