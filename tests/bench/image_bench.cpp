// SPDX-License-Identifier: MIT
// A lattice in a storage buffer beside the same samples in a 3-D image: which of the two the shaders should read. Each way of an
// image is measured in turns with the buffer, and held against the trilinear value in double precision.
#include <fmt/format.h>

#include <bit>
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

#include "base/numbers/half.h"
#include "core/evaluator.h"
#include "core/prepare.h"
#include "host/grip_backend.h"
#include "host/scene_arrays.h"
#include "host/vulkan.h"
#include "tests/bench/bench.h"
#include "tests/bench/shaders.h"
#include "tests/bench/shaders/lattice_read.h"
#include "tests/support/scenes.h"

namespace wholehand::bench {
namespace {

constexpr int HEIGHTS = 128, AZIMUTHS = 128, RAYS = HEIGHTS * AZIMUTHS;  // 2^20 points with RAY_STEPS a ray
constexpr int SAMPLES = 172;                // along the beaker's height: the 0.77 mm that the mesh reader chooses for it at 0.25 mm
constexpr int DISPATCHES = 4;               // a submit
constexpr double FROM = 0.060, TO = 0.040;  // m from the axis: from outside the lattice to the wall

// Planes of RAYS floats: starts, ways. Heights change fastest, as in a sweep.
std::vector<float> make_rays() {
  std::vector<float> rays(std::size_t{6} * RAYS);
  for (int a = 0; a < AZIMUTHS; ++a)
    for (int h = 0; h < HEIGHTS; ++h) {
      const double angle = 2 * std::numbers::pi * (a + 0.3) / AZIMUTHS, y = -0.005 + 0.12 * h / HEIGHTS;
      const std::size_t ray = static_cast<std::size_t>(a) * HEIGHTS + h;
      const double from[] = {FROM * std::cos(angle), y, FROM * std::sin(angle)};
      const double way[] = {(TO - FROM) * std::cos(angle), 0.01 * std::sin(3 * angle), (TO - FROM) * std::sin(angle)};
      for (int k = 0; k < 3; ++k) {
        rays[static_cast<std::size_t>(k) * RAYS + ray] = static_cast<float>(from[k]);
        rays[static_cast<std::size_t>(k + 3) * RAYS + ray] = static_cast<float>(way[k]);
      }
    }
  return rays;
}

// The samples as a 3-D image, which a sampler reads.
struct LatticeImage {
  vk::raii::DeviceMemory memory = nullptr;
  vk::raii::Image image = nullptr;
  vk::raii::ImageView view = nullptr;
  vk::raii::Sampler sampler = nullptr;
};

vk::Format format_of(int bits) { return bits == 16 ? vk::Format::eR16Sfloat : vk::Format::eR32Sfloat; }

// What a way lacks on the device; empty: nothing. Images of either format and 256 texels a side are on every device.
std::string lacks(const host::DeviceState& device, const PreparedLattice& lattice, int bits, int way) {
  const std::size_t largest = device.physical->getProperties().limits.maxTexelBufferElements;
  if (way == WAY_TEXELS && lattice.words->size() * (lattice.halves ? 2 : 1) > largest)
    return fmt::format("texel buffers end at {} texels", largest);
  const vk::FormatFeatureFlags has = device.physical->getFormatProperties(format_of(bits)).optimalTilingFeatures;
  if (way == WAY_FILTER && !(has & vk::FormatFeatureFlagBits::eSampledImageFilterLinear))
    return "images of this format are not filtered";
  return {};
}

class Commands {
 public:
  explicit Commands(host::DeviceState& device)
      : device_(device),
        pool_(*device.device, {{}, device.compute.family}),
        buffers_(*device.device, {*pool_, vk::CommandBufferLevel::ePrimary, 1}) {
    record().begin(vk::CommandBufferBeginInfo{});
  }
  const vk::raii::CommandBuffer& record() const { return buffers_[0]; }
  void wait_for_writes(vk::PipelineStageFlags stages) const {
    record().pipelineBarrier(
        stages, stages, {},
        vk::MemoryBarrier(vk::AccessFlagBits::eMemoryWrite, vk::AccessFlagBits::eMemoryRead | vk::AccessFlagBits::eMemoryWrite), {},
        {});
  }
  void end() const { record().end(); }
  // Seconds until it is done.
  double run() const {
    const vk::raii::Fence done(*device_.device, vk::FenceCreateInfo());
    const vk::CommandBuffer buffer = *buffers_[0];
    const auto start = std::chrono::steady_clock::now();
    device_.compute.queue.submit(vk::SubmitInfo({}, {}, buffer, {}), *done);
    if (device_.device->waitForFences(*done, true, 120'000'000'000) != vk::Result::eSuccess)
      throw failure_error("the Vulkan device did not finish within 120 s");
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

 private:
  host::DeviceState& device_;
  vk::raii::CommandPool pool_;
  vk::raii::CommandBuffers buffers_;
};

vk::raii::DeviceMemory memory_for(const host::DeviceState& device, const vk::MemoryRequirements& needs,
                                  vk::MemoryPropertyFlags kind) {
  for (std::uint32_t type = 0; type < device.memory.memoryTypeCount; ++type)
    if ((needs.memoryTypeBits >> type & 1) != 0 && (device.memory.memoryTypes[type].propertyFlags & kind) == kind)
      return {*device.device, {needs.size, type}};
  throw failure_error("the Vulkan device has no memory of the kind needed");
}

// The samples' words as a texel buffer.
struct TexelBuffer {
  vk::raii::DeviceMemory memory = nullptr;
  vk::raii::Buffer buffer = nullptr;
  vk::raii::BufferView view = nullptr;
};

TexelBuffer upload_texels(const host::Device& on, const PreparedLattice& lattice, int bits) {
  host::DeviceState& device = on.state();
  const std::size_t bytes = lattice.words->size() * sizeof(std::uint32_t);
  TexelBuffer made;
  made.buffer = vk::raii::Buffer(*device.device,
                                 {{}, bytes, vk::BufferUsageFlagBits::eUniformTexelBuffer | vk::BufferUsageFlagBits::eTransferDst});
  made.memory = memory_for(device, made.buffer.getMemoryRequirements(), vk::MemoryPropertyFlagBits::eDeviceLocal);
  made.buffer.bindMemory(*made.memory, 0);
  const std::size_t most = device.physical->getProperties().limits.maxTexelBufferElements * std::size_t(bits / 8);
  made.view = vk::raii::BufferView(*device.device, {{}, *made.buffer, format_of(bits), 0, std::min(bytes, most)});
  host::Buffer staging(on, bytes, host::Memory::upload);
  staging.write(*lattice.words);
  const Commands commands(device);
  commands.record().copyBuffer(*staging.state().buffer, *made.buffer, vk::BufferCopy(0, 0, bytes));
  commands.end();
  commands.run();
  return made;
}

LatticeImage upload_image(const host::Device& on, const PreparedLattice& lattice, int bits) {
  host::DeviceState& device = on.state();
  LatticeImage made;
  const vk::Extent3D size(lattice.nx, lattice.ny, lattice.nz);
  made.image =
      vk::raii::Image(*device.device, vk::ImageCreateInfo({}, vk::ImageType::e3D, format_of(bits), size, 1, 1,
                                                          vk::SampleCountFlagBits::e1, vk::ImageTiling::eOptimal,
                                                          vk::ImageUsageFlagBits::eSampled | vk::ImageUsageFlagBits::eTransferDst));
  made.memory = memory_for(device, made.image.getMemoryRequirements(), vk::MemoryPropertyFlagBits::eDeviceLocal);
  made.image.bindMemory(*made.memory, 0);
  const vk::ImageSubresourceRange all(vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1);
  made.view = vk::raii::ImageView(*device.device, {{}, *made.image, vk::ImageViewType::e3D, format_of(bits), {}, all});
  const vk::Filter filter = lacks(device, lattice, bits, WAY_FILTER).empty() ? vk::Filter::eLinear : vk::Filter::eNearest;
  made.sampler = vk::raii::Sampler(*device.device, {{},
                                                    filter,
                                                    filter,
                                                    vk::SamplerMipmapMode::eNearest,
                                                    vk::SamplerAddressMode::eClampToEdge,
                                                    vk::SamplerAddressMode::eClampToEdge,
                                                    vk::SamplerAddressMode::eClampToEdge});

  host::Buffer staging(on, lattice.words->size() * sizeof(std::uint32_t), host::Memory::upload);
  staging.write(*lattice.words);
  const Commands commands(device);
  const auto change = [&](vk::ImageLayout from, vk::ImageLayout to, vk::AccessFlags before, vk::AccessFlags after) {
    commands.record().pipelineBarrier(
        vk::PipelineStageFlagBits::eAllCommands, vk::PipelineStageFlagBits::eAllCommands, {}, {}, {},
        vk::ImageMemoryBarrier(before, after, from, to, VK_QUEUE_FAMILY_IGNORED, VK_QUEUE_FAMILY_IGNORED, *made.image, all));
  };
  change(vk::ImageLayout::eUndefined, vk::ImageLayout::eTransferDstOptimal, {}, vk::AccessFlagBits::eTransferWrite);
  commands.record().copyBufferToImage(*staging.state().buffer, *made.image, vk::ImageLayout::eTransferDstOptimal,
                                      vk::BufferImageCopy(0, 0, 0, {vk::ImageAspectFlagBits::eColor, 0, 0, 1}, {}, size));
  change(vk::ImageLayout::eTransferDstOptimal, vk::ImageLayout::eShaderReadOnlyOptimal, vk::AccessFlagBits::eTransferWrite,
         vk::AccessFlagBits::eShaderRead);
  commands.end();
  commands.run();
  return made;
}

// The beaker's lattice on a device, in a buffer and as an image, with the rays.
struct Lattice {
  Lattice(const Options& options, int bits) : on(options.device), bits(bits) {
    EvaluatorOptions evaluator;
    evaluator.lattice_samples = SAMPLES;
    evaluator.lattice_bits = bits;
    Scene scene = scene_of({beaker1()});
    core = make_core_evaluator(scene, evaluator);
    parameters = host::Buffer::of(
        on, std::vector{host::convert<float>(host::make_scene_arrays(scene, *core, evaluator).vessels[0].parameters)});
    words = host::Buffer::of(on, *core->lattice(0)->words);
    ray_values = make_rays();
    rays = host::Buffer::of(on, ray_values);
    distances = host::Buffer(on, sizeof(float) * RAYS * RAY_STEPS);
    image = upload_image(on, *core->lattice(0), bits);
    texels = upload_texels(on, *core->lattice(0), bits);
  }
  host::Device on;
  int bits;
  std::unique_ptr<Evaluator> core;
  std::vector<float> ray_values;
  host::Buffer parameters, words, rays, distances;
  LatticeImage image;
  TexelBuffer texels;
};

// One way of reading, compiled and recorded.
class Reader {
 public:
  Reader(const Lattice& lattice, int way) : lattice_(lattice) {
    host::DeviceState& device = lattice.on.state();
    using Type = vk::DescriptorType;
    std::vector<std::tuple<std::uint32_t, Type, const host::Buffer*>> buffers{
        {BINDING_PARAMETERS, Type::eUniformBuffer, &lattice.parameters},
        {BINDING_GRIPS, Type::eStorageBuffer, &lattice.rays},
        {BINDING_REAL_OUT, Type::eStorageBuffer, &lattice.distances},
        {BINDING_WORDS, Type::eStorageBuffer, &lattice.words}};
    std::vector<vk::DescriptorSetLayoutBinding> layout;
    for (const auto& [binding, type, buffer] : buffers) layout.emplace_back(binding, type, 1, vk::ShaderStageFlagBits::eCompute);
    layout.emplace_back(BINDING_IMAGE, Type::eCombinedImageSampler, 1, vk::ShaderStageFlagBits::eCompute);
    layout.emplace_back(BINDING_TEXELS, Type::eUniformTexelBuffer, 1, vk::ShaderStageFlagBits::eCompute);
    set_layout_ = vk::raii::DescriptorSetLayout(*device.device, vk::DescriptorSetLayoutCreateInfo({}, layout));
    const vk::PushConstantRange push(vk::ShaderStageFlagBits::eCompute, 0, sizeof(Push));
    layout_ = vk::raii::PipelineLayout(*device.device, vk::PipelineLayoutCreateInfo({}, *set_layout_, push));
    const std::array<vk::DescriptorPoolSize, 4> sizes{
        vk::DescriptorPoolSize{Type::eStorageBuffer, 3}, vk::DescriptorPoolSize{Type::eUniformBuffer, 1},
        vk::DescriptorPoolSize{Type::eCombinedImageSampler, 1}, vk::DescriptorPoolSize{Type::eUniformTexelBuffer, 1}};
    pool_ = vk::raii::DescriptorPool(*device.device,
                                     vk::DescriptorPoolCreateInfo(vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, 1, sizes));
    set_ = std::move(vk::raii::DescriptorSets(*device.device, {*pool_, *set_layout_})[0]);
    for (const auto& [binding, type, buffer] : buffers) {
      const vk::DescriptorBufferInfo whole(*buffer->state().buffer, 0, VK_WHOLE_SIZE);
      device.device->updateDescriptorSets(vk::WriteDescriptorSet(*set_, binding, 0, type, {}, whole), {});
    }
    const vk::BufferView texels = *lattice.texels.view;
    device.device->updateDescriptorSets(vk::WriteDescriptorSet(*set_, BINDING_TEXELS, 0, Type::eUniformTexelBuffer, {}, {}, texels),
                                        {});
    const vk::DescriptorImageInfo image(*lattice.image.sampler, *lattice.image.view, vk::ImageLayout::eShaderReadOnlyOptimal);
    device.device->updateDescriptorSets(vk::WriteDescriptorSet(*set_, BINDING_IMAGE, 0, Type::eCombinedImageSampler, image), {});

    std::span<const std::uint32_t> words;
    for (const EmbeddedShader& shader : bench_shaders())
      if (shader.name == "lattice_read" && shader.precision == 0) words = shader.words;
    const vk::raii::ShaderModule module(*device.device, {{}, words.size_bytes(), words.data()});
    const std::array<std::int32_t, 3> values{GROUP_SIZE, way, lattice.bits};
    const std::array<vk::SpecializationMapEntry, 3> entries{
        vk::SpecializationMapEntry{CONST_GROUP_SIZE, 0, 4}, {CONST_WAY, 4, 4}, {CONST_LATTICE_BITS, 8, 4}};
    const vk::SpecializationInfo special(3, entries.data(), sizeof values, values.data());
    const vk::PipelineShaderStageCreateInfo stage({}, vk::ShaderStageFlagBits::eCompute, *module, "main", &special);
    pipeline_ = vk::raii::Pipeline(*device.device, nullptr, vk::ComputePipelineCreateInfo({}, stage, *layout_));

    commands_.emplace(device);
    const vk::raii::CommandBuffer& out = commands_->record();
    out.bindPipeline(vk::PipelineBindPoint::eCompute, *pipeline_);
    out.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *layout_, 0, *set_, {});
    out.pushConstants<Push>(*layout_, vk::ShaderStageFlagBits::eCompute, 0, Push{RAYS, RAYS, 0, 0});
    for (int i = 0; i < DISPATCHES; ++i) {
      out.dispatch(RAYS / GROUP_SIZE, 1, 1);
      commands_->wait_for_writes(vk::PipelineStageFlagBits::eComputeShader);
    }
    commands_->wait_for_writes(vk::PipelineStageFlagBits::eAllCommands);
    commands_->end();
    run();  // compiles
  }

  // Seconds a point.
  double run() const { return commands_->run() / (double{DISPATCHES} * RAYS * RAY_STEPS); }

  // The largest difference from the core's trilinear value in double, m; of the last that ran.
  double error() const {
    const std::vector<float> found = lattice_.distances.read_as<float>(std::size_t{RAYS} * RAY_STEPS);
    double largest = 0;
    for (int ray = 0; ray < RAYS; ++ray) {
      float left = 1;
      for (int step = 0; step < RAY_STEPS; ++step) {
        Triple p{};
        for (int k = 0; k < 3; ++k)
          p[k] = lattice_.ray_values[static_cast<std::size_t>(k) * RAYS + ray] +
                 (1 - left) * lattice_.ray_values[static_cast<std::size_t>(k + 3) * RAYS + ray];
        const double difference =
            std::abs(static_cast<double>(found[static_cast<std::size_t>(step) * RAYS + ray]) - lattice_.core->distance(0, p));
        largest = std::max(largest, difference);
        left *= static_cast<float>(STEP_SHARE);
      }
    }
    return largest;
  }

 private:
  const Lattice& lattice_;
  vk::raii::DescriptorSetLayout set_layout_ = nullptr;
  vk::raii::PipelineLayout layout_ = nullptr;
  vk::raii::DescriptorPool pool_ = nullptr;
  vk::raii::DescriptorSet set_ = nullptr;
  vk::raii::Pipeline pipeline_ = nullptr;
  std::optional<Commands> commands_;
};

void read_lattice(benchmark::State& state, const Options& options, int bits, int way) {
  const Lattice lattice(options, bits);
  if (const std::string missing = lacks(lattice.on.state(), *lattice.core->lattice(0), bits, way); !missing.empty()) {
    state.SkipWithError(missing.c_str());
    return;
  }
  const Reader nothing(lattice, WAY_NOTHING), buffer(lattice, WAY_BUFFER), reader(lattice, way);
  const double error = reader.error();
  double nothing_seconds = 0, buffer_seconds = 0, reader_seconds = 0;
  for (auto _ : state) {
    nothing_seconds += nothing.run();
    buffer_seconds += buffer.run();
    const double seconds = reader.run();
    reader_seconds += seconds;
    state.SetIterationTime(seconds * RAYS * RAY_STEPS);
  }
  const auto runs = static_cast<double>(state.iterations());
  state.SetItemsProcessed(state.iterations() * RAYS * RAY_STEPS);
  state.counters["ns"] = 1e9 * (reader_seconds - nothing_seconds) / runs;
  state.counters["buffer_ns"] = 1e9 * (buffer_seconds - nothing_seconds) / runs;
  const auto bits_of_fraction = static_cast<int>(lattice.on.state().physical->getProperties().limits.subTexelPrecisionBits);
  const double promised = 1e9 * std::ldexp(lattice.core->lattice(0)->spacing, -1 - bits_of_fraction);
  state.SetLabel("over the storage buffer" + (way == WAY_FILTER ? fmt::format("; promised are {:.0f} nm", promised) : ""));
  state.counters["ratio"] = (buffer_seconds - nothing_seconds) / (reader_seconds - nothing_seconds);
  state.counters["error_nm"] = 1e9 * error;
}

}  // namespace

void add_image_benchmarks(const Options& options) {
  for (const int bits : {32, 16})
    for (const auto& [name, way] :
         {std::pair{"buffer", WAY_BUFFER}, {"fetch", WAY_FETCH}, {"filter", WAY_FILTER}, {"texels", WAY_TEXELS}})
      benchmark::RegisterBenchmark(
          fmt::format("read_{}_{}bit", name, bits).c_str(),
          [&options, bits, way = way](benchmark::State& state) { read_lattice(state, options, bits, way); })
          ->UseManualTime()
          ->Unit(benchmark::kMillisecond);
}

}  // namespace wholehand::bench
