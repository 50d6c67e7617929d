// SPDX-License-Identifier: MIT
#include "device/run/live_run.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <ctime>
#include <future>
#include <thread>

#include "base/system/clock.h"
#include "base/system/output.h"
#include "base/system/progress.h"
#include "base/system/version.h"
#include "device/loop/panic.h"
#include "device/loop/realtime.h"

namespace wholehand::device {
namespace {

constexpr double RING_TIME = 4;  // s of ticks that wait while a disk pauses
constexpr std::size_t LEAST_RING = 4096;
constexpr auto LOOK = std::chrono::milliseconds(50);  // between two checks for events
// between two looks of the recorder into the ring if a display shows the session
constexpr std::chrono::microseconds SHOWN_LOOK{static_cast<std::int64_t>(1e6 / DISPLAY_RATE)};
constexpr int LOST_LOOKS = 3;  // this many in a row mean a lost call: after a stop of the process it may still return

std::string now_iso() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char text[40];
  const std::size_t size = std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S%z", &local);
  return {text, size};
}

RecordingInfo recording_info(const Scene& scene, const GripperLimits& gripper, const LiveRunOptions& options) {
  RecordingInfo info;
  info.scene_name = scene.name;
  info.scene_file = scene.file;
  info.scene_text = scene.text;
  info.version = version();
  info.start = now_iso();
  info.seed = options.seed;
  info.person = options.person;
  info.rate = scene.live.rate;
  info.has_clock = options.has_clock;
  info.device = {gripper.name, gripper.address,      gripper.force,          gripper.grip,           gripper.gap,
                 gripper.rate, gripper.has_rotation, gripper.is_left_handed, gripper.pushes_each_tip};
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

Percentiles percentiles_of(const Histogram& times) {
  return {times.quantile(0.5), times.quantile(0.99), times.quantile(0.999), times.largest()};
}

// How the session ended, for displays.
const char* end_name(Fault fault) { return fault == Fault::none ? "done" : FAULT_NAMES[static_cast<std::size_t>(fault)]; }

std::size_t ring_size(const Scene& scene) { return std::max(static_cast<std::size_t>(RING_TIME * scene.live.rate), LEAST_RING); }

// False: it holds only the beginning.
bool finish_recording(Recorder& recorder, const LoopReport& report) {
  return recorder.stop({percentiles_of(report.period), percentiles_of(report.step), report.missed, report.fault, ""});
}

// A thread is lost in a device call, for which destructors would wait forever.
[[noreturn]] void end_process() {
  std::fflush(stdout);
  std::fflush(stderr);
  _exit(static_cast<int>(ExitCode::failure));
}

}  // namespace

LiveRun::LiveRun(const Scene& scene, Gripper& gripper, const LiveRunOptions& options)
    : scene_(scene),
      gripper_(gripper),
      options_(options),
      board_(scene),
      watch_(options.has_clock ? std::make_unique<CallWatch>(gripper) : nullptr),
      session_(scene, gripper.limits().gap),
      ring_(ring_size(scene)),
      loop_(scene.live, gripper, session_, sink(), {options.seconds, !options.has_clock, watch_.get()}) {}

ExitCode LiveRun::run(const std::function<void()>& begin) {
  InterruptGuard interrupt;
  const PanicGuard panic(gripper_, watch_.get());
  interrupt.on_second_signal(end_by_signal);  // at once, but only after the force is gone
  std::unique_ptr<RecordingWriter> writer;
  if (!options_.record.empty())
    writer = std::make_unique<RecordingWriter>(options_.record, recording_info(scene_, gripper_.limits(), options_),
                                               options_.record_name);
  if (options_.advice) print_note("live: advice is computed on " + options_.advice->tally().place);
  begin();
  std::optional<DisplayLoop> display;
  AdviceSource advice;
  if (options_.advice) advice = [this] { return options_.advice->newest(); };
  if (!displays_.empty()) display.emplace(session_.live(), displays_, advice);
  VesselTracker vessels(scene_);  // the session is the haptic thread's
  const auto look = [&](std::span<const Tick> ticks) {
    board_.look(ticks);
    for (const Tick& tick : ticks) vessels.follow(tick);
    if (options_.advice && options_.has_clock) options_.advice->look(ticks.back(), vessels.poses());
    if (display) display->look(ticks, vessels.poses());
  };
  Recorder recorder(ring_, std::move(writer), look, display || options_.advice ? SHOWN_LOOK : DRAIN_INTERVAL);
  loop_thread(interrupt, recorder);
  const LoopReport& report = loop_.report();
  const bool is_recorded = finish_recording(recorder, report);
  if (display) display->stop();
  for (Display* const shown : displays_) shown->end(end_name(report.fault));
  report_recording_error(recorder);
  report_advice();
  board_.show(options_.json);
  show_status("");
  print_summary(report, recorder, is_recorded, true);
  if (watch_ && !watch_->wait_for_return()) {
    print_note(fault_words(report));
    print_note(
        fmt::format("live: a second call of the device has not returned for {:g} s, and the program ends without it", CALL_LOST));
    end_process();
  }
  if (is_force_left(report) || (report.fault != Fault::none && report.fault != Fault::interrupted))
    throw failure_error(fault_words(report));
  if (report.fault == Fault::interrupted) return ExitCode::interrupted;
  if (!is_recorded) throw failure_error("live: the session is over and its recording is not whole");
  // a line has said where it is
  return recorder.place() == options_.record ? ExitCode::done : ExitCode::failure;
}

// A loop with a clock must not wait for the ring; one without must not run ahead of it.
TickSink LiveRun::sink() {
  if (options_.has_clock) return [this](const Tick& tick) { return ring_.push(tick); };
  return [this](const Tick& tick) {
    if (options_.advice) {
      options_.advice->look(tick, session_.poses());
      board_.advise(options_.advice->newest());
    }
    while (!ring_.push(tick)) std::this_thread::sleep_for(std::chrono::microseconds(100));
    return true;
  };
}

void LiveRun::loop_thread(InterruptGuard& interrupt, Recorder& recorder) {
  std::atomic<bool> is_over{false};
  std::promise<std::vector<std::string>> permitted;
  std::thread haptic([&] {
    const HandlerStack stack;
    permitted.set_value(options_.has_clock ? make_realtime() : std::vector<std::string>{});
    loop_.run(interrupt.flag());
    // on this thread, which is watched, because it may not return either
    if (watch_) watch_->enter(monotonic_now());
    gripper_.close();
    if (watch_) watch_->leave();
    is_over = true;
  });
  for (const std::string& note : permitted.get_future().get()) {
    print_note("live: " + note);
    notes_.push_back(note);
  }
  int lost = 0;
  while (!is_over) {
    std::this_thread::sleep_for(LOOK);
    report_recording_error(recorder);
    report_warnings();
    report_advice();
    lost = watch_ && watch_->lasted() > CALL_LOST ? lost + 1 : 0;
    if (lost == LOST_LOOKS) give_up(interrupt, recorder);
    board_.show(options_.json);
    // no reader is left; without a clock there is nothing to follow, and only the recording matters
    if (is_output_abandoned() && options_.has_clock && !interrupt.flag()) {
      note("nobody reads the output any more, so the session ends");
      interrupt.flag() = true;
    }
  }
  haptic.join();
  report_warnings();
  if (watch_ && watch_->count() > 1)
    notes_.push_back(fmt::format("{} calls of the device did not return within {:g} ms", watch_->count(), CALL_PATIENCE * 1e3));
  for (std::string& line : gripper_.notes_for_report()) notes_.push_back(std::move(line));
}

// The haptic thread is lost in a device call, and anything that waits for it would never end. Reports everything, finishes the recording and ends
// the process without destructors.
void LiveRun::give_up(InterruptGuard& interrupt, Recorder& recorder) {
  interrupt.flag() = true;  // should the call return
  const std::optional<LoopReport> ending = loop_.ending();
  LoopReport report = ending.value_or(LoopReport{});
  if (!ending) report.fault = Fault::late;
  if (report.release == ReleaseResult::not_attempted || !ending) {
    const ForceSize last = gripper_.last_written_force();
    report.release = watch_->outcome();
    report.force = {{last.arm, 0, 0}, last.grip};
  }
  for (std::string& line : gripper_.notes_for_report()) notes_.push_back(std::move(line));
  show_status("");
  if (ending) print_note(fault_words(report));
  print_note(fmt::format(
      "live: a call of the device has not returned for {:g} s, and {}", CALL_LOST,
      ending ? "the program ends without it" : "the session is given up; " + force_words(report, gripper_.limits().watchdog)));
  const bool is_recorded = finish_recording(recorder, report);
  for (Display* const shown : displays_) shown->end(end_name(report.fault));
  report_recording_error(recorder);
  if (!ending) {  // the loop's data are still its own
    report.last = board_.last();
    report.ticks = board_.count();
  }
  print_summary(report, recorder, is_recorded, ending.has_value());
  end_process();
}

std::string LiveRun::fault_words(const LoopReport& report) const {
  return fault_line(report, loop_.guard(), scene_.live, gripper_.limits().watchdog);
}

void LiveRun::note(const std::string& line) {
  show_status("");
  print_note("live: " + line);
  if (options_.json) notes_.push_back(line);  // the summary in words does not repeat it
}

void LiveRun::report_recording_error(Recorder& recorder) {
  if (const auto error = recorder.take_error()) note(*error);
}

void LiveRun::report_advice() {
  if (!options_.advice) return;
  for (const std::string& line : options_.advice->take_warnings()) note(line);
  if (options_.has_clock) board_.advise(options_.advice->newest());
}

void LiveRun::report_warnings() {
  if (const auto warning = watch_ ? watch_->take_warning() : std::nullopt) note(*warning);
  if (const auto warning = gripper_.take_warning()) note(*warning);
}

// `has_times`: in `report`; false if the loop still has them.
void LiveRun::print_summary(const LoopReport& report, const Recorder& recorder, bool is_recorded, bool has_times) {
  LiveSummary summary{scene_, gripper_.limits(), report, 0, has_times && options_.has_clock, notes_, recorder.place(), is_recorded};
  summary.seconds = static_cast<double>(report.last.number) / scene_.live.rate;
  if (options_.advice) summary.advice = options_.advice->tally();
  summary.is_by_signal = InterruptGuard::signalled();
  print(options_.json ? live_json(summary) : live_text(summary));
}

}  // namespace wholehand::device
