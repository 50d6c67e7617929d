// SPDX-License-Identifier: MIT
// What the C face costs beside the C++ that it calls: a session's step, and many grips. The two ways take turns, so that what else the machine
// does is the same for both; `ratio` is C over C++, and `added_us` the difference for one step or grip.
#include <algorithm>
#include <chrono>
#include <memory>
#include <vector>

#include "app/c/scene.h"
#include "app/c/wholehand/wholehand.h"
#include "base/text/error.h"
#include "core/core_backend.h"
#include "device/session/session.h"
#include "device/session/workspace.h"
#include "host/open_backend.h"
#include "sweeps/plan/variables.h"
#include "tests/bench/bench.h"
#include "tests/support/live_script.h"

namespace wholehand::bench {
namespace {

using Clock = std::chrono::steady_clock;
double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

wh_scene handle_of(const Scene& scene) {
  const auto ready = std::make_shared<ReadyScene>(ReadyScene{scene, nullptr, AskedGrips(scene)});
  ready->core = make_core_evaluator(ready->scene);
  return wh_scene{ready};
}

void must(wh_status status) {
  if (status != WH_OK) throw failure_error(wh_message());
}

void report_rates(benchmark::State& state, double cpp, double c, double items) {
  state.SetItemsProcessed(static_cast<std::int64_t>(items));
  state.counters["ratio"] = c / cpp;
  state.counters["added_us"] = (c - cpp) / items * 1e6;
}

// A session that approaches, lifts, tilts and pours.
void session_step(benchmark::State& state) {
  const Scene scene = live_scene();
  const wh_scene handle = handle_of(scene);
  const auto gap = own_gap(scene.hand);
  LiveScript script;
  script.vessel = scene.vessels[0].place;
  const auto ticks = static_cast<std::int64_t>(script.seconds() * script.rate);
  std::vector<device::GripperState> states;
  std::vector<wh_measurement> measured(static_cast<std::size_t>(ticks));
  for (std::int64_t n = 0; n < ticks; ++n) {
    states.push_back(script.at(n));
    wh_measurement& in = measured[static_cast<std::size_t>(n)];
    WH_INIT(&in);
    in.tick = n;
    std::copy(states.back().position.begin(), states.back().position.end(), in.position);
    std::copy(states.back().rotation.begin(), states.back().rotation.end(), in.rotation);
    in.gap = states.back().gap;
  }
  double cpp = 0, c = 0, steps = 0;
  for (auto _ : state) {
    device::Session session(scene, gap);
    device::Tick tick;
    wh_session* handled = nullptr;
    must(wh_session_open(&handle, gap[0], gap[1], &handled));
    wh_session_output out;
    WH_INIT(&out);
    constexpr std::int64_t TURN = 500;
    for (std::int64_t first = 0; first < ticks; first += TURN) {
      const std::int64_t last = std::min(ticks, first + TURN);
      auto start = Clock::now();
      for (std::int64_t n = first; n < last; ++n) session.step(states[static_cast<std::size_t>(n)], n, tick);
      cpp += since(start);
      start = Clock::now();
      for (std::int64_t n = first; n < last; ++n) must(wh_session_step(handled, &measured[static_cast<std::size_t>(n)], &out));
      c += since(start);
    }
    benchmark::DoNotOptimize(tick.wanted);
    benchmark::DoNotOptimize(out.grip_force);
    wh_session_free(&handled);
    steps += static_cast<double>(ticks);
    state.SetIterationTime(c);
  }
  report_rates(state, cpp, c, steps);
}

// The default scene's grips on one thread of the core, their scores and masks kept.
void library_grips(benchmark::State& state) {
  const Scene scene = grips_scene(4);
  const wh_scene handle = handle_of(scene);
  const char* names[] = {"score", "touch_mask"};
  wh_batch* batch = nullptr;
  must(wh_batch_open(&handle, names, 2, "core", 1, 1, &batch));
  const auto backend =
      open_backend(scene, make_field_set({FIELD_SCORE, FIELD_TOUCH_MASK, FIELD_STATUS}, scene), "core", Precision::full, 1);
  const sweeps::Plan plan(scene, false);
  const auto count = static_cast<std::size_t>(plan.grips());
  std::vector<double> rows(count * WH_GRIP_COLUMNS), score(count), expected(count);
  std::vector<std::int32_t> mask(count), expected_mask(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto numbers = grip_numbers(plan.grip(0, i));
    std::copy(numbers.begin(), numbers.end(), rows.begin() + static_cast<std::ptrdiff_t>(i * WH_GRIP_COLUMNS));
  }
  wh_output outputs[2];
  for (wh_output& output : outputs) WH_INIT(&output);
  outputs[0].data = score.data();
  outputs[1].data = mask.data();
  outputs[1].type = WH_INT32;
  RunRequest request;
  request.last = count;
  request.grips = [&](std::size_t, std::uint64_t first, std::size_t size, GripInput* out) {
    for (std::size_t i = 0; i < size; ++i) {
      const double* row = &rows[(first + i) * WH_GRIP_COLUMNS];
      out[i] = {row[0], row[1], row[2], row[3], row[4], row[5]};
    }
  };
  const int score_plane = backend->fields().plane[FIELD_SCORE], mask_plane = backend->fields().plane[FIELD_TOUCH_MASK];
  request.sink = [&](const PlaneChunk& chunk) {
    for (std::size_t i = 0; i < chunk.count; ++i) {
      expected[chunk.first + i] = chunk.real(score_plane, i);
      expected_mask[chunk.first + i] = static_cast<std::int32_t>(chunk.uint(mask_plane, i));
    }
  };
  double cpp = 0, c = 0, grips = 0;
  for (auto _ : state) {
    auto start = Clock::now();
    backend->run(request);
    cpp += since(start);
    start = Clock::now();
    must(wh_batch_run(batch, 0, rows.data(), count, 0, outputs, 2));
    const double seconds = since(start);
    c += seconds;
    grips += static_cast<double>(count);
    state.SetIterationTime(seconds);
  }
  if (score != expected || mask != expected_mask) state.SkipWithError("the two ways differ");
  wh_batch_free(&batch);
  report_rates(state, cpp, c, grips);
}

}  // namespace

void add_library_benchmarks() {
  benchmark::RegisterBenchmark("library_session_step", session_step)->UseManualTime()->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("library_grips", library_grips)->UseManualTime()->Unit(benchmark::kMillisecond);
}

}  // namespace wholehand::bench
