// SPDX-License-Identifier: MIT
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "app/c/scene.h"
#include "app/c/status.h"
#include "core/backend.h"
#include "core/reader/ranges.h"
#include "host/open_backend.h"
#include "shaders/status.h"
#include "sweeps/plan/variables.h"

using namespace wholehand;

struct wh_batch {
  std::shared_ptr<const ReadyScene> ready;
  std::vector<const sweeps::Variable*> variables;  // in the caller's order
  FieldSet fields;
  std::unique_ptr<Backend> backend;
  std::string notes;  // of the last run, a line each
  std::atomic_flag is_in_use = ATOMIC_FLAG_INIT;
};

namespace {

// The caller's rows, at any address: numbers need not be aligned.
struct Rows {
  const double* grips;
  ptrdiff_t stride;  // bytes
  GripInput operator[](std::size_t i) const noexcept {
    double row[WH_GRIP_COLUMNS];
    std::memcpy(row, reinterpret_cast<const char*>(grips) + static_cast<ptrdiff_t>(i) * stride, sizeof row);
    return {row[0], row[1], row[2], row[3], row[4], row[5] == 0 ? 1 : row[5]};
  }
};

// Whether `count` elements at this distance stay within a pointer's range.
bool can_reach(std::size_t count, ptrdiff_t stride) noexcept {
  ptrdiff_t last = 0;
  return count == 0 || (count - 1 <= static_cast<std::size_t>(PTRDIFF_MAX) &&
                        !__builtin_mul_overflow(static_cast<ptrdiff_t>(count - 1), stride, &last) && last >= -PTRDIFF_MAX / 4 &&
                        last <= PTRDIFF_MAX / 4);
}

// Strides in bytes, with the caller's omissions filled in.
struct Place {
  char* data;
  int type;
  ptrdiff_t grip, value;
};

std::size_t size_of(int type) { return type == WH_DOUBLE ? sizeof(double) : 4; }

void put(const Place& place, std::size_t grip, std::size_t value, double number) {
  char* at = place.data + static_cast<ptrdiff_t>(grip) * place.grip + static_cast<ptrdiff_t>(value) * place.value;
  if (place.type == WH_DOUBLE) {
    std::memcpy(at, &number, sizeof number);
  } else if (place.type == WH_FLOAT) {
    const auto single = static_cast<float>(number);
    std::memcpy(at, &single, sizeof single);
  } else {
    const auto whole = static_cast<std::int32_t>(number);
    std::memcpy(at, &whole, sizeof whole);
  }
}

// One variable of the grips of a chunk.
void write_values(const wh_batch& batch, const sweeps::Variable& variable, const PlaneChunk& chunk, const Place& place) {
  const std::size_t values = sweeps::variable_planes(variable, batch.ready->scene);
  const int first = batch.fields.plane[static_cast<std::size_t>(variable.field)] + variable.plane;
  const int status = batch.fields.plane[FIELD_STATUS];
  for (std::size_t v = 0; v < values; ++v)
    for (std::size_t i = 0; i < chunk.count; ++i) {
      const int plane = first + static_cast<int>(v);
      if (variable.type == sweeps::NumberType::real) {
        put(place, chunk.first + i, v, chunk.real(plane, i));
        continue;
      }
      const bool exists = variable.always || is_feasible(chunk.uint(status, i));
      put(place, chunk.first + i, v, exists ? variable.value(chunk.uint(plane, i)) : variable.missing);
    }
}

// One output of a request, checked: where variable `variable` goes.
wh_status check_output(const wh_batch& batch, const sweeps::Variable& variable, const wh_output& own, size_t count,
                       Place& place) noexcept {
  const char* name = variable.name;
  if (!own.data && count > 0) return fail(WH_ARGUMENT, "wh_batch_run: the data of %s are null", name);
  if (own.type != WH_DOUBLE && own.type != WH_FLOAT && own.type != WH_INT32)
    return fail(WH_ARGUMENT, "wh_batch_run: %s has the type %d; 0 is double, 1 is float, 2 is int32", name,
                static_cast<int>(own.type));
  if (own.reserved != 0) return fail(WH_ARGUMENT, "wh_batch_run: a reserved member of the output of %s is not 0", name);
  if (own.type == WH_INT32 && variable.type == sweeps::NumberType::real)
    return fail(WH_ARGUMENT, "wh_batch_run: %s is real and does not go into whole numbers", name);
  const auto size = static_cast<ptrdiff_t>(size_of(own.type));
  const std::size_t values = sweeps::variable_planes(variable, batch.ready->scene);
  const bool is_packed = own.grip_stride == 0 && own.value_stride == 0;
  place = {static_cast<char*>(own.data), own.type, is_packed ? size * static_cast<ptrdiff_t>(values) : own.grip_stride,
           is_packed ? size : own.value_stride};
  if ((count > 1 && place.grip == 0) || (values > 1 && place.value == 0))
    return fail(WH_ARGUMENT, "wh_batch_run: a stride of %s is 0, so that its values share a place; both 0: without gaps", name);
  if (!can_reach(count, place.grip) || !can_reach(values, place.value))
    return fail(WH_ARGUMENT, "wh_batch_run: the strides of %s reach further than memory", name);
  return WH_OK;
}

wh_status check_outputs(const wh_batch& batch, const wh_output* outputs, size_t outputs_count, size_t count,
                        std::vector<Place>& places) {
  if (outputs_count != batch.variables.size() || (outputs_count > 0 && !outputs))
    return fail(WH_ARGUMENT, "wh_batch_run: the batch has %zu variables, and there are %zu outputs", batch.variables.size(),
                outputs ? outputs_count : 0);
  for (size_t k = 0; k < outputs_count; ++k) {
    // the elements are as far apart as the caller's header has them
    wh_output own;
    const auto* at = reinterpret_cast<const wh_output*>(reinterpret_cast<const char*>(outputs) + k * outputs->size);
    if (const wh_status status = take_over(at, own, "wh_batch_run: an output"); status != WH_OK) return status;
    if (at->size != outputs->size) return fail(WH_ARGUMENT, "wh_batch_run: the outputs say that they have different sizes");
    Place place;
    if (const wh_status status = check_output(batch, *batch.variables[k], own, count, place); status != WH_OK) return status;
    places.push_back(place);
  }
  return WH_OK;
}

wh_status check_grips(const wh_batch& batch, size_t vessel, const Rows& rows, size_t count) noexcept {
  const Scene& scene = batch.ready->scene;
  if (vessel >= scene.vessels.size())
    return fail(WH_ARGUMENT, "wh_batch_run: the scene has %zu vessels, and none of number %zu", scene.vessels.size(), vessel);
  if (count > 0 && !rows.grips) return fail(WH_ARGUMENT, "wh_batch_run: the grips are null");
  if (!can_reach(count, rows.stride)) return fail(WH_ARGUMENT, "wh_batch_run: the stride of the grips reaches further than memory");
  for (size_t i = 0; i < count; ++i) {
    const GripInput grip = rows[i];
    if (!grip_fault(batch.ready->allowed, grip)) continue;
    char place[64];
    std::snprintf(place, sizeof place, "wh_batch_run: grip %zu", i);
    return check_grip(batch.ready->allowed, grip, place);
  }
  return WH_OK;
}

}  // namespace

wh_status wh_batch_open(const wh_scene* scene, const char* const* variables, size_t count, const char* on, int is_double,
                        int threads, wh_batch** batch) {
  if (!scene || !batch || (count > 0 && !variables)) return fail(WH_ARGUMENT, "wh_batch_open: a pointer is null");
  *batch = nullptr;
  for (size_t k = 0; k < count; ++k)
    if (!variables[k]) return fail(WH_ARGUMENT, "wh_batch_open: the name of a variable is null");
  if (threads < 0 || threads > ranges::THREADS.high)
    return fail(WH_INPUT, "wh_batch_open: %d threads; allowed: 0 (all) to %d", threads, static_cast<int>(ranges::THREADS.high));
  return guarded([&] {
    auto made = std::make_unique<wh_batch>();
    made->ready = scene->ready;
    const Scene& own = made->ready->scene;
    made->variables = sweeps::named_variables(own, std::vector<std::string>(variables, variables + count), "wh_batch_open");
    made->fields = make_field_set(sweeps::variable_fields(made->variables), own);
    made->backend = open_backend(own, made->fields, on ? on : "core", is_double ? Precision::full : Precision::single, threads);
    *batch = made.release();
    return WH_OK;
  });
}

void wh_batch_free(wh_batch** batch) {
  if (!batch) return;
  delete *batch;
  *batch = nullptr;
}

wh_status wh_batch_device(const wh_batch* batch, const char** name) {
  if (!batch || !name) return fail(WH_ARGUMENT, "wh_batch_device: a pointer is null");
  *name = batch->backend->info().device.c_str();
  return WH_OK;
}

wh_status wh_batch_notes(const wh_batch* batch, const char** notes) {
  if (!batch || !notes) return fail(WH_ARGUMENT, "wh_batch_notes: a pointer is null");
  *notes = batch->notes.c_str();
  return WH_OK;
}

wh_status wh_batch_run(wh_batch* batch, size_t vessel, const double* grips, size_t count, ptrdiff_t grips_stride,
                       const wh_output* outputs, size_t outputs_count) {
  if (!batch) return fail(WH_ARGUMENT, "wh_batch_run: the batch is null");
  const Entered entered(batch->is_in_use);
  if (!entered) return fail(WH_BUSY, "wh_batch_run: another thread is in this batch");
  return guarded([&] {
    const Rows rows{grips, grips_stride == 0 ? static_cast<ptrdiff_t>(WH_GRIP_COLUMNS * sizeof(double)) : grips_stride};
    std::vector<Place> places;
    if (const wh_status status = check_outputs(*batch, outputs, outputs_count, count, places); status != WH_OK) return status;
    if (const wh_status status = check_grips(*batch, vessel, rows, count); status != WH_OK) return status;
    batch->notes.clear();
    if (count == 0) return WH_OK;
    RunRequest request;
    request.vessel = vessel;
    request.last = count;
    request.grips = [&](std::size_t, std::uint64_t first, std::size_t size, GripInput* out) {
      for (std::size_t i = 0; i < size; ++i) out[i] = rows[first + i];
    };
    request.sink = [&](const PlaneChunk& chunk) {
      for (size_t k = 0; k < places.size(); ++k) write_values(*batch, *batch->variables[k], chunk, places[k]);
    };
    for (const std::string& note : batch->backend->run(request).notes) batch->notes += (batch->notes.empty() ? "" : "\n") + note;
    return WH_OK;
  });
}
