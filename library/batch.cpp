// SPDX-License-Identifier: MIT
#include <atomic>
#include <cstdio>
#include <cstring>
#include <vector>

#include "core/backend.h"
#include "host/open_backend.h"
#include "library/scene.h"
#include "library/status.h"
#include "sweeps/variables.h"

using namespace wholehand;

struct wh_batch {
  std::shared_ptr<const ReadyScene> ready;
  std::vector<const Variable*> variables;  // in the caller's order
  FieldSet fields;
  std::unique_ptr<Backend> backend;
  std::atomic_flag is_in_use = ATOMIC_FLAG_INIT;
};

namespace {

GripInput grip_of(const double* row) noexcept { return {row[0], row[1], row[2], row[3], row[4], row[5] == 0 ? 1 : row[5]}; }

std::vector<const Variable*> named_variables(const Scene& scene, const char* const* names, size_t count) {
  Scene asked = scene;  // for its messages: what the scene lacks, and what is known
  asked.output.keep = std::vector<std::string>(names, names + count);
  asked.output.keep_place = "variables";
  choose_variables(asked);
  std::vector<const Variable*> variables;
  for (size_t k = 0; k < count; ++k)
    for (const Variable& variable : variable_catalogue())
      if (std::strcmp(variable.name, names[k]) == 0) variables.push_back(&variable);
  return variables;
}

// Strides in bytes, those that the caller left out filled in.
struct Place {
  char* data;
  wh_type type;
  ptrdiff_t grip, value;
};

std::size_t size_of(wh_type type) { return type == WH_DOUBLE ? sizeof(double) : 4; }

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
void write_values(const wh_batch& batch, const Variable& variable, const PlaneChunk& chunk, const Place& place) {
  const std::size_t values = variable_planes(variable, batch.ready->scene);
  const int first = batch.fields.plane[static_cast<std::size_t>(variable.field)] + variable.plane;
  const int status = batch.fields.plane[FIELD_STATUS];
  for (std::size_t v = 0; v < values; ++v)
    for (std::size_t i = 0; i < chunk.count; ++i) {
      const int plane = first + static_cast<int>(v);
      if (variable.type == NumberType::real) {
        put(place, chunk.first + i, v, chunk.real(plane, i));
        continue;
      }
      const bool exists = variable.always || (chunk.uint(status, i) & STATUS_REASON_MASK) == REASON_NONE;
      put(place, chunk.first + i, v, exists ? variable.value(chunk.uint(plane, i)) : variable.missing);
    }
}

wh_status check_request(const wh_batch& batch, size_t vessel, const double* grips, size_t count, size_t stride,
                        const wh_output* outputs, size_t outputs_count, std::vector<Place>& places) {
  const Scene& scene = batch.ready->scene;
  if (vessel >= scene.vessels.size())
    return fail(WH_ARGUMENT, "wh_batch_run: the scene has %zu vessels, and none of number %zu", scene.vessels.size(), vessel);
  if (count > 0 && !grips) return fail(WH_ARGUMENT, "wh_batch_run: the grips are null");
  if (stride < WH_GRIP_COLUMNS) return fail(WH_ARGUMENT, "wh_batch_run: a row of grips has 6 numbers; its stride is smaller");
  if (outputs_count != batch.variables.size() || (outputs_count > 0 && !outputs))
    return fail(WH_ARGUMENT, "wh_batch_run: the batch has %zu variables, and there are %zu outputs", batch.variables.size(),
                outputs ? outputs_count : 0);
  for (size_t k = 0; k < outputs_count; ++k) {
    wh_output own;
    const char* name = batch.variables[k]->name;
    if (const wh_status status = take_over(&outputs[k], own, "wh_batch_run: an output"); status != WH_OK) return status;
    if (!own.data && count > 0) return fail(WH_ARGUMENT, "wh_batch_run: the data of %s are null", name);
    if (own.type != WH_DOUBLE && own.type != WH_FLOAT && own.type != WH_INT32)
      return fail(WH_ARGUMENT, "wh_batch_run: %s has the type %d; 0 is double, 1 is float, 2 is int32", name,
                  static_cast<int>(own.type));
    if (own.type == WH_INT32 && batch.variables[k]->type == NumberType::real)
      return fail(WH_ARGUMENT, "wh_batch_run: %s is real and does not go into whole numbers", name);
    const auto size = static_cast<ptrdiff_t>(size_of(own.type));
    const auto values = static_cast<ptrdiff_t>(variable_planes(*batch.variables[k], batch.ready->scene));
    const bool is_packed = own.grip_stride == 0 && own.value_stride == 0;
    places.push_back(
        {static_cast<char*>(own.data), own.type, is_packed ? size * values : own.grip_stride, is_packed ? size : own.value_stride});
  }
  for (size_t i = 0; i < count; ++i) {
    const GripInput grip = grip_of(grips + i * stride);
    if (grip_fault(batch.ready->allowed, grip)) {
      char place[64];
      std::snprintf(place, sizeof place, "wh_batch_run: grip %zu", i);
      return check_grip(batch.ready->allowed, grip, place);
    }
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
  if (threads < 0) return fail(WH_ARGUMENT, "wh_batch_open: %d threads; allowed: a number from 0 (all) on", threads);
  return guarded([&] {
    auto made = std::make_unique<wh_batch>();
    made->ready = scene->ready;
    const Scene& own = made->ready->scene;
    made->variables = named_variables(own, variables, count);
    made->fields = make_field_set(variable_fields(made->variables), own);
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

wh_status wh_batch_run(wh_batch* batch, size_t vessel, const double* grips, size_t count, size_t row_stride,
                       const wh_output* outputs, size_t outputs_count) {
  if (!batch) return fail(WH_ARGUMENT, "wh_batch_run: the batch is null");
  const Entered entered(batch->is_in_use);
  if (!entered) return fail(WH_BUSY, "wh_batch_run: another thread is in this batch");
  return guarded([&] {
    const size_t stride = row_stride == 0 ? std::size_t{WH_GRIP_COLUMNS} : row_stride;
    std::vector<Place> places;
    const wh_status checked = check_request(*batch, vessel, grips, count, stride, outputs, outputs_count, places);
    if (checked != WH_OK || count == 0) return checked;
    RunRequest request;
    request.vessel = vessel;
    request.last = count;
    request.grips = [&](std::size_t, std::uint64_t first, std::size_t size, GripInput* out) {
      for (std::size_t i = 0; i < size; ++i) {
        out[i] = grip_of(grips + (first + i) * stride);
      }
    };
    request.sink = [&](const PlaneChunk& chunk) {
      for (size_t k = 0; k < places.size(); ++k) write_values(*batch, *batch->variables[k], chunk, places[k]);
    };
    batch->backend->run(request);
    return WH_OK;
  });
}
