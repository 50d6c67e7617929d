// SPDX-License-Identifier: MIT
// sanitizers: address
#include "host/stream.h"

#include <gtest/gtest.h>

#include "tests/support/vulkan_kernels.h"

namespace wholehand::host {
namespace {

// A stream of y = 2 x with x = item mod 1000, whose sink checks order and values as they come. Plane 0 is y, plane 1 the item's
// index.
class Doubling {
 public:
  explicit Doubling(const StreamOptions& options = {}, bool unified = true)
      : stream(
            [this, unified] {
              if (programs++ >= most_programs) {
                throw failure_error("no more devices");
              }
              DeviceOptions device;
              device.unified_memory = unified;
              return std::make_unique<ScaleProgram>(device);
            },
            options) {
    request.inputs = {{0, sizeof(float)}};
    request.outputs = {{.binding = 1, .bytes_per_item = 2 * sizeof(float), .kept_per_item = 2 * sizeof(float)}};
    request.fill = [](const Chunk& chunk, const ChunkInputs& inputs) {
      const auto values = elements<float>(inputs[0]);
      ASSERT_EQ(values.size(), chunk.stride);
      for (std::size_t i = 0; i < chunk.count; i++) {
        values[i] = input(chunk.first + i);
      }
    };
    request.record = [](Program& program, const Chunk& chunk, Commands& commands) {
      auto& scale = static_cast<ScaleProgram&>(program);
      commands.dispatch(scale.scale, groups_for(scale.on, scale.scale, chunk.count),
                        ScalePush{static_cast<std::uint32_t>(chunk.count), static_cast<std::uint32_t>(chunk.stride),
                                  static_cast<std::uint32_t>(chunk.first)});
    };
    request.sink = [this](const Chunk& chunk, const ChunkOutputs& outputs) {
      ASSERT_EQ(chunk.first, next);
      ASSERT_GT(chunk.count, 0u);
      ASSERT_GE(chunk.stride, chunk.count);
      const auto values = elements<const float>(outputs[0]);
      const std::size_t planes = values.size() / chunk.stride;
      for (std::size_t i = 0; i < chunk.count; i++) {
        ASSERT_EQ(values[i], 2 * input(chunk.first + i)) << chunk.first + i;
        if (planes > 1) {
          ASSERT_EQ(values[chunk.stride + i], static_cast<float>(chunk.first + i));
        }
      }
      next += chunk.count;
      chunks.push_back(chunk);
    };
    request.fallback = [this](const Chunk& chunk, std::span<const std::span<std::byte>> outputs) {
      const auto values = elements<float>(outputs[0]);
      for (std::size_t i = 0; i < chunk.count; i++) {
        values[i] = 2 * input(chunk.first + i);
        values[chunk.stride + i] = static_cast<float>(chunk.first + i);
      }
      fallbacks.push_back(chunk);
    };
  }

  static float input(std::uint64_t item) { return static_cast<float>(item % 1000); }

  StreamResult run(std::uint64_t last, std::uint64_t first = 0) {
    request.first = next = first;
    request.last = last;
    chunks.clear();
    fallbacks.clear();
    const StreamResult result = stream.run(request);
    EXPECT_EQ(result.items, next - first);
    EXPECT_EQ(result.chunks, chunks.size());
    return result;
  }

  int programs = 0, most_programs = 100;
  StreamRequest request;
  std::uint64_t next = 0;  // item that the sink expects
  std::vector<Chunk> chunks, fallbacks;
  Stream stream;
};

// Faults of the first submits, one letter each: '.' none, 'm' out of memory, 'l' device lost, 't' timeout.
StreamOptions with_faults(const std::string& faults) {
  StreamOptions options;
  options.inject = [faults](std::size_t submit) {
    const char letter = submit < faults.size() ? faults[submit] : '.';
    return letter == 'm'   ? SubmitFault::out_of_memory
           : letter == 'l' ? SubmitFault::device_lost
           : letter == 't' ? SubmitFault::timeout
                           : SubmitFault::none;
  };
  return options;
}

class HostStream : public testing::TestWithParam<bool> {};  // unified memory, or staged as for a discrete GPU

TEST_P(HostStream, EveryItemOnceInOrder) {
  Doubling doubling({}, GetParam());
  for (const std::uint64_t items : {0, 1, 63, 64, 65, 1023, 1024, 1025, 10007, 300001}) {
    const StreamResult result = doubling.run(items);
    EXPECT_EQ(result.items, items);
    EXPECT_EQ(result.items_by_fallback, 0u);
    EXPECT_TRUE(result.notes.empty());
    EXPECT_EQ(result.kernel_seconds > 0, items > 0);
    EXPECT_GE(result.bytes_in, items * 4);
    EXPECT_GE(result.bytes_out, items * 8);
    EXPECT_LE(result.bytes_in, (items + 64 * result.chunks) * 4);
  }
  EXPECT_EQ(doubling.programs, 1);
}

TEST_P(HostStream, RangeMayStartAnywhere) {
  Doubling doubling({}, GetParam());
  EXPECT_EQ(doubling.run(5005, 5001).items, 4u);
  EXPECT_EQ(doubling.run(77777, 333).items, 77777u - 333u);
  EXPECT_EQ(doubling.run(333, 333).items, 0u);
}

TEST_P(HostStream, OnlyKeptPlanesComeBack) {
  Doubling doubling({}, GetParam());
  doubling.request.outputs[0].kept_per_item = sizeof(float);
  const auto sink = doubling.request.sink;
  doubling.request.sink = [&](const Chunk& chunk, const ChunkOutputs& outputs) {
    EXPECT_EQ(outputs[0].size(), chunk.stride * sizeof(float));
    sink(chunk, outputs);
  };
  const StreamResult result = doubling.run(20000);
  EXPECT_LE(result.bytes_out, (20000 + 64 * result.chunks) * sizeof(float));
  doubling.request.outputs[0].kept_per_item = 0;  // all of it is scratch
  doubling.request.sink = nullptr;
  doubling.request.first = 0;
  EXPECT_EQ(doubling.stream.run(doubling.request).bytes_out, 0u);
}

TEST_P(HostStream, MemoryIsBoundedWhateverTheNumberOfItems) {
  StreamOptions options;
  options.slot_bytes = 1 << 18;
  options.slots = 3;
  Doubling doubling(options, GetParam());
  const StreamResult result = doubling.run(500'000);
  EXPECT_LE(result.slot_bytes, 3u << 18);
  EXPECT_LE(result.largest_chunk * 12, std::size_t(1) << 18);
  EXPECT_GT(result.chunks, 20u);
}

TEST_P(HostStream, ChunkStaysWithinTheDevicesBufferRange) {
  StreamOptions options;
  options.slot_bytes = std::size_t(1) << 40;
  options.first_items = 1 << 20;
  options.slots = 1;
  Doubling doubling(options, GetParam());
  const std::size_t range = doubling.stream.program().device().info().max_storage_range;
  doubling.request.outputs.push_back({.binding = 5, .bytes_per_item = range / 2000});  // scratch that no kernel touches
  EXPECT_LE(doubling.run(10'000).largest_chunk, 2000u);
}

TEST_P(HostStream, ItemThatDoesNotFitIsAnError) {
  StreamOptions options;
  options.slot_bytes = 100;  // under one group
  Doubling doubling(options, GetParam());
  EXPECT_THROW(doubling.run(1), Error);
}

TEST_P(HostStream, OutOfMemoryHalvesTheChunkAndSaysItOnce) {
  Doubling doubling(with_faults("mm..m"), GetParam());
  const StreamResult result = doubling.run(20'000);
  EXPECT_EQ(result.items, 20'000u);
  ASSERT_EQ(result.notes.size(), 1u);
  EXPECT_EQ(result.notes[0], "out of memory: chunks of 128 from here on");  // 1024 halved three times
  EXPECT_LE(doubling.chunks.back().count, 128u);
  EXPECT_EQ(result.items_by_fallback, 0u);
}

TEST_P(HostStream, SmallestChunkOutOfMemoryGoesToTheFallback) {
  Doubling doubling(with_faults("mmmmm"), GetParam());  // 1024, 512, 256, 128, 64
  const StreamResult result = doubling.run(10'000);
  EXPECT_EQ(result.items, 10'000u);
  EXPECT_EQ(result.items_by_fallback, 64u);
  EXPECT_EQ(result.notes, std::vector<std::string>{"out of memory for chunks of 64: evaluated on the core"});
}

TEST_P(HostStream, LostDeviceIsReplacedAndTheChunkDoneAgain) {
  for (const std::string faults : {"l", ".l", "..l", "...l", "t", ".t..."}) {
    Doubling doubling(with_faults(faults), GetParam());
    const StreamResult result = doubling.run(20'000);
    EXPECT_EQ(result.items, 20'000u);
    EXPECT_EQ(result.items_by_fallback, 0u);
    EXPECT_EQ(doubling.programs, 2);
    ASSERT_EQ(result.notes.size(), 1u) << faults;
    EXPECT_NE(result.notes[0].find("evaluated again on a fresh device"), std::string::npos);
    EXPECT_EQ(result.notes[0].starts_with("device timed out: items"), faults.find('t') != std::string::npos) << result.notes[0];
    EXPECT_TRUE(doubling.run(5000).notes.empty());  // and goes on
  }
}

TEST_P(HostStream, ChunkLostTwiceGoesToTheFallback) {
  StreamOptions options = with_faults("ll");
  options.slots = 1;
  Doubling doubling(options, GetParam());
  const StreamResult result = doubling.run(20'000);
  EXPECT_EQ(result.items, 20'000u);
  ASSERT_EQ(doubling.fallbacks.size(), 1u);
  EXPECT_EQ(doubling.fallbacks[0].first, 0u);
  EXPECT_EQ(result.items_by_fallback, doubling.fallbacks[0].count);
  EXPECT_EQ(result.notes, (std::vector<std::string>{"device lost: items 0 to 1023 evaluated again on a fresh device",
                                                    "device lost: items 0 to 1023 evaluated on the core"}));
}

TEST_P(HostStream, DeviceThatIsLostAgainAndAgainIsGivenUp) {
  Doubling doubling(with_faults("llllllllllllllllllll"), GetParam());
  StreamResult result = doubling.run(20'000);
  EXPECT_EQ(result.items, 20'000u);
  EXPECT_EQ(result.items_by_fallback, 20'000u);
  EXPECT_EQ(result.notes.back(), "device lost 4 times: the rest is evaluated on the core");
  result = doubling.run(3000);
  EXPECT_EQ(result.items_by_fallback, 3000u);
}

TEST_P(HostStream, NoFreshDeviceLeavesTheRestToTheFallback) {
  Doubling doubling(with_faults("...l"), GetParam());
  doubling.most_programs = 1;
  const StreamResult result = doubling.run(50'000);
  EXPECT_EQ(result.items, 50'000u);
  EXPECT_GT(result.items_by_fallback, 0u);
  EXPECT_LT(result.items_by_fallback, 50'000u);
  EXPECT_EQ(result.notes.back(), "no fresh device (no more devices): the rest is evaluated on the core");
}

TEST_P(HostStream, WithoutFallbackFailureIsAnError) {
  StreamOptions options = with_faults("ll");
  options.slots = 1;
  Doubling doubling(options, GetParam());
  doubling.request.fallback = nullptr;
  EXPECT_THROW(doubling.run(20'000), Error);
  EXPECT_EQ(doubling.run(20'000).items, 20'000u);  // later submits are well
}

TEST_P(HostStream, StopDeliversWhatIsInFlight) {
  Doubling doubling({}, GetParam());
  std::atomic<bool> stop = false;
  doubling.request.stop = &stop;
  const auto sink = doubling.request.sink;
  doubling.request.sink = [&](const Chunk& chunk, const ChunkOutputs& outputs) {
    sink(chunk, outputs);
    stop = true;
  };
  StreamResult result = doubling.run(1'000'000);
  EXPECT_GT(result.items, 0u);
  EXPECT_LE(result.chunks, 3u);
  result = doubling.run(1'000'000);  // stopped before it starts
  EXPECT_EQ(result.items, 0u);
}

TEST_P(HostStream, ErrorOfACallbackEndsTheRunAndNotTheStream) {
  Doubling doubling({}, GetParam());
  const auto sink = doubling.request.sink;
  doubling.request.sink = [&](const Chunk& chunk, const ChunkOutputs& outputs) {
    sink(chunk, outputs);
    if (chunk.first > 0) {
      throw usage_error("disk full");
    }
  };
  EXPECT_THROW(doubling.run(100'000), Error);
  doubling.request.sink = sink;
  EXPECT_EQ(doubling.run(10'000).items, 10'000u);
  const auto fill = doubling.request.fill;
  doubling.request.fill = [&](const Chunk& chunk, const ChunkInputs& inputs) {
    if (chunk.first > 5000) {
      throw usage_error("no such grip");
    }
    fill(chunk, inputs);
  };
  EXPECT_THROW(doubling.run(100'000), Error);
  doubling.request.fill = fill;
  EXPECT_EQ(doubling.run(10'000).items, 10'000u);
  EXPECT_EQ(doubling.programs, 1);
}

// Several kernels in sequence, scratch between them, a buffer that all chunks share, an output of fixed size.
TEST_P(HostStream, ChunkMayTakeSeveralKernels) {
  struct Chain : ScaleProgram {
    using ScaleProgram::ScaleProgram;
    Kernel neighbors{on, test_shader("host_neighbors"), {}, "host_neighbors"};
    Kernel counter{on, test_shader("host_count"), {}, "host_count"};
    Buffer weights = Buffer::of(on, std::vector<float>{0, 1, 0, 0});  // the next item's value
  };
  const DeviceOptions options{.unified_memory = GetParam()};
  Stream stream([&] { return std::make_unique<Chain>(options, 3.0f); });
  StreamRequest request;
  request.last = 12'345;
  request.inputs = {{.binding = 10, .bytes_per_item = sizeof(float)}};
  request.outputs = {{.binding = 11, .bytes_per_item = 2 * sizeof(float)},
                     {.binding = 12, .bytes_per_item = sizeof(float), .kept_per_item = sizeof(float)},
                     {.binding = 2, .fixed_bytes = 16, .kept_fixed_bytes = 4}};
  request.fill = [](const Chunk& chunk, const ChunkInputs& inputs) {
    for (std::size_t i = 0; i < chunk.count; i++) {
      elements<float>(inputs[0])[i] = static_cast<float>(chunk.first + i);
    }
  };
  request.record = [](Program& program, const Chunk& chunk, Commands& commands) {
    auto& chain = static_cast<Chain&>(program);
    const auto count = static_cast<std::uint32_t>(chunk.count), stride = static_cast<std::uint32_t>(chunk.stride);
    commands.clear(2);
    commands.dispatch(chain.counter, groups_for(chain.on, chain.counter, count));
    commands.bind(0, commands.bound(10));
    commands.bind(1, commands.bound(11));
    commands.dispatch(chain.scale, groups_for(chain.on, chain.scale, count), ScalePush{count, stride, 0});
    commands.bind(0, commands.bound(11));
    commands.bind(1, commands.bound(12));
    commands.bind(3, chain.weights);
    commands.dispatch(chain.neighbors, groups_for(chain.on, chain.neighbors, count), count);
  };
  std::uint64_t next = 0;
  request.sink = [&](const Chunk& chunk, const ChunkOutputs& outputs) {
    ASSERT_EQ(chunk.first, next);
    ASSERT_EQ(outputs.size(), 3u);
    ASSERT_TRUE(outputs[0].empty());
    for (std::size_t i = 0; i < chunk.count; i++) {
      ASSERT_EQ(elements<const float>(outputs[1])[i], 3 * static_cast<float>(chunk.first + (i + 1) % chunk.count));
    }
    ASSERT_EQ(elements<const std::uint32_t>(outputs[2]).size(), 1u);
    EXPECT_EQ(elements<const std::uint32_t>(outputs[2])[0], (chunk.count + 63) / 64 * 64);
    next += chunk.count;
  };
  EXPECT_EQ(stream.run(request).items, 12'345u);
}

TEST_P(HostStream, ChunksGrowAtMostFourfold) {
  Doubling doubling({}, GetParam());
  doubling.run(300'000);
  EXPECT_EQ(doubling.chunks[0].count, 1024u);
  for (std::size_t i = 1; i < doubling.chunks.size(); i++) {
    std::size_t largest = 0;  // of those delivered before it was planned, and those in flight then
    for (std::size_t j = 0; j < i; j++) {
      largest = std::max(largest, doubling.chunks[j].count);
    }
    EXPECT_LE(doubling.chunks[i].count, 4 * largest);
    EXPECT_TRUE(doubling.chunks[i].count % 64 == 0 || i + 1 == doubling.chunks.size());
  }
}

INSTANTIATE_TEST_SUITE_P(, HostStream, testing::Bool(), [](const auto& which) { return which.param ? "Unified" : "Staged"; });

}  // namespace
}  // namespace wholehand::host
