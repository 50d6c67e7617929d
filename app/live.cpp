#include "app/live.h"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <ctime>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <thread>
#include <utility>

#include "app/live_report.h"
#include "app/open_gripper.h"
#include "app/output.h"
#include "app/paths.h"
#include "app/scene_reader.h"
#include "app/version.h"
#include "core/session.h"
#include "core/tick_ring.h"
#include "device/haptic_loop.h"
#include "device/panic.h"
#include "device/realtime.h"
#include "device/replay_gripper.h"
#include "sweeps/gains.h"
#include "sweeps/interrupt.h"
#include "sweeps/mesh_vessel.h"
#include "sweeps/progress.h"
#include "sweeps/recorder.h"
#include "sweeps/recording.h"

namespace wholehand {
namespace {

constexpr double RING_TIME = 4;  // s of ticks that wait for a disk that pauses
constexpr std::size_t LEAST_RING = 4096;
constexpr auto LOOK = std::chrono::milliseconds(50);  // between two looks at what has happened
constexpr const char* REPLAY = "replay:";

std::string now_iso() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char text[40];
  const std::size_t size = std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S%z", &local);
  return {text, size};
}

RecordingInfo info_of(const Scene& scene, const GripperLimits& gripper, std::uint64_t seed) {
  RecordingInfo info;
  info.scene_name = scene.name;
  info.scene_file = scene.file;
  info.scene_text = scene.text;
  info.version = version();
  info.start = now_iso();
  info.seed = seed;
  info.rate = scene.live.rate;
  info.device = {gripper.name, gripper.address, gripper.force,        gripper.grip,
                 gripper.gap,  gripper.rate,    gripper.has_rotation, gripper.is_left_handed};
  for (const VesselData& vessel : scene.vessels) {
    info.vessels.push_back({vessel.name, vessel.liquid_name, vessel.force_range.value_or(scene.force.range)});
  }
  info.force_base = scene.force.base;
  info.force_max = scene.force.max;
  if (scene.task) {
    for (const auto& [liquid, volume] : scene.task->amounts) info.amounts.push_back({liquid, volume});
    info.tolerance = scene.task->tolerance;
  }
  return info;
}

GripperLimits limits_of(const RecordedDevice& device, const std::string& address) {
  return {"recording of " + device.name, address, device.force, device.grip, device.gap, device.rate, device.has_rotation,
          device.is_left_handed};
}

Percentiles percentiles_of(const Histogram& times) {
  return {times.quantile(0.5), times.quantile(0.99), times.quantile(0.999), times.largest()};
}

// Lines that the recorder's thread has for the main one.
class Board {
 public:
  explicit Board(const Scene& scene) : narrator_(scene) {}
  void look(std::span<const Tick> ticks) {
    std::vector<std::string> lines;
    for (const Tick& tick : ticks) {
      for (std::string& line : narrator_.look(tick)) lines.push_back(std::move(line));
    }
    const std::string status = narrator_.status(ticks.back());
    const std::lock_guard lock(mutex_);
    for (std::string& line : lines) lines_.push_back(std::move(line));
    status_ = status;
  }
  // Prints what is new; `quiet`: only the status, and only on a terminal.
  void show(bool quiet) {
    std::vector<std::string> lines;
    std::string status;
    {
      const std::lock_guard lock(mutex_);
      lines.swap(lines_);
      status = status_;
    }
    if (!lines.empty() && !quiet) {
      show_status("");
      for (const std::string& line : lines) print(line + "\n");
      std::fflush(stdout);
    }
    show_status(status);
  }

 private:
  Narrator narrator_;
  std::mutex mutex_;
  std::vector<std::string> lines_;
  std::string status_;
};

// Everything of a session, in the order in which it is made.
class LiveRun {
 public:
  explicit LiveRun(const LiveOptions& options) : options_(options) {
    if (!options_.record.empty()) check_recording_path(options_.record);
    open();
    check_gripper();
    session_ = std::make_unique<Session>(scene_, gripper_->limits().gap);
    const auto capacity = static_cast<std::size_t>(RING_TIME * scene_.live.rate);
    ring_ = std::make_unique<TickRing>(std::max(capacity, LEAST_RING));
    LoopOptions loop;
    loop.seconds = options_.seconds;
    loop.is_simulated = options_.no_clock;
    loop_ = std::make_unique<HapticLoop>(scene_.live, *gripper_, *session_, sink(), loop);
  }

  ExitCode run() {
    InterruptGuard interrupt;
    const PanicGuard panic(*gripper_);
    Board board(scene_);
    std::unique_ptr<RecordingWriter> writer;
    if (!options_.record.empty())
      writer = std::make_unique<RecordingWriter>(options_.record, info_of(scene_, gripper_->limits(), options_.seed));
    Recorder recorder(*ring_, std::move(writer), [&board](std::span<const Tick> ticks) { board.look(ticks); });
    loop_thread(interrupt, recorder, board);
    const LoopReport& report = loop_->report();
    const bool is_recorded =
        recorder.stop({percentiles_of(report.period), percentiles_of(report.step), report.missed, report.fault, ""});
    tell_trouble(recorder);
    board.show(options_.json);
    show_status("");
    tell(is_recorded);
    if (report.fault == Fault::interrupted) return ExitCode::interrupted;
    if (report.fault != Fault::none) throw failure_error(fault_line(report, loop_->guard(), scene_.live));
    if (!is_recorded) throw failure_error("live: the session is over and the recording holds only its beginning");
    return ExitCode::done;
  }

 private:
  void open() {
    const bool is_replay = is_replay_ = options_.device.rfind(REPLAY, 0) == 0;
    const bool is_sim = options_.device == "sim";
    if (options_.no_clock && !is_replay && !is_sim)
      throw usage_error("--no-clock: a device keeps its own time; allowed with --device sim and replay:FILE");
    if (is_replay && options_.rate > 0) throw usage_error("--rate: a recording is replayed at its own rate; leave it out");
    if (options_.device == REPLAY) throw usage_error("--device replay: needs a recording: --device replay:FILE");
    if (is_replay && !options_.scene.empty())
      notes_.push_back("replayed in another scene: the forces are what that one gives, not those that were felt");
    std::optional<Recording> recording;
    if (is_replay) recording = read_recording(options_.device.substr(std::string(REPLAY).size()));
    if (recording && options_.scene.empty()) {
      scene_ = parse_scene(recording->info.scene_text, recording->info.scene_file);
    } else {
      scene_ = read_scene_file(find_scene(options_.scene.empty() ? DEFAULT_LIVE_SCENE : options_.scene));
    }
    load_meshes(scene_, "core");
    if (recording) scene_.live.rate = recording->info.rate;
    if (options_.rate > 0) scene_.live.rate = options_.rate;
    if (recording) {
      if (!recording->note.empty()) notes_.push_back(recording->note);
      gripper_ = make_replay(std::move(recording->ticks), limits_of(recording->info.device, options_.device));
    } else {
      gripper_ = open_gripper(options_.device, scene_, options_.seed, options_.dhd_library);
    }
    const double most = gripper_->limits().rate;
    if (!is_replay && most > 0 && scene_.live.rate > most) {
      throw usage_error(fmt::format("{:g} Hz: {} measures at most {:g} times a second; allowed: --rate up to that",
                                    scene_.live.rate, gripper_->limits().name, most));
    }
  }

  // Whether this gripper goes with this scene. Nobody holds a recording.
  void check_gripper() {
    const GripperLimits& limits = gripper_->limits();
    if (is_replay_) return;
    refuse_unstable_gains(scene_, limits.gap, options_.unsafe_gains);
    const bool is_left = scene_.hand.handedness == Handedness::left;
    if (limits.is_left_handed != is_left) {
      throw usage_error(fmt::format("{} is for the {} hand and the scene's [hand] is a {} one; say handedness = \"{}\" there",
                                    limits.name, limits.is_left_handed ? "left" : "right", is_left ? "left" : "right",
                                    limits.is_left_handed ? "left" : "right"));
    }
    if (!limits.has_rotation) notes_.push_back("this gripper measures no rotation: vessels stay upright");
  }

  // A loop that has a clock must not wait for the ring; one that has none must not run away from it.
  TickSink sink() {
    if (!options_.no_clock) return [this](const Tick& tick) { return ring_->push(tick); };
    return [this](const Tick& tick) {
      while (!ring_->push(tick)) std::this_thread::sleep_for(std::chrono::microseconds(100));
      return true;
    };
  }

  void loop_thread(InterruptGuard& interrupt, Recorder& recorder, Board& board) {
    std::atomic<bool> is_over{false};
    std::promise<std::vector<std::string>> permitted;
    std::thread haptic([&] {
      const HandlerStack stack;
      permitted.set_value(options_.no_clock ? std::vector<std::string>{} : make_realtime());
      loop_->run(interrupt.flag());
      is_over = true;
    });
    for (const std::string& note : permitted.get_future().get()) {
      std::fprintf(stderr, "wholehand: live: %s\n", note.c_str());
      notes_.push_back(note);
    }
    while (!is_over) {
      std::this_thread::sleep_for(LOOK);
      tell_trouble(recorder);
      try {
        board.show(options_.json);
      } catch (...) {  // nobody listens any more: the session ends first, and then that is told
        interrupt.flag() = true;
        haptic.join();
        throw;
      }
    }
    haptic.join();
  }

  void tell_trouble(Recorder& recorder) {
    if (const auto trouble = recorder.trouble()) {
      show_status("");
      std::fprintf(stderr, "wholehand: live: %s\n", trouble->c_str());
      notes_.push_back(*trouble);
    }
  }

  void tell(bool is_recorded) {
    LiveSummary summary{scene_, gripper_->limits(), loop_->report(), 0, !options_.no_clock, notes_, options_.record, is_recorded};
    summary.seconds = static_cast<double>(loop_->report().last.number) / scene_.live.rate;
    print(options_.json ? live_json(summary) : live_text(summary));
  }

  LiveOptions options_;
  bool is_replay_ = false;
  Scene scene_;
  std::vector<std::string> notes_;
  std::unique_ptr<Gripper> gripper_;
  std::unique_ptr<Session> session_;
  std::unique_ptr<TickRing> ring_;
  std::unique_ptr<HapticLoop> loop_;
};

}  // namespace

ExitCode run_live(const LiveOptions& options) { return LiveRun(options).run(); }

}  // namespace wholehand
