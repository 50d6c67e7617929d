// SPDX-License-Identifier: MIT
#include "app/commands/live_advice.h"

#include <fmt/format.h>

#include <utility>

#include "base/text/error.h"
#include "base/text/readable.h"
#include "device/advice/words.h"
#include "host/device.h"

namespace wholehand {

std::string default_advice_device() {
  try {
    return host::list_devices().empty() ? "core" : "vulkan";
  } catch (const Error&) {  // no loader, say
    return "core";
  }
}

std::optional<std::string> AdviceNarrator::narrate(const Advice& advice) {
  const bool is_new = advice.vessel != vessel_ || advice.is_held != is_held_;
  const std::string words = advice_words(advice);
  if (is_new && advice.vessel >= 0 && words.empty()) return std::nullopt;  // it may have some later
  vessel_ = advice.vessel;
  is_held_ = advice.is_held;
  if (!is_new || advice.vessel < 0) return std::nullopt;
  return fmt::format("{:8.2f} s  advice, {}: {}", static_cast<double>(advice.tick) / rate_,
                     scene_.vessels[static_cast<std::size_t>(advice.vessel)].name, words);
}

LiveAdvice::LiveAdvice(const Scene& scene, const Options& options) : narrator_(scene) {
  try {
    open(scene, options);
  } catch (const Error& error) {
    // the remedy's usual words name an option that live lacks
    const char* remedy = error.remedy == Remedy::core      ? "; use --advise-on core"
                         : error.remedy == Remedy::or_core ? ", or use --advise-on core"
                                                           : nullptr;
    if (!remedy) throw;
    throw Error(error.code, std::string(error.what()) + remedy);
  }
}

void LiveAdvice::open(const Scene& scene, const Options& options) {
  if (options.has_clock) {
    loop_ = std::make_unique<AdviceLoop>(scene, options.on, 0, options.is_followed);
  } else {
    SteppedAdvice::Options stepped;
    stepped.keeps_line = options.is_followed;
    stepped_ = std::make_unique<SteppedAdvice>(scene, options.on, stepped);
  }
}

ShownGripSource* LiveAdvice::shown() { return loop_ ? &loop_->shown() : stepped_.get(); }

void LiveAdvice::look(const Tick& tick, const VesselPoses& poses) {
  if (loop_) loop_->look(tick, poses);
}

void LiveAdvice::step(const Tick& tick, const VesselPoses& poses) {
  if (!stepped_) return;
  stepped_->look(tick, poses);
  narrate_newest();
}

std::shared_ptr<const Advice> LiveAdvice::newest() const { return loop_ ? loop_->newest() : stepped_->newest(); }

void LiveAdvice::narrate_newest() {
  const std::shared_ptr<const Advice> now = newest();
  const std::lock_guard lock(mutex_);
  if (!now || now == narrated_) return;
  narrated_ = now;
  if (std::optional<std::string> line = narrator_.narrate(*now)) lines_.push_back(std::move(*line));
}

std::vector<std::string> LiveAdvice::lines() {
  if (loop_) narrate_newest();
  const std::lock_guard lock(mutex_);
  return std::exchange(lines_, {});
}

std::vector<std::string> LiveAdvice::take_warnings() { return loop_ ? loop_->take_warnings() : stepped_->take_warnings(); }

AdviceTally LiveAdvice::tally() const { return loop_ ? loop_->tally() : stepped_->tally(); }

std::string tally_words(const AdviceTally& tally) {
  std::string words = fmt::format("computed on {}: {}", tally.place, counted(tally.updates, "update"));
  if (tally.updates > 0) words += fmt::format(" of {} on average", counted(tally.grips / tally.updates, "grip"));
  if (tally.seconds > 0) words += fmt::format(", {:.1f} a second, no two further apart than {:.2f} s", tally.rate(), tally.longest);
  return words;
}

}  // namespace wholehand
