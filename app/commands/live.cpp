// SPDX-License-Identifier: MIT
#include "app/commands/live.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <ctime>
#include <functional>
#include <future>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <thread>
#include <utility>

#include "app/commands/live_advice.h"
#include "app/commands/live_board.h"
#include "app/commands/live_report.h"
#include "app/commands/open_gripper.h"
#include "app/viewer/browser.h"
#include "app/viewer/control.h"
#include "app/viewer/live_view.h"
#include "app/viewer/osc_stream.h"
#include "base/files/json.h"
#include "base/system/clock.h"
#include "base/system/interrupt.h"
#include "base/system/output.h"
#include "base/system/progress.h"
#include "base/system/udp.h"
#include "base/system/version.h"
#include "base/text/readable.h"
#include "base/text/text.h"
#include "core/meshes/vessel.h"
#include "core/people/participant.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "device/grippers/view_gripper.h"
#include "device/loop/call_watch.h"
#include "device/loop/gains.h"
#include "device/loop/haptic_loop.h"
#include "device/loop/panic.h"
#include "device/loop/realtime.h"
#include "device/recordings/recorder.h"
#include "device/recordings/recording.h"
#include "device/session/live_scene.h"
#include "device/session/session.h"
#include "device/session/tick_ring.h"
#include "device/simulated/replay_gripper.h"
#include "device/simulated/sim_gripper.h"
#include "sweeps/plan/cavity_notes.h"

namespace wholehand {
namespace {

constexpr double RING_TIME = 4;  // s of ticks that wait while a disk pauses
constexpr std::size_t LEAST_RING = 4096;
constexpr auto LOOK = std::chrono::milliseconds(50);  // between two checks for events
// between two looks of the recorder into the ring if a display shows the session
constexpr std::chrono::microseconds SHOWN_LOOK{static_cast<std::int64_t>(1e6 / DISPLAY_RATE)};
constexpr int LOST_LOOKS = 3;  // this many in a row mean a lost call: after a stop of the process it may still return
constexpr const char* REPLAY = "replay:";
constexpr const char* RECORD = "--record";

std::string now_iso() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char text[40];
  const std::size_t size = std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S%z", &local);
  return {text, size};
}

RecordingInfo recording_info(const Scene& scene, const GripperLimits& gripper, const LiveOptions& options) {
  RecordingInfo info;
  info.scene_name = scene.name;
  info.scene_file = scene.file;
  info.scene_text = scene.text;
  info.version = version();
  info.start = now_iso();
  info.seed = options.seed;
  info.person = options.person;
  info.rate = scene.live.rate;
  info.has_clock = !options.no_clock;
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

// How the session ended, for the view's page.
const char* end_name(Fault fault) { return fault == Fault::none ? "done" : FAULT_NAMES[static_cast<std::size_t>(fault)]; }

// `stiffness`: N/m of the hand's gap.
std::string limits_json(const ViewLimits& limits, double stiffness) {
  return json_text(nlohmann::json{
      {"gap", limits.gap},
      {"center", limits.center},
      {"reach", limits.reach},
      {"opening_N_m", stiffness},
      {"start", {{"position", limits.start.position}, {"rotation", limits.start.rotation}, {"gap", limits.start.gap}}}});
}

// A session streamed to the port on which its own hand is received would hear itself.
void refuse_own_port(const LiveOptions& options, const HostPort& target) {
  const std::optional<HostPort> place = osc_place(options.device);
  if (!place || place->port != target.port) return;
  const UdpAddress here = find_udp_address(*place, "osc"), there = find_udp_address(target, "--stream");
  const bool is_everywhere = here.host() == "0.0.0.0" || here.host() == "::";
  if (!(here == there) && !(is_everywhere && there.is_loopback())) return;
  throw usage_error(fmt::format("--stream {}: --device {} listens there for its hand; give one of the two another port",
                                options.stream, options.device));
}

bool has_places(const Scene& scene) {
  return std::any_of(scene.vessels.begin(), scene.vessels.end(), [](const VesselData& vessel) { return vessel.place != Triple{}; });
}

// Everything of a session, in the order in which it is made.
class LiveRun {
 public:
  explicit LiveRun(const LiveOptions& options) : options_(options) {
    std::optional<HostPort> target;
    if (!options_.stream.empty()) target = parse_osc_url(options_.stream);
    if (target) refuse_own_port(options_, *target);
    if (!options_.record.empty()) check_recording_path(options_.record, RECORD);
    open();
    check_gripper();
    session_ = std::make_unique<Session>(scene_, gripper_->limits().gap);
    const auto capacity = static_cast<std::size_t>(RING_TIME * scene_.live.rate);
    ring_ = std::make_unique<TickRing>(std::max(capacity, LEAST_RING));
    LoopOptions loop;
    loop.seconds = options_.seconds;
    loop.is_simulated = options_.no_clock;
    if (!options_.no_clock) watch_ = std::make_unique<CallWatch>(*gripper_);
    loop.watch = watch_.get();
    loop_ = std::make_unique<HapticLoop>(scene_.live, *gripper_, *session_, sink(), loop);
    if (target) open_stream(*target);
  }

  ExitCode run() {
    InterruptGuard interrupt;
    const PanicGuard panic(*gripper_, watch_.get());
    interrupt.on_second_signal(end_by_signal);  // at once, but only after the force is gone
    Board board(scene_);
    open_view();  // first, so that a taken port leaves no recording behind
    std::unique_ptr<RecordingWriter> writer;
    if (!options_.record.empty())
      writer = std::make_unique<RecordingWriter>(options_.record, recording_info(scene_, gripper_->limits(), options_), RECORD);
    report_advice_place();
    report_address();
    std::optional<DisplayLoop> display;
    if (!displays_.empty()) display.emplace(session_->live(), displays_, advice_source());
    VesselTracker vessels(scene_);  // the session is the haptic thread's
    const auto look = [&](std::span<const Tick> ticks) {
      board.look(ticks);
      for (const Tick& tick : ticks) vessels.follow(tick);
      if (advice_) advice_->look(ticks.back(), vessels.poses());
      if (display) display->look(ticks, vessels.poses());
    };
    Recorder recorder(*ring_, std::move(writer), look, display || advice_ ? SHOWN_LOOK : DRAIN_INTERVAL);
    loop_thread(interrupt, recorder, board);
    const LoopReport& report = loop_->report();
    const bool is_recorded = finish_recording(recorder, report);
    if (display) display->stop();
    if (view_) view_->end(end_name(report.fault));
    report_recording_error(recorder);
    report_advice(board);
    board.show(options_.json);
    show_status("");
    print_summary(report, recorder, is_recorded, true);
    if (watch_ && !watch_->wait_for_return()) leave_watch(report);
    if (is_force_left(report) || (report.fault != Fault::none && report.fault != Fault::interrupted))
      throw failure_error(fault_words(report));
    if (report.fault == Fault::interrupted) return ExitCode::interrupted;
    if (!is_recorded) throw failure_error("live: the session is over and its recording is not whole");
    // a line has said where it is
    return recorder.place() == options_.record ? ExitCode::done : ExitCode::failure;
  }

 private:
  void check_advice(bool is_sim) const {
    if (!options_.advise && !options_.advise_on.empty())
      throw usage_error("--advise-on: it names the device for the advice, and there is no advice; add --advise");
    if (!options_.advise && options_.follow_advice)
      throw usage_error("--follow-advice: there is no advice to follow; add --advise");
    if (options_.follow_advice && !is_sim)
      throw usage_error("--follow-advice: only the simulated user follows by itself; allowed: with --device sim");
  }

  // Before the gripper, whose simulated user may follow it.
  void open_advice() {
    if (!options_.advise) return;
    const std::string on = options_.advise_on.empty() ? default_advice_device() : options_.advise_on;
    advice_ = std::make_unique<LiveAdvice>(scene_, LiveAdvice::Options{on, !options_.no_clock, options_.follow_advice});
  }

  // Prints where the advice is computed, once nothing can be refused any more.
  void report_advice_place() const {
    if (advice_) print_note("live: advice is computed on " + advice_->tally().place);
  }

  std::function<std::shared_ptr<const Advice>()> advice_source() const {
    if (!advice_) return {};
    return [this] { return advice_->newest(); };
  }

  void open() {
    const bool is_replay = is_replay_ = options_.device.rfind(REPLAY, 0) == 0;
    const bool is_sim = options_.device == "sim";
    if (options_.person && !is_sim)
      throw usage_error("--person: only the simulated gripper is held by a virtual person; allowed: with --device sim");
    check_advice(is_sim);
    if (options_.no_clock && !is_replay && !is_sim)
      throw usage_error("--no-clock: this device has a clock of its own; allowed: with --device sim and replay:FILE");
    if (options_.no_clock && options_.view)
      throw usage_error(
          "--view: it shows a session in real time, and --no-clock does not run in real time; leave one of the two out");
    if (options_.no_clock && !options_.stream.empty())
      throw usage_error(
          "--stream: it sends a session in real time, and --no-clock does not run in real time; leave one of the two out");
    if (is_replay && options_.rate > 0) throw usage_error("--rate: a recording is replayed at its own rate; leave it out");
    if (options_.device == REPLAY) throw usage_error("--device replay: the recording is missing; give --device replay:FILE");
    if (is_replay && !options_.scene.empty())
      notes_.push_back("the replay uses another scene: the forces are those of this scene, not the recorded forces");
    std::optional<Recording> recording;
    const std::string replayed = is_replay ? options_.device.substr(std::string(REPLAY).size()) : "";
    if (is_replay) recording = read_recording(replayed);
    if (recording && options_.scene.empty()) {
      scene_ = scene_of_recording(recording->info);
      follow_moved_scene(scene_, replayed);
      options_.seed = recording->info.seed;
      options_.person = recording->info.person;
    } else {
      scene_ = read_scene_file(find_scene(options_.scene.empty() ? DEFAULT_LIVE_SCENE : options_.scene));
      if (options_.person) take_hand_of(scene_, options_.seed, *options_.person);
    }
    load_meshes(scene_);
    check_places();
    print_cavity_notes(scene_);
    if (recording) scene_.live.rate = recording->info.rate;
    if (options_.rate > 0) scene_.live.rate = options_.rate;
    open_advice();
    ShownGripSource* const shown = options_.follow_advice ? advice_->shown() : nullptr;
    if (recording) {
      if (!recording->note.empty()) notes_.push_back(recording->note);
      gripper_ = make_replay(std::move(recording->ticks), limits_of(recording->info.device, options_.device));
    } else {
      if (options_.view && options_.device == "view") input_ = std::make_unique<ViewInput>(scene_);
      gripper_ = options_.person ? open_sim(scene_, options_.seed,
                                            Participant(scene_.people, options_.seed, *options_.person, Experiment::live), shown)
                 : shown         ? open_sim(scene_, options_.seed, shown)
                         : open_gripper(options_.device, scene_, options_.seed, options_.dhd_library, WATCHDOG, input_.get(),
                                        [](const std::string& line) { print_note("live: " + line); });
    }
    const double most = gripper_->limits().rate;
    if (!is_replay && most > 0 && scene_.live.rate > most) {
      throw usage_error(fmt::format("{} Hz: {} measures at most {} times a second; allowed: a --rate up to this number",
                                    plain_text(scene_.live.rate), gripper_->limits().name, plain_text(most)));
    }
  }

  // If vessels overlap only because they have no places: names the shipped scenes that have places.
  void check_places() const {
    try {
      const LiveScene placed(scene_);
    } catch (const Error& error) {
      if (error.code != ExitCode::usage || has_places(scene_)) throw;
      constexpr double FAR_APART = 100;  // m
      Scene apart = scene_;
      for (std::size_t v = 0; v < apart.vessels.size(); ++v) apart.vessels[v].place = {FAR_APART * static_cast<double>(v), 0, 0};
      const LiveScene of_other_causes(apart);  // throws what places do not mend
      std::vector<std::string> placed;
      for (const std::string& name : shipped_scenes())
        if (has_places(read_scene_file(find_scene(name)))) placed.push_back(name);
      if (placed.empty()) throw;
      throw usage_error(fmt::format("{}; shipped scenes whose vessels have places: {}", error.what(), joined(placed, ", ")));
    }
  }

  // Whether this gripper works with this scene. Nobody holds a recording, and nobody feels the page.
  void check_gripper() {
    const GripperLimits& limits = gripper_->limits();
    if (is_replay_ || input_) return;
    refuse_unstable_gains(scene_, limits.gap, options_.unsafe_gains);
    const bool is_left = scene_.hand.handedness == Handedness::left;
    if (limits.is_left_handed != is_left) {
      throw usage_error(fmt::format("{} is for the {} hand, and the scene's [hand] is a {} hand; set handedness = \"{}\" in [hand]",
                                    limits.name, limits.is_left_handed ? "left" : "right", is_left ? "left" : "right",
                                    limits.is_left_handed ? "left" : "right"));
    }
    if (!limits.has_rotation) notes_.push_back("this gripper measures no rotation: vessels stay upright");
  }

  void open_stream(const HostPort& target) {
    stream_ = std::make_unique<OscStream>(target, session_->live());
    displays_.push_back(stream_.get());
    if (stream_->note().empty()) return;
    print_note("live: " + stream_->note());
    notes_.push_back(stream_->note());
  }

  // The view, which listens from here on.
  void open_view() {
    if (!options_.view) return;
    ViewFacts facts;
    facts.title = scene_.name;
    facts.device = gripper_->limits().name;
    facts.rate = scene_.live.rate;
    facts.most_force = gripper_->limits().grip;
    std::function<void(const std::string&)> control;
    if (input_) {
      facts.control_limits = limits_json(input_->limits(), scene_.force.k_open / input_->workspace().gap_slope());
      control = [this](const std::string& body) { input_->post(parse_view_control(body)); };
    }
    view_ = std::make_unique<LiveView>(session_->live(), facts, std::move(control), options_.view_port);
    displays_.push_back(view_.get());
  }

  // Before the session starts, so that it is seen from its beginning.
  void report_address() {
    if (view_) window_ = std::make_unique<BrowserWindow>(view_->address(), options_.json);
  }

  // A loop with a clock must not wait for the ring; one without must not run ahead of it.
  TickSink sink() {
    if (!options_.no_clock) return [this](const Tick& tick) { return ring_->push(tick); };
    return [this](const Tick& tick) {
      if (advice_) advice_->step(tick, session_->poses());
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
      close_gripper();
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
      report_stuck_calls();
      report_warnings();
      report_advice(board);
      lost = watch_ && watch_->lasted() > CALL_LOST ? lost + 1 : 0;
      if (lost == LOST_LOOKS) give_up(interrupt, recorder, board);
      board.show(options_.json);
      // no reader is left; without a clock there is nothing to follow, and only the recording matters
      if (is_output_abandoned() && !options_.no_clock && !interrupt.flag()) {
        note("nobody reads the output any more, so the session ends");
        interrupt.flag() = true;
      }
    }
    haptic.join();
    report_stuck_calls();
    if (watch_ && watch_->count() > 1)
      notes_.push_back(fmt::format("{} calls of the device did not return within {:g} ms", watch_->count(), CALL_PATIENCE * 1e3));
    report_warnings();
    for (std::string& line : gripper_->notes_for_report()) notes_.push_back(std::move(line));
  }

  // Called by the haptic thread, which is watched, because this may not return either.
  void close_gripper() noexcept {
    if (watch_) watch_->enter(monotonic_now());
    gripper_->close();
    if (watch_) watch_->leave();
  }

  // The haptic thread is lost in a device call, and anything that waits for it would never end. Reports everything, finishes the recording and ends
  // the process without destructors.
  [[noreturn]] void give_up(InterruptGuard& interrupt, Recorder& recorder, Board& board) {
    interrupt.flag() = true;  // should the call return
    const std::optional<LoopReport> ending = loop_->ending();
    LoopReport report = ending.value_or(LoopReport{});
    if (!ending) report.fault = Fault::late;
    if (report.release == ReleaseResult::not_attempted || !ending) {
      const ForceSize last = gripper_->last_written_force();
      report.release = watch_->outcome();
      report.force = {{last.arm, 0, 0}, last.grip};
    }
    for (std::string& line : gripper_->notes_for_report()) notes_.push_back(std::move(line));
    show_status("");
    if (ending) print_note(fault_words(report));
    print_note(fmt::format(
        "live: a call of the device has not returned for {:g} s, and {}", CALL_LOST,
        ending ? "the program ends without it" : "the session is given up; " + force_words(report, gripper_->limits().watchdog)));
    const bool is_recorded = finish_recording(recorder, report);
    if (view_) view_->end(end_name(report.fault));
    report_recording_error(recorder);
    if (!ending) {  // the loop's data are still its own
      report.last = board.last();
      report.ticks = board.count();
    }
    print_summary(report, recorder, is_recorded, ending.has_value());
    std::fflush(stdout);
    std::fflush(stderr);
    _exit(static_cast<int>(ExitCode::failure));
  }

  // The second thread is lost in a device call, for which destructors would wait forever: reports everything and ends the process.
  [[noreturn]] void leave_watch(const LoopReport& report) {
    print_note(fault_words(report));
    print_note(
        fmt::format("live: a second call of the device has not returned for {:g} s, and the program ends without it", CALL_LOST));
    std::fflush(stdout);
    std::fflush(stderr);
    _exit(static_cast<int>(ExitCode::failure));
  }

  std::string fault_words(const LoopReport& report) const {
    return fault_line(report, loop_->guard(), scene_.live, gripper_->limits().watchdog);
  }

  // False: it holds only the beginning.
  static bool finish_recording(Recorder& recorder, const LoopReport& report) {
    return recorder.stop({percentiles_of(report.period), percentiles_of(report.step), report.missed, report.fault, ""});
  }

  void note(const std::string& line) {
    show_status("");
    print_note("live: " + line);
    if (options_.json) notes_.push_back(line);  // the summary in words does not repeat it
  }

  void report_recording_error(Recorder& recorder) {
    if (const auto error = recorder.take_error()) note(*error);
  }

  void report_stuck_calls() {
    if (const auto warning = watch_ ? watch_->take_warning() : std::nullopt) note(*warning);
  }

  void report_advice(Board& board) {
    if (!advice_) return;
    for (const std::string& line : advice_->take_warnings()) note(line);
    board.advise(advice_->lines(), advice_->newest().get());
  }

  void report_warnings() {
    if (const auto warning = gripper_->take_warning()) note(*warning);
  }

  // `has_times`: in `report`; false if the loop still has them.
  void print_summary(const LoopReport& report, const Recorder& recorder, bool is_recorded, bool has_times) {
    LiveSummary summary{scene_, gripper_->limits(), report,     0, has_times && !options_.no_clock,
                        notes_, recorder.place(),   is_recorded};
    summary.seconds = static_cast<double>(report.last.number) / scene_.live.rate;
    if (advice_) summary.advice = advice_->tally();
    summary.is_by_signal = InterruptGuard::signalled();
    print(options_.json ? live_json(summary) : live_text(summary));
  }

  LiveOptions options_;
  bool is_replay_ = false;
  Scene scene_;
  std::vector<std::string> notes_;
  std::unique_ptr<LiveAdvice> advice_;  // outlives all that asks it
  std::unique_ptr<ViewInput> input_;    // of the page if it is the gripper
  std::unique_ptr<Gripper> gripper_;
  std::unique_ptr<CallWatch> watch_;
  std::unique_ptr<Session> session_;
  std::unique_ptr<TickRing> ring_;
  std::unique_ptr<HapticLoop> loop_;
  std::unique_ptr<LiveView> view_;
  std::unique_ptr<BrowserWindow> window_;
  std::unique_ptr<OscStream> stream_;
  std::vector<Display*> displays_;
};

}  // namespace

ExitCode run_live(const LiveOptions& options) { return LiveRun(options).run(); }

}  // namespace wholehand
