// SPDX-License-Identifier: MIT
// What the kernels cost on a Vulkan device: the dispatches of a chunk as the program records them, run and timed one by one. Their useful lanes
// come from the same kernels compiled to count them, in runs that are not timed.
#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/evaluator.h"
#include "core/mirror.h"
#include "host/grip_program.h"
#include "host/run_once.h"
#include "tests/bench/roofline.h"
#include "tests/bench/shaders.h"

namespace wholehand::bench {
namespace {

constexpr int LEAST_ROUNDS = 4;           // of a vessel,
constexpr double LEAST_SECONDS = 0.2;     // and as many more as this takes
constexpr std::size_t GPU_REPEATS = 120;  // of the sample: a GPU wants many grips at once to be busy

// As often as a buffer of the device has room for.
std::size_t repeats(const host::DeviceInfo& device, std::size_t bytes_per_grip) {
  if (device.kind == host::DeviceKind::cpu) return 1;
  return std::clamp<std::size_t>(device.max_storage_range / (bytes_per_grip * SAMPLE), 1, GPU_REPEATS);
}

// A workload on a device, with a chunk of the sample of a vessel at a time.
class DeviceRun {
 public:
  DeviceRun(const Options& options, const Workload& workload, Precision precision, bool counting)
      : workload_(workload), real_(real_bytes(precision)) {
    on_device_.precision = precision;
    if (counting) on_device_.shaders = lane_shaders();
    const auto core = make_core_evaluator(workload.scene);
    const host::SceneArrays arrays = host::make_scene_arrays(workload.scene, *core, {});
    program_ = std::make_unique<host::GripProgram>(workload.scene, arrays, workload.fields, options.device, on_device_);
    const auto reals = static_cast<std::size_t>(program_->real_planes);
    chunk_.count = chunk_.stride = SAMPLE * repeats(program_->on.info(), reals * real_);
    grips_ = host::Buffer(program_->on, GRIP_AXES * chunk_.stride * real_);
    reals_ = host::Buffer(program_->on, reals * chunk_.stride * real_);
    uints_ = host::Buffer(program_->on, program_->fields.uint_planes * chunk_.stride * sizeof(std::uint32_t));
    lanes_ = host::Buffer(program_->on, 2 * sizeof(std::uint32_t));
  }

  std::size_t grips() const { return chunk_.count * workload_.scene.vessels.size(); }

  // Best costs of each kernel over all vessels, by its name.
  std::map<std::string, Cost> costs() {
    std::map<std::string, Cost> sums;
    for (std::size_t v = 0; v < workload_.scene.vessels.size(); ++v) {
      const host::Commands commands = commands_of(v);
      host::run_once(program_->on, commands);  // with the driver's compilation
      std::vector<Cost> best(commands.steps().size());
      double spent = 0;
      for (int round = 0; round < LEAST_ROUNDS || spent < LEAST_SECONDS; ++round)
        for (std::size_t step = 0; step < best.size(); ++step) {
          Cost cost;
          cost.processor = cost_of([&] { cost.wall = host::run_once(program_->on, commands.only(step)); }).processor;
          spent += cost.wall;
          best[step] = round == 0 ? cost : least_of(best[step], cost);
        }
      for (std::size_t step = 0; step < best.size(); ++step) {
        Cost& sum = sums[commands.steps()[step].kernel->name()];
        sum.wall += best[step].wall;
        sum.processor += best[step].processor;
      }
    }
    return sums;
  }

  // Lanes of each kernel, from a run that counts them.
  std::map<std::string, Lanes> lanes() {
    std::map<std::string, Lanes> sums;
    for (std::size_t v = 0; v < workload_.scene.vessels.size(); ++v) {
      const host::Commands commands = commands_of(v);
      for (std::size_t step = 0; step < commands.steps().size(); ++step) {
        lanes_.write(std::vector<std::uint32_t>{0, 0});
        host::run_once(program_->on, commands.only(step));
        const auto counted = lanes_.read_as<std::uint32_t>(2);
        Lanes& sum = sums[commands.steps()[step].kernel->name()];
        sum.useful += counted[0];
        sum.all += counted[1];
      }
    }
    return sums;
  }

 private:
  template <class Real>
  void write_grips(std::size_t vessel) {
    const std::vector<GripInput> sample = sample_of(workload_, vessel);
    std::vector<Real> values(GRIP_AXES * chunk_.stride);
    for (std::size_t i = 0; i < chunk_.count; ++i) {
      const GripInput grip = mirrored(sample[i % SAMPLE], workload_.scene.hand.handedness);
      const std::array<double, GRIP_AXES> axes{grip.height, grip.azimuth, grip.obliquity, grip.roll, grip.offset, grip.hand_scale};
      for (std::size_t axis = 0; axis < GRIP_AXES; ++axis) values[axis * chunk_.stride + i] = static_cast<Real>(axes[axis]);
    }
    grips_.write(values);
  }

  host::Commands commands_of(std::size_t vessel) {
    if (real_ == sizeof(float)) {
      write_grips<float>(vessel);
    } else {
      write_grips<double>(vessel);
    }
    host::Commands commands;
    commands.bind(BINDING_GRIPS, grips_);
    commands.bind(BINDING_REAL_OUT, reals_);
    commands.bind(BINDING_UINT_OUT, uints_);
    commands.bind(BINDING_LANES, lanes_);
    program_->record(vessel, chunk_, 0, NO_LEAST_SCORE, NO_LEAST_SCORE, commands);
    return commands;
  }

  const Workload& workload_;
  std::size_t real_;
  host::GripBackendOptions on_device_;
  std::unique_ptr<host::GripProgram> program_;
  host::Chunk chunk_;
  host::Buffer grips_, reals_, uints_, lanes_;
};

// Workload and kernels of a step.
struct StepKernels {
  int workload;
  std::vector<const char*> kernels;
};
const StepKernels STEP_KERNELS[STEPS] = {{GRIPS, {"closure", "rest", "contact", "overlap", "score"}},
                                         {BODIES, {"closure", "rest", "contact", "overlap", "score"}},
                                         {RESERVES, {"force"}},
                                         {RESERVES, {"effort"}},
                                         {RESERVES, {"reserve"}}};

}  // namespace

const char* device_backend(Precision precision) { return precision == Precision::single ? "vulkan float" : "vulkan double"; }

std::vector<RooflineRow> device_rows(const Options& options, const Peaks& peaks, const std::vector<Workload>& workloads,
                                     const std::vector<Demand>& demands, Precision precision) {
  std::map<int, std::map<std::string, Cost>> costs;
  std::map<int, std::map<std::string, Lanes>> lanes;
  std::map<int, double> grips;
  for (const int number : {int(GRIPS), int(BODIES), int(RESERVES)}) {
    const Workload& workload = workloads[static_cast<std::size_t>(number)];
    DeviceRun timed(options, workload, precision, false);
    costs[number] = timed.costs();
    grips[number] = static_cast<double>(timed.grips());
    if (peaks.counts_lanes) lanes[number] = DeviceRun(options, workload, precision, true).lanes();
  }
  const std::vector<double> bytes = bytes_of(workloads, real_bytes(precision), true);
  std::vector<RooflineRow> rows;
  for (std::size_t step = 0; step < STEPS; ++step) {
    const StepKernels& from = STEP_KERNELS[step];
    Cost cost;
    Lanes counted;
    for (const char* kernel : from.kernels) {
      cost.wall += costs[from.workload][kernel].wall;
      cost.processor += costs[from.workload][kernel].processor;
      counted.useful += lanes[from.workload][kernel].useful;
      counted.all += lanes[from.workload][kernel].all;
    }
    rows.push_back({step_name(static_cast<int>(step)), device_backend(precision), "grip", demands[step], bytes[step],
                    grips[from.workload], cost, device_roof(peaks, precision), counted});
  }
  return rows;
}

}  // namespace wholehand::bench
