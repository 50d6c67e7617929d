// SPDX-License-Identifier: MIT
#include "host/slot.h"

#include <algorithm>
#include <limits>

#include "base/system/clock.h"

namespace wholehand::host {
namespace {

std::size_t kept_bytes(const StreamOutput& output, std::size_t stride) {
  return output.kept_per_item * stride + output.kept_fixed_bytes;
}

}  // namespace

std::pair<std::size_t, std::size_t> Slot::bytes(const DeviceState& device, const StreamRequest& request) {
  const bool staged = !device.info.unified_memory;
  std::size_t per_item = 0, fixed = 0;
  for (const StreamInput& input : request.inputs) {
    per_item += input.bytes_per_item * (staged ? 2 : 1);
  }
  for (const StreamOutput& output : request.outputs) {
    per_item += output.bytes_per_item + (staged ? output.kept_per_item : 0);
    fixed += output.fixed_bytes + (staged ? output.kept_fixed_bytes : 0);
  }
  return {per_item, fixed};
}

std::size_t Slot::largest_capacity(const DeviceInfo& device, const StreamRequest& request) {
  const std::uint64_t limit = std::min(device.max_storage_range, device.max_allocation);
  std::uint64_t items = std::numeric_limits<std::size_t>::max();
  const auto restrict = [&](std::size_t per_item, std::size_t fixed) {
    if (fixed > limit) {
      items = 0;
    } else if (per_item > 0) {
      items = std::min<std::uint64_t>(items, (limit - fixed) / per_item);
    }
  };
  for (const StreamInput& input : request.inputs) {
    restrict(input.bytes_per_item, 0);
  }
  for (const StreamOutput& output : request.outputs) {
    restrict(output.bytes_per_item, output.fixed_bytes);
  }
  return items;
}

Slot::Slot(DeviceState& device, const StreamRequest& request, std::size_t capacity)
    : device_(device),
      compute_(device, device.compute.family),
      uploaded_(*device.device, vk::SemaphoreCreateInfo()),
      computed_(*device.device, vk::SemaphoreCreateInfo()),
      done_(*device.device, vk::FenceCreateInfo()) {
  bool uploads = false, downloads = false;
  for (const StreamInput& input : request.inputs) {
    Pair& pair = inputs_.emplace_back();
    pair.on_device = Buffer(device, input.bytes_per_item * capacity, Memory::device);
    if (pair.on_device.mapped().empty()) {
      pair.on_host = Buffer(device, input.bytes_per_item * capacity, Memory::upload);
      uploads = true;
    }
  }
  for (const StreamOutput& output : request.outputs) {
    Pair& pair = outputs_.emplace_back();
    pair.on_device = Buffer(device, output.bytes_per_item * capacity + output.fixed_bytes, Memory::device);
    if (const std::size_t kept = kept_bytes(output, capacity); kept > 0 && !pair.on_device.reads_fast()) {
      pair.on_host = Buffer(device, kept, Memory::readback);
      downloads = true;
    }
  }
  if (uploads) {
    upload_.emplace(device, device.upload.family);
  }
  if (downloads) {
    download_.emplace(device, device.download.family);
  }
}

Slot::~Slot() { leave_behind(device_, uploaded_, computed_, done_); }

void Slot::submit(const Chunk& next, const StreamRequest& request, Program& program) {
  chunk = next;
  const Commands commands = fill_and_record(request, program);
  device_.device->resetFences(*done_);
  compute_.begin();
  compute_.steps(commands);
  compute_.end();
  if (upload_) {
    submit_upload();
  }
  if (download_) {
    record_download();
  }
  submit_compute();
  submitted = monotonic_now();
}

Commands Slot::fill_and_record(const StreamRequest& request, Program& program) {
  std::vector<std::span<std::byte>> spans;
  Commands commands;
  bytes_in = bytes_out = 0;
  for (std::size_t i = 0; i < inputs_.size(); i++) {
    Pair& pair = inputs_[i];
    pair.bytes = request.inputs[i].bytes_per_item * chunk.stride;
    bytes_in += pair.bytes;
    spans.push_back((pair.on_host.size() > 0 ? pair.on_host : pair.on_device).mapped().first(pair.bytes));
    commands.bind(request.inputs[i].binding, pair.on_device);
  }
  for (std::size_t i = 0; i < outputs_.size(); i++) {
    outputs_[i].bytes = kept_bytes(request.outputs[i], chunk.stride);
    bytes_out += outputs_[i].bytes;
    commands.bind(request.outputs[i].binding, outputs_[i].on_device);
  }
  if (request.fill) {
    request.fill(chunk, spans);
  }
  request.record(program, chunk, commands);
  return commands;
}

void Slot::submit_upload() {
  upload_->begin();
  for (const Pair& pair : inputs_) {
    upload_->copy(pair.on_host.state(), pair.on_device.state(), pair.bytes);
  }
  upload_->end();
  upload_->submit(device_.upload.queue, {}, *uploaded_, {});
}

void Slot::record_download() {
  download_->begin();
  for (const Pair& pair : outputs_) {
    if (pair.on_host.size() > 0) {
      download_->copy(pair.on_device.state(), pair.on_host.state(), pair.bytes);
    }
  }
  download_->end();
}

// The kernels, after what is uploaded and before what is downloaded.
void Slot::submit_compute() {
  compute_.submit(device_.compute.queue, upload_ ? *uploaded_ : vk::Semaphore(), download_ ? *computed_ : vk::Semaphore(),
                  download_ ? vk::Fence() : *done_);
  if (download_) {
    download_->submit(device_.download.queue, *computed_, {}, *done_);
  }
}

bool Slot::wait(double seconds) { return wait_for(device_, *done_, seconds); }

double Slot::seconds() const { return compute_.seconds(); }

void Slot::deliver(const StreamRequest& request) const {
  std::vector<std::span<const std::byte>> spans;
  for (const Pair& pair : outputs_) {
    const Buffer& source = pair.on_host.size() > 0 ? pair.on_host : pair.on_device;
    spans.push_back(pair.bytes > 0 ? source.mapped().first(pair.bytes) : std::span<std::byte>());
  }
  if (request.sink) {
    request.sink(chunk, spans);
  }
}

}  // namespace wholehand::host
