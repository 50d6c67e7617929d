// SPDX-License-Identifier: MIT
// Many grips, some variables: planes of a backend's chunks become NumPy arrays.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <exception>
#include <future>

#include "app/program/vulkan_environment.h"
#include "app/python/bind.h"
#include "app/python/columns.h"
#include "app/python/scene.h"
#include "base/numbers/parallel.h"
#include "base/text/error.h"
#include "host/open_backend.h"
#include "shaders/status.h"
#include "sweeps/lists/different_grips.h"
#include "sweeps/lists/robust.h"
#include "sweeps/run/auto_backend.h"

namespace py = pybind11;

namespace wholehand {
namespace {

constexpr std::chrono::milliseconds SIGNALS_EVERY{50};  // between two checks for Ctrl-C

// The destination of one variable's values: an array of (grips, values of a grip), C-contiguous.
struct Output {
  const sweeps::Variable* variable = nullptr;
  int plane = 0;           // first
  std::size_t values = 1;  // of a grip
  py::array array;
  void* data = nullptr;
};

py::dtype type_of(const sweeps::Variable& variable, Precision precision) {
  if (variable.type == sweeps::NumberType::real)
    return precision == Precision::single ? py::dtype::of<float>() : py::dtype::of<double>();
  const bool is_mask = variable.bits > 0;
  if (variable.type == sweeps::NumberType::byte) return is_mask ? py::dtype::of<std::uint8_t>() : py::dtype::of<std::int8_t>();
  return is_mask ? py::dtype::of<std::uint32_t>() : py::dtype::of<std::int32_t>();
}

std::vector<py::ssize_t> shape_of(const sweeps::Variable& variable, const Scene& scene, std::size_t count) {
  std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(count)};
  for (const std::string_view dim : variable.dims) {
    const std::size_t length = dim == "fill"    ? scene_fills(scene)
                               : dim == "tilt"  ? scene.tilts.size()
                               : dim == "joint" ? JOINT_COUNT
                               : dim == "xyz"   ? 3
                                                : 2;
    shape.push_back(static_cast<py::ssize_t>(length));
  }
  return shape;
}

std::vector<Output> make_outputs(const Batch& batch, const Scene& scene, std::size_t count) {
  const FieldSet& fields = batch.backend->fields();
  std::vector<Output> outputs;
  for (const sweeps::Variable* variable : batch.variables) {
    Output output;
    output.variable = variable;
    output.plane = fields.plane[static_cast<std::size_t>(variable->field)] + variable->plane;
    output.values = sweeps::variable_planes(*variable, scene);
    output.array = py::array(type_of(*variable, batch.backend->info().precision), shape_of(*variable, scene, count));
    output.data = output.array.mutable_data();
    outputs.push_back(std::move(output));
  }
  return outputs;
}

template <class Number>
void put_reals(const Output& output, const PlaneChunk& chunk, const Number* reals) {
  auto* to = static_cast<Number*>(output.data) + chunk.first * output.values;
  const Number* planes = reals + static_cast<std::size_t>(output.plane) * chunk.stride;
  if (output.values == 1) {
    std::memcpy(to, planes, chunk.count * sizeof(Number));
    return;
  }
  // some grips at a time, whose rows stay in the nearest cache while plane after plane is read
  constexpr std::size_t AT_ONCE = 32;
  for (std::size_t begin = 0; begin < chunk.count; begin += AT_ONCE) {
    const std::size_t end = std::min(begin + AT_ONCE, chunk.count);
    for (std::size_t v = 0; v < output.values; ++v)
      for (std::size_t i = begin; i < end; ++i) to[i * output.values + v] = planes[v * chunk.stride + i];
  }
}

// The core in float returns doubles that fit both.
void put_rounded(const Output& output, const PlaneChunk& chunk) {
  auto* to = static_cast<float*>(output.data) + chunk.first * output.values;
  for (std::size_t v = 0; v < output.values; ++v)
    for (std::size_t i = 0; i < chunk.count; ++i)
      to[i * output.values + v] = static_cast<float>(chunk.real(output.plane + static_cast<int>(v), i));
}

template <class Number>
void put_words(const Output& output, const PlaneChunk& chunk, int status) {
  const sweeps::Variable& variable = *output.variable;
  auto* to = static_cast<Number*>(output.data) + chunk.first;
  for (std::size_t i = 0; i < chunk.count; ++i) {
    const bool exists = variable.always || is_feasible(chunk.uint(status, i));
    to[i] = static_cast<Number>(exists ? variable.value(chunk.uint(output.plane, i)) : variable.missing);
  }
}

void put(const Output& output, const PlaneChunk& chunk, const FieldSet& fields, Precision precision) {
  const sweeps::Variable& variable = *output.variable;
  if (variable.type == sweeps::NumberType::real) {
    if (chunk.floats) return put_reals(output, chunk, chunk.floats);
    return precision == Precision::single ? put_rounded(output, chunk) : put_reals(output, chunk, chunk.doubles);
  }
  const int status = fields.plane[FIELD_STATUS];
  const bool is_mask = variable.bits > 0;
  if (variable.type == sweeps::NumberType::byte)
    return is_mask ? put_words<std::uint8_t>(output, chunk, status) : put_words<std::int8_t>(output, chunk, status);
  return is_mask ? put_words<std::uint32_t>(output, chunk, status) : put_words<std::int32_t>(output, chunk, status);
}

// Runs `work` on its own thread, without the interpreter's lock, while this thread checks regularly whether Python's signal handlers want to raise:
// only the main thread may, however long a piece of the work takes. `work` ends soon after `stop`. Call with the lock; rethrows what a handler raised
// or the work threw.
template <class Work>
void with_signals(std::atomic<bool>& stop, const Work& work) {
  std::exception_ptr error;
  {
    const py::gil_scoped_release other_threads;
    std::future<void> done = std::async(std::launch::async, work);
    while (!stop && done.wait_for(SIGNALS_EVERY) != std::future_status::ready) {
      const py::gil_scoped_acquire interpreter;
      if (PyErr_CheckSignals() != 0) stop = true;
    }
    try {
      done.get();
    } catch (...) {
      error = std::current_exception();
    }
  }
  if (stop) throw py::error_already_set();
  if (error) std::rethrow_exception(error);
}

void check_vessel(const Scene& scene, std::size_t vessel) {
  if (vessel >= scene.vessels.size()) throw usage_error("the scene has no vessel of this number");
}

// Without the interpreter's lock.
void run_batch(Batch& batch, std::size_t vessel, const GripColumns& grips, const std::vector<Output>& outputs,
               const std::atomic<bool>& stop) {
  std::unique_lock lock(batch.in_use, std::defer_lock);
  while (!lock.try_lock_for(SIGNALS_EVERY))
    if (stop) return;
  RunRequest request;
  request.vessel = vessel;
  request.last = grips.count();
  request.grips = grips.source();
  request.stop = &stop;
  request.sink = [&](const PlaneChunk& chunk) {
    for (const Output& output : outputs) put(output, chunk, batch.backend->fields(), batch.backend->info().precision);
  };
  const RunResult result = batch.backend->run(request);
  if (result.done != grips.count() && !stop)
    throw failure_error(batch.backend->info().device + ": fewer grips came back than were asked for");
}

// Resolves "auto" for this many grips. A process forked from one with an open device gets the core.
std::string resolved_backend(const SceneHandle& handle, std::uint64_t grips,
                             const std::optional<std::vector<std::string>>& variables, const std::string& on,
                             const std::optional<std::string>& precision, int threads) {
  if (on != sweeps::ON_AUTO) {
    prepare_device(on);
    return on;
  }
  const Scene& scene = handle.described();
  sweeps::Workload work = sweeps::workload_of(
      scene, variables ? named_variables(scene, *variables, "variables") : sweeps::choose_variables(scene), grips);
  work.is_robust = false;  // there are no lists
  if (!sweeps::pays_for_device(work, threads) || is_forked_from_device()) return "core";
  prepare_vulkan_environment(on);
  std::string chosen;
  {
    const py::gil_scoped_release other_threads;
    chosen = sweeps::choose_backend(work, threads, precision_of(precision, "core")).on;
  }
  prepare_device(chosen);
  return chosen;
}

py::tuple evaluate(SceneHandle& handle, std::size_t vessel, const GripArrays& arrays,
                   const std::optional<std::vector<std::string>>& variables, const std::string& asked_on,
                   const std::optional<std::string>& precision, int threads) {
  const GripColumns grips(arrays);
  std::string on = resolved_backend(handle, grips.count(), variables, asked_on, precision, checked_threads(threads));
  BatchSpec spec{variables, on, precision_of(precision, on), checked_threads(threads)};
  check_vessel(handle.described(), vessel);
  std::shared_ptr<Batch> batch;
  const Scene* scene = nullptr;
  std::atomic<bool> stop{false};
  with_signals(stop, [&] {
    grips.check(stop);
    try {
      batch = handle.batch(spec);
    } catch (const Error&) {
      if (asked_on != sweeps::ON_AUTO || on == "core") throw;
      spec.on = on = "core";  // an error that is not the device's is rethrown
      batch = handle.batch(spec);
    }
    scene = &handle.whole(on);
  });
  const std::vector<Output> outputs = make_outputs(*batch, *scene, grips.count());
  if (grips.count() > 0 && !outputs.empty()) with_signals(stop, [&] { run_batch(*batch, vessel, grips, outputs, stop); });
  py::dict values;
  for (const Output& output : outputs) values[output.variable->name] = output.array;
  return py::make_tuple(values, on);
}

// In blocks on all threads; most lists are full after the first.
std::vector<Candidate> choose_different(const Evaluator& core, std::size_t vessel, const GripColumns& grips, std::size_t count,
                                        double apart, const std::atomic<bool>& stop) {
  constexpr std::size_t MOST_AT_ONCE = 4096;
  sweeps::DifferentGrips chosen(count, apart);
  std::size_t block = 64;
  for (std::size_t first = 0; first < grips.count() && !chosen.is_full() && !stop; first += block) {
    block = first == 0 ? block : std::min({2 * block, MOST_AT_ONCE, first});
    std::vector<std::optional<PosedHand>> hands(std::min(block, grips.count() - first));
    in_parallel(hands.size(), 0, [&](std::size_t i) { hands[i] = core.posed(vessel, grips.grip(first + i)); });
    for (std::size_t i = 0; i < hands.size(); ++i) chosen.offer({0, first + i}, hands[i]);
  }
  return chosen.chosen();
}

// The indices of the first `count` grips, in the given order, that differ from every earlier one (sweeps/lists/different_grips.h).
std::vector<std::size_t> different_grips(SceneHandle& handle, std::size_t vessel, const GripArrays& arrays, std::size_t count,
                                         double apart) {
  const GripColumns grips(arrays);
  check_vessel(handle.described(), vessel);
  std::vector<std::size_t> places;
  std::atomic<bool> stop{false};
  with_signals(stop, [&] {
    grips.check(stop);
    for (const Candidate& one : choose_different(*handle.core(), vessel, grips, count, apart, stop))
      places.push_back(static_cast<std::size_t>(one.index));
  });
  return places;
}

// The indices of the first `best` grips, ordered by robust scores, and these scores, chosen from the best candidates by score.
py::tuple rank_by_robust_scores(SceneHandle& handle, std::size_t vessel, const GripArrays& arrays, std::size_t best) {
  const GripColumns grips(arrays);
  check_vessel(handle.described(), vessel);
  std::vector<std::size_t> places;
  std::vector<double> lows, means, shares;
  std::atomic<bool> stop{false};
  with_signals(stop, [&] {
    grips.check(stop);
    const Scene& scene = handle.whole("core");
    const sweeps::Plan plan(scene, false);
    std::vector<std::vector<sweeps::BestGrip>> lists(scene.vessels.size() * plan.hand_scales());
    const std::size_t own = vessel * plan.hand_scales();
    for (std::size_t i = 0; i < grips.count(); ++i) {
      lists[own].emplace_back().candidate.index = i;
      lists[own].back().grip = grips.grip(i);
    }
    const sweeps::OpenBackend open = [](const Scene& other, const FieldSet& fields) {
      return open_backend(other, fields, "core", Precision::full, 0);
    };
    if (!sweeps::rank_robustly(open, scene, plan, best, &stop, lists)) return;
    for (const sweeps::BestGrip& grip : lists[own]) {
      places.push_back(static_cast<std::size_t>(grip.candidate.index));
      lows.push_back(grip.robust.low);
      means.push_back(grip.robust.mean);
      shares.push_back(grip.robust.share);
    }
  });
  return py::make_tuple(places, lows, means, shares);
}

}  // namespace

void bind_evaluate(py::module_& module) {
  module.def("evaluate", &evaluate, py::arg("scene"), py::arg("vessel"), py::arg("columns"), py::arg("variables"), py::arg("on"),
             py::arg("precision"), py::arg("threads"));
  module.def("rank_by_robust_scores", &rank_by_robust_scores, py::arg("scene"), py::arg("vessel"), py::arg("columns"),
             py::arg("best"));
  module.def("different_grips", &different_grips, py::arg("scene"), py::arg("vessel"), py::arg("columns"), py::arg("count"),
             py::arg("apart"));
  py::list names;
  for (const char* name : GRIP_COLUMN_NAMES) names.append(name);
  module.attr("GRIP_COLUMNS") = py::tuple(names);
}

}  // namespace wholehand
