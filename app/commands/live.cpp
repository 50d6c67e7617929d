// SPDX-License-Identifier: MIT
#include "app/commands/live.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "app/commands/live_displays.h"
#include "app/commands/open_gripper.h"
#include "base/system/output.h"
#include "base/text/readable.h"
#include "base/text/text.h"
#include "core/meshes/vessel.h"
#include "core/people/participant.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "device/advice/stepped_advice.h"
#include "device/grippers/view_gripper.h"
#include "device/loop/gains.h"
#include "device/recordings/recording.h"
#include "device/run/live_run.h"
#include "device/session/live_scene.h"
#include "device/simulated/replay_gripper.h"
#include "device/simulated/sim_gripper.h"
#include "host/device.h"
#include "sweeps/plan/cavity_notes.h"

namespace wholehand {
namespace {

constexpr const char* REPLAY = "replay:";
constexpr const char* RECORD = "--record";

device::GripperLimits limits_of(const device::RecordedDevice& device, const std::string& address) {
  return {"recording of " + device.name,
          address,
          device.force,
          device.grip,
          device.gap,
          device.rate,
          device.has_rotation,
          device.is_left_handed,
          device.pushes_each_tip};
}

bool has_places(const Scene& scene) {
  return std::any_of(scene.vessels.begin(), scene.vessels.end(), [](const VesselData& vessel) { return vessel.place != Triple{}; });
}

// The default device for advice: "vulkan" if there is a Vulkan device, else "core".
std::string default_advice_device() {
  try {
    return host::list_devices().empty() ? "core" : "vulkan";
  } catch (const Error&) {  // no loader, say
    return "core";
  }
}

std::unique_ptr<device::LiveAdvice> make_advice(const Scene& scene, const LiveOptions& options) {
  const std::string on = options.advise_on.empty() ? default_advice_device() : options.advise_on;
  try {
    if (!options.no_clock) return std::make_unique<device::AdviceLoop>(scene, on, 0, options.follow_advice);
    device::SteppedAdvice::Options stepped;
    stepped.keeps_line = options.follow_advice;
    return std::make_unique<device::SteppedAdvice>(scene, on, stepped);
  } catch (const Error& error) {
    // the remedy's usual words name an option that live lacks
    const char* remedy = error.remedy == Remedy::core      ? "; use --advise-on core"
                         : error.remedy == Remedy::or_core ? ", or use --advise-on core"
                                                           : nullptr;
    if (!remedy) throw;
    throw Error(error.code, std::string(error.what()) + remedy);
  }
}

// What the options ask for, in the order in which it is opened.
class LiveCommand {
 public:
  explicit LiveCommand(const LiveOptions& options) : options_(options), displays_(options_) {
    if (!options_.record.empty()) device::check_recording_path(options_.record, RECORD);
    open();
    check_gripper();
    run_.emplace(scene_, *gripper_,
                 device::LiveRunOptions{options_.seconds, !options_.no_clock, options_.json, options_.record, RECORD, options_.seed,
                                        options_.person, advice_.get()});
    for (const std::string& line : notes_) run_->add_note(line);
    displays_.open(*run_, scene_, gripper_->limits(),
                   input_.get());  // before the recording, so that a taken port leaves none behind
  }

  ExitCode run() {
    // a window opens before the session starts, so that it is seen from its beginning
    return run_->run([this] { displays_.open_window(); });
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
    std::optional<device::Recording> recording;
    const std::string replayed = is_replay ? options_.device.substr(std::string(REPLAY).size()) : "";
    if (is_replay) recording = device::read_recording(replayed);
    if (recording && options_.scene.empty()) {
      scene_ = device::scene_of_recording(recording->info);
      follow_moved_scene(scene_, replayed);
      options_.seed = recording->info.seed;
      options_.person = recording->info.person;
    } else {
      scene_ = read_scene_file(find_scene(options_.scene.empty() ? DEFAULT_LIVE_SCENE : options_.scene));
      if (options_.person) device::take_hand_of(scene_, options_.seed, *options_.person);
    }
    load_meshes(scene_);
    check_places();
    sweeps::print_cavity_notes(scene_);
    if (recording) scene_.live.rate = recording->info.rate;
    if (options_.rate > 0) scene_.live.rate = options_.rate;
    if (options_.advise) advice_ = make_advice(scene_, options_);  // the simulated user may follow it
    device::ShownGripSource* const shown = options_.follow_advice ? &advice_->shown() : nullptr;
    if (recording) {
      if (!recording->note.empty()) notes_.push_back(recording->note);
      gripper_ = device::make_replay(std::move(recording->ticks), limits_of(recording->info.device, options_.device));
    } else {
      if (options_.view && options_.device == "view") input_ = std::make_unique<device::ViewInput>(scene_);
      gripper_ = options_.person
                     ? device::open_sim(scene_, options_.seed,
                                        Participant(scene_.people, options_.seed, *options_.person, Experiment::live), shown)
                 : shown ? device::open_sim(scene_, options_.seed, shown)
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
      const device::LiveScene placed(scene_);
    } catch (const Error& error) {
      if (error.code != ExitCode::usage || has_places(scene_)) throw;
      constexpr double FAR_APART = 100;  // m
      Scene apart = scene_;
      for (std::size_t v = 0; v < apart.vessels.size(); ++v) apart.vessels[v].place = {FAR_APART * static_cast<double>(v), 0, 0};
      const device::LiveScene of_other_causes(apart);  // throws what places do not mend
      std::vector<std::string> placed;
      for (const std::string& name : shipped_scenes())
        if (has_places(read_scene_file(find_scene(name)))) placed.push_back(name);
      if (placed.empty()) throw;
      throw usage_error(fmt::format("{}; shipped scenes whose vessels have places: {}", error.what(), joined(placed, ", ")));
    }
  }

  // Whether this gripper works with this scene. Nobody holds a recording, and nobody feels the page.
  void check_gripper() {
    const device::GripperLimits& limits = gripper_->limits();
    if (is_replay_ || input_) return;
    device::refuse_unstable_gains(scene_, limits.gap, options_.unsafe_gains);
    const bool is_left = scene_.hand.handedness == Handedness::left;
    if (limits.is_left_handed != is_left) {
      throw usage_error(fmt::format("{} is for the {} hand, and the scene's [hand] is a {} hand; set handedness = \"{}\" in [hand]",
                                    limits.name, limits.is_left_handed ? "left" : "right", is_left ? "left" : "right",
                                    limits.is_left_handed ? "left" : "right"));
    }
    if (!limits.has_rotation) notes_.push_back("this gripper measures no rotation: vessels stay upright");
  }

  LiveOptions options_;
  bool is_replay_ = false;
  Scene scene_;
  std::vector<std::string> notes_;
  std::unique_ptr<device::LiveAdvice> advice_;  // outlives all that asks it
  std::unique_ptr<device::ViewInput> input_;    // of the page if it is the gripper
  std::unique_ptr<device::Gripper> gripper_;
  std::optional<device::LiveRun> run_;
  LiveDisplays displays_;
};

}  // namespace

ExitCode run_live(const LiveOptions& options) { return LiveCommand(options).run(); }

}  // namespace wholehand
