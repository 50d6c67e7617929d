// SPDX-License-Identifier: MIT
#include "core/core_backend.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

#include "base/numbers/parallel.h"
#include "core/candidates.h"
#include "core/fills.h"
#include "core/gather.h"
#include "shaders/status.h"

namespace wholehand {
namespace {

constexpr std::size_t CHUNK = 512;  // grips at most
constexpr std::size_t LEAST_CHUNK = 16;
constexpr std::size_t CHUNK_STATES =
    80'000;  // of all its grips at most: some hundredths of a second of one thread, so that a run stops soon

#ifdef __clang__
constexpr const char* COMPILER = __VERSION__;
#else
constexpr const char* COMPILER = "g++ " __VERSION__;
#endif

using Clock = std::chrono::steady_clock;

// Room for the planes of one chunk, kept and scratch.
struct PlaneRoom {
  std::vector<double> reals;
  std::vector<std::uint32_t> uints;
  bool ready = false;
};

// One run: what its threads share.
class CoreRun {
 public:
  // `states`: of a grip, over fills and tilts.
  CoreRun(const Evaluator& evaluator, const FieldSet& fields, const RunRequest& request, int threads, std::size_t states)
      : evaluator_(evaluator),
        fields_(fields),
        request_(request),
        slots_(2 * static_cast<std::size_t>(threads)),
        best_(request.best) {
    // a short run in pieces for every thread
    const std::uint64_t count = request.last - request.first, pieces = 2 * static_cast<std::uint64_t>(threads);
    const std::size_t most = std::clamp<std::size_t>(CHUNK_STATES / std::max<std::size_t>(1, states), 1, CHUNK);
    chunk_ = static_cast<std::size_t>(std::clamp<std::uint64_t>((count + pieces - 1) / pieces, std::min(LEAST_CHUNK, most), most));
    chunks_ = (count + chunk_ - 1) / chunk_;
    for (PlaneRoom& slot : slots_) {
      slot.reals.resize(fields.real_planes * chunk_);
      slot.uints.resize(fields.uint_planes * chunk_);
    }
  }

  RunResult run(int threads) {
    std::vector<std::thread> workers;
    try {
      for (int i = 0; i < threads; ++i) workers.emplace_back([this] { work(); });
      deliver();
    } catch (...) {
      fail(std::current_exception());
    }
    for (std::thread& worker : workers) worker.join();
    if (failure_) std::rethrow_exception(failure_);
    RunResult result;
    result.best = best_.sorted();
    result.chunks = delivered_;
    result.done = std::min(delivered_ * chunk_, request_.last - request_.first);
    result.kernel_seconds = busy_seconds_;
    return result;
  }

 private:
  bool stopped() const { return request_.stop && request_.stop->load(); }
  std::uint64_t first_of(std::uint64_t chunk) const { return request_.first + chunk * chunk_; }
  std::size_t count_of(std::uint64_t chunk) const {
    return static_cast<std::size_t>(std::min<std::uint64_t>(chunk_, request_.last - first_of(chunk)));
  }

  void fail(std::exception_ptr failure) {
    const std::lock_guard lock(mutex_);
    if (!failure_) failure_ = failure;
    changed_.notify_all();
  }

  // A thread: takes the next chunk while a slot is free, evaluates it, hands it over.
  void work() {
    std::vector<GripInput> grips(chunk_);
    std::unique_lock lock(mutex_);
    for (;;) {
      changed_.wait(lock, [&] { return failure_ || taken_ == chunks_ || stopped() || taken_ < delivered_ + slots_.size(); });
      if (failure_ || taken_ == chunks_ || stopped()) {
        ended_ = true;
        changed_.notify_all();
        return;
      }
      const std::uint64_t chunk = taken_++;
      const double least_score = request_.least_score ? std::max(request_.least_score->load(), best_.least()) : NO_LEAST_SCORE;
      PlaneRoom& slot = slots_[chunk % slots_.size()];
      if (busy_++ == 0) busy_since_ = Clock::now();
      lock.unlock();
      std::exception_ptr failure;
      BestCandidates best(request_.best);
      try {
        request_.grips(request_.vessel, first_of(chunk), count_of(chunk), grips.data());
        evaluator_.planes(request_.vessel, grips.data(), count_of(chunk), fields_, chunk_, slot.reals.data(), slot.uints.data(),
                          least_score);
        if (request_.best > 0) offer(slot, chunk, best);
      } catch (...) {
        failure = std::current_exception();
      }
      lock.lock();
      if (--busy_ == 0) busy_seconds_ += std::chrono::duration<double>(Clock::now() - busy_since_).count();
      if (failure && !failure_) failure_ = failure;
      best_.offer(best.sorted());
      slot.ready = true;
      changed_.notify_all();
    }
  }

  void offer(const PlaneRoom& slot, std::uint64_t chunk, BestCandidates& best) const {
    const double* score = slot.reals.data() + fields_.plane[FIELD_SCORE] * chunk_;
    const std::uint32_t* status = slot.uints.data() + fields_.plane[FIELD_STATUS] * chunk_;
    for (std::size_t i = 0; i < count_of(chunk); ++i) {
      if (is_eligible(status[i])) best.offer({score[i], first_of(chunk) + i});
    }
  }

  // The calling thread: finished chunks go to the sink in ascending order.
  void deliver() {
    std::unique_lock lock(mutex_);
    for (;;) {
      PlaneRoom& slot = slots_[delivered_ % slots_.size()];
      changed_.wait(lock, [&] { return failure_ || slot.ready || (ended_ && delivered_ == taken_); });
      if (failure_ || !slot.ready) return;
      lock.unlock();
      if (request_.sink) {
        request_.sink(
            {request_.vessel, first_of(delivered_), count_of(delivered_), chunk_, nullptr, slot.reals.data(), slot.uints.data()});
      }
      lock.lock();
      slot.ready = false;
      ++delivered_;
      changed_.notify_all();
    }
  }

  const Evaluator& evaluator_;
  const FieldSet& fields_;
  const RunRequest& request_;
  std::size_t chunk_ = CHUNK;  // grips
  std::uint64_t chunks_ = 0;

  std::mutex mutex_;  // guards all below; a slot's planes belong to one thread at a time
  std::condition_variable changed_;
  std::vector<PlaneRoom> slots_;
  BestCandidates best_;
  std::uint64_t taken_ = 0;      // chunks handed out
  std::uint64_t delivered_ = 0;  // chunks that the sink has had
  bool ended_ = false;           // no further chunk will be taken
  int busy_ = 0;                 // threads evaluating
  Clock::time_point busy_since_;
  double busy_seconds_ = 0;
  std::exception_ptr failure_;
};

}  // namespace

BackendInfo core_info(Precision precision, int threads) {
  return {"core", fmt::format("core, {} thread{}", threads, threads == 1 ? "" : "s"), COMPILER, precision, true};
}

CoreBackend::CoreBackend(std::shared_ptr<const Evaluator> evaluator, const Scene& scene, const FieldSet& fields,
                         Precision precision, int threads)
    : scene_(scene), evaluator_(std::move(evaluator)), fields_(fields), threads_(thread_count(threads)) {
  info_ = core_info(precision, threads_);
}

bool CoreBackend::use_fills_of(const Scene& other) {
  if (!have_like_fills(scene_, other)) return false;
  take_fills(scene_, other);
  evaluator_ = info_.precision == Precision::full ? make_core_evaluator(scene_) : make_core_float_evaluator(scene_);
  return true;
}

RunResult CoreBackend::run(const RunRequest& request) {
  if (request.last <= request.first) return {};
  return CoreRun(*evaluator_, fields_, request, threads_, scene_fills(scene_) * scene_.tilts.size()).run(threads_);
}

std::vector<LiquidResult> CoreBackend::liquid(std::size_t vessel) { return core_liquid(scene_, *evaluator_, vessel); }

}  // namespace wholehand
