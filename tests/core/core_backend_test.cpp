// SPDX-License-Identifier: MIT
// sanitizers: thread
#include "core/core_backend.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

#include "sweeps/plan/plan.h"
#include "tests/support/fake_backend.h"

namespace wholehand {
namespace {

constexpr std::uint64_t GRIPS = 5000;  // ten chunks, the last one short

Scene sobol_scene() {
  Scene scene = fake_scene();
  scene.grips.sampling = Sampling::sobol;
  scene.grips.count = GRIPS;
  return scene;
}

struct Delivery {
  RunResult result;
  std::vector<std::uint64_t> firsts;
  std::vector<double> scores;
  std::vector<std::uint32_t> masks;
};

class CoreBackendTest : public testing::Test {
 protected:
  Scene scene = sobol_scene();
  sweeps::Plan plan{scene, false};
  FieldSet fields = make_field_set({FIELD_SCORE, FIELD_TOUCH_MASK}, scene);

  // A backend over the stand-in kernels; `before_chunk` runs on its threads.
  CoreBackend backend(int threads, std::function<void()> before_chunk = {}) {
    auto evaluator = std::make_unique<FakeEvaluator>(scene);
    evaluator->before_chunk = std::move(before_chunk);
    return CoreBackend(std::move(evaluator), scene, fields, Precision::full, threads);
  }

  RunRequest request(std::uint64_t first = 0, std::uint64_t last = GRIPS) {
    RunRequest request;
    request.vessel = 1;
    request.first = first;
    request.last = last;
    request.best = 25;
    request.grips = [this](std::size_t v, std::uint64_t i, std::size_t n, GripInput* out) { plan.fill(v, i, n, out); };
    return request;
  }

  Delivery run(CoreBackend& backend, RunRequest wanted) {
    Delivery run;
    wanted.sink = [&, sink = wanted.sink](const PlaneChunk& chunk) {
      run.firsts.push_back(chunk.first);
      for (std::size_t i = 0; i < chunk.count; ++i) {
        run.scores.push_back(chunk.real(fields.plane[FIELD_SCORE], i));
        run.masks.push_back(chunk.uint(fields.plane[FIELD_TOUCH_MASK], i));
      }
      if (sink) sink(chunk);
    };
    run.result = backend.run(wanted);
    return run;
  }
};

TEST_F(CoreBackendTest, DeliversEveryGripInOrder) {
  CoreBackend core = backend(3);
  const Delivery all = run(core, request());
  ASSERT_EQ(all.scores.size(), GRIPS);
  EXPECT_EQ(all.result.done, GRIPS);
  EXPECT_EQ(all.result.chunks, all.firsts.size());
  EXPECT_TRUE(std::is_sorted(all.firsts.begin(), all.firsts.end()));
  for (std::uint64_t i = 0; i < GRIPS; ++i) {
    const GripInput grip = plan.grip(1, i);
    ASSERT_EQ(all.scores[i], fake_real(1, grip, FIELD_SCORE, 0)) << i;
    ASSERT_EQ(all.masks[i], fake_uint(1, grip, FIELD_TOUCH_MASK)) << i;
  }
}

TEST_F(CoreBackendTest, NothingDependsOnTheNumberOfThreads) {
  CoreBackend one = backend(1), many = backend(7);
  const Delivery a = run(one, request()), b = run(many, request());
  EXPECT_EQ(a.scores, b.scores);
  ASSERT_EQ(a.result.best.size(), 25u);
  for (std::size_t i = 0; i < 25; ++i) {
    EXPECT_EQ(a.result.best[i].index, b.result.best[i].index);
    EXPECT_EQ(a.result.best[i].score, b.result.best[i].score);
  }
}

TEST_F(CoreBackendTest, BestAreFeasibleAndPlausible) {
  CoreBackend core = backend(2);
  const RunResult result = core.run(request());
  double worst = 1;
  for (const Candidate& candidate : result.best) {
    const GripInput grip = plan.grip(1, candidate.index);
    EXPECT_EQ(fake_uint(1, grip, FIELD_STATUS) & STATUS_REASON_MASK, 0u);
    EXPECT_NE(fake_uint(1, grip, FIELD_STATUS) & STATUS_PLAUSIBLE, 0u);
    EXPECT_LE(candidate.score, worst);
    worst = candidate.score;
  }
  int better = 0;
  for (std::uint64_t i = 0; i < GRIPS; ++i) better += fake_real(1, plan.grip(1, i), FIELD_SCORE, 0) > worst;
  EXPECT_EQ(better, 24);
}

TEST_F(CoreBackendTest, AnyRangeAndAnEmptyOne) {
  CoreBackend core = backend(2);
  const Delivery part = run(core, request(1234, 4321));
  EXPECT_EQ(part.result.done, 4321u - 1234);
  EXPECT_EQ(part.scores.front(), fake_real(1, plan.grip(1, 1234), FIELD_SCORE, 0));
  EXPECT_EQ(part.scores.back(), fake_real(1, plan.grip(1, 4320), FIELD_SCORE, 0));
  EXPECT_EQ(core.run(request(7, 7)).done, 0u);
}

TEST_F(CoreBackendTest, StopsAfterTheChunksUnderWay) {
  std::atomic<bool> stop{false};
  CoreBackend core = backend(2);
  RunRequest wanted = request();
  wanted.stop = &stop;
  wanted.sink = [&](const PlaneChunk& chunk) {
    if (chunk.first >= 1000) stop = true;
  };
  const Delivery part = run(core, wanted);
  EXPECT_LT(part.result.done, GRIPS);
  EXPECT_GT(part.result.done, 1000u);
  EXPECT_EQ(part.scores.size(), part.result.done);
  for (const Candidate& candidate : part.result.best) EXPECT_LT(candidate.index, part.result.done) << "only delivered grips";
  // the rest, taken up later, completes it
  stop = false;
  RunRequest rest = request(part.result.done);
  EXPECT_EQ(part.result.done + core.run(rest).done, GRIPS);
}

TEST_F(CoreBackendTest, StopBeforeTheStartDeliversNothing) {
  const std::atomic<bool> stop{true};
  CoreBackend core = backend(2);
  RunRequest wanted = request();
  wanted.stop = &stop;
  EXPECT_EQ(core.run(wanted).done, 0u);
}

TEST_F(CoreBackendTest, ExceptionsEndTheRun) {
  CoreBackend core = backend(3);
  RunRequest wanted = request();
  wanted.sink = [](const PlaneChunk& chunk) {
    if (chunk.first > 0) throw std::runtime_error("full disk");
  };
  EXPECT_THROW(core.run(wanted), std::runtime_error);

  std::atomic<int> chunks{0};
  CoreBackend failing = backend(3, [&] {
    if (++chunks == 4) throw std::logic_error("kernel");
  });
  EXPECT_THROW(failing.run(request()), std::logic_error);

  wanted = request();
  wanted.grips = [](std::size_t, std::uint64_t, std::size_t, GripInput*) { throw std::out_of_range("plan"); };
  EXPECT_THROW(core.run(wanted), std::out_of_range);
}

TEST_F(CoreBackendTest, SlowSinkBoundsTheChunksThatWait) {
  std::atomic<int> evaluated{0}, delivered{0}, most{0};
  CoreBackend core = backend(2, [&] {
    const int ahead = ++evaluated - delivered;
    int seen = most;
    while (ahead > seen && !most.compare_exchange_weak(seen, ahead)) {
    }
  });
  RunRequest wanted = request();
  wanted.sink = [&](const PlaneChunk&) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    ++delivered;
  };
  core.run(wanted);
  EXPECT_LE(most, 2 * 2 + 1) << "two a thread, and the one that has just been delivered";
}

TEST_F(CoreBackendTest, SinkIsCalledAlsoWhenNothingIsKept) {
  fields = make_field_set({}, scene);
  CoreBackend core = backend(2);
  RunRequest wanted = request();
  std::uint64_t grips = 0;
  wanted.sink = [&](const PlaneChunk& chunk) { grips += chunk.count; };
  const RunResult result = core.run(wanted);
  EXPECT_EQ(grips, GRIPS);
  EXPECT_EQ(result.best.size(), 25u) << "the score is computed all the same";
}

TEST_F(CoreBackendTest, LiquidIsFillMajor) {
  CoreBackend core = backend(1);
  const FakeEvaluator evaluator(scene);
  const auto table = core.liquid(1);
  ASSERT_EQ(table.size(), 2u * 4);
  EXPECT_EQ(table[4 + 3].volume, evaluator.liquid(1, 0.5, radians(90)).volume);
  scene.liquid.reset();
  EXPECT_TRUE(backend(1).liquid(0).empty());
}

TEST_F(CoreBackendTest, SaysWhatItIs) {
  EXPECT_EQ(backend(1).info().device, "core, 1 thread");
  EXPECT_EQ(backend(4).info().device, "core, 4 threads");
  EXPECT_EQ(backend(0).info().backend, "core");
  EXPECT_TRUE(backend(4).info().is_cpu);
}

}  // namespace
}  // namespace wholehand
