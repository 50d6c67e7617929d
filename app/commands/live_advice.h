// SPDX-License-Identifier: MIT
// The advice of `wholehand live --advise`: on its own thread if the session has a clock, else in step with it.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "device/advice/advice_loop.h"
#include "device/advice/stepped_advice.h"

namespace wholehand {

// The default device: "vulkan" if there is a Vulkan device, else "core".
std::string default_advice_device();

// Prints a line for each new situation (the hand comes near a vessel, a grasp), once its advice exists.
class AdviceNarrator {
 public:
  explicit AdviceNarrator(const Scene& scene) : rate_(scene.live.rate), scene_(scene) {}
  // Nothing: the same vessel, still free or still held, or nothing to advise.
  std::optional<std::string> narrate(const Advice& advice);

 private:
  double rate_;
  const Scene& scene_;
  int vessel_ = -1;
  bool is_held_ = false;
};

class LiveAdvice {
 public:
  struct Options {
    std::string on;  // as for open_backend
    bool has_clock = true;
    bool is_followed = false;  // the simulated user follows it, and gets shown()
  };
  // Opens the device; `scene` must outlive it. Throws Error as Adviser does.
  LiveAdvice(const Scene& scene, const Options& options);

  ShownGripSource* shown();
  // Takes ticks in order, with the vessels at `poses`: with a clock the newest from the recorder's thread, without one each tick in the loop.
  void look(const Tick& tick, const VesselPoses& poses);
  void step(const Tick& tick, const VesselPoses& poses);

  // From any thread.
  std::shared_ptr<const Advice> newest() const;
  std::vector<std::string> lines();  // situations that began since the last call
  std::vector<std::string> take_warnings();
  AdviceTally tally() const;

 private:
  void open(const Scene& scene, const Options& options);
  void narrate_newest();

  std::unique_ptr<AdviceLoop> loop_;  // one of these two
  std::unique_ptr<SteppedAdvice> stepped_;
  std::mutex mutex_;  // of the next three
  AdviceNarrator narrator_;
  std::vector<std::string> lines_;
  std::shared_ptr<const Advice> narrated_;
};

// "computed on vulkan, llvmpipe (..): 312 updates of 1,024 grips on average, 9.8 a second, no two further apart than 0.15 s".
std::string tally_words(const AdviceTally& tally);

}  // namespace wholehand
