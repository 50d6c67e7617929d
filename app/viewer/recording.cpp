// SPDX-License-Identifier: MIT
#include "app/viewer/recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/viewer/scene.h"
#include "base/text/error.h"

namespace wholehand {
namespace {

device::Recording checked(device::Recording recording) {
  if (recording.ticks.empty()) throw usage_error("view: the recording has no ticks");
  return recording;
}

Scene at_rate(Scene scene, double rate) {
  scene.live.rate = rate;
  return scene;
}

// How many frames a stretch has.
double count_of(double from, double to, double rate) { return to > from ? std::floor((to - from) * rate + 1e-9) + 1 : 1; }

}  // namespace

RecordingView::RecordingView(const Scene& scene, device::Recording recording)
    : recording_(checked(std::move(recording))),
      live_(at_rate(scene, recording_.info.rate)),
      history_(live_.scene, recording_.ticks) {
  if (live_.vessels.size() != recording_.info.vessels.size())
    throw usage_error("view: the recording does not belong to the scene that it names");
}

double RecordingView::duration() const { return static_cast<double>(recording_.ticks.back().number + 1) / recording_.info.rate; }

std::size_t RecordingView::tick_by(double time) const {
  const std::vector<device::Tick>& ticks = recording_.ticks;
  const double number = time * recording_.info.rate + 1e-6;  // what was asked for as k / rate is tick k
  const auto after = std::upper_bound(ticks.begin(), ticks.end(), number,
                                      [](double n, const device::Tick& tick) { return n < static_cast<double>(tick.number); });
  return after == ticks.begin() ? 0 : static_cast<std::size_t>(after - ticks.begin()) - 1;
}

device::DisplayTiming RecordingView::timing_of(std::size_t tick) const {
  const std::vector<device::Tick>& ticks = recording_.ticks;
  const double rate = recording_.info.rate;
  device::DisplayTiming timing;
  if (!recording_.info.has_clock) {
    timing.rate = timing.step = device::Tick::NONE;
    return timing;
  }
  timing.step = ticks[tick].step_time;
  timing.missed = ticks[tick].number - ticks[0].number - static_cast<std::int64_t>(tick);
  // rate over the second before
  const std::size_t before = tick_by(static_cast<double>(ticks[tick].number) / rate - 1);
  timing.rate = before == tick
                    ? rate
                    : rate * static_cast<double>(tick - before) / static_cast<double>(ticks[tick].number - ticks[before].number);
  return timing;
}

std::vector<ViewFrame> RecordingView::frames(double from, double to, double rate) const {
  FrameMaker maker(live_);
  std::vector<ViewFrame> frames;
  const int count = static_cast<int>(count_of(from, to, rate));
  for (int k = 0; k < count; ++k) {
    const std::size_t at = tick_by(from + (k > 0 ? k / rate : 0));
    const device::VesselPoses poses = history_.at(at);
    const device::Tick& tick = recording_.ticks[at];
    frames.push_back(maker.make(tick, poses, device::hand_view(live_, tick, poses), timing_of(at)));
  }
  return frames;
}

std::string RecordingView::answer(const ViewContent::Query& query) const {
  constexpr double LONGEST = 1e9;  // s
  const double from = query_number(query, "from", 0, LONGEST), to = query_number(query, "to", from, LONGEST);
  const double rate = query_number(query, "rate", 0, LONGEST);
  if (count_of(from, to, rate) > MOST_RECORDED_FRAMES)
    throw usage_error(fmt::format("at most {} frames at once", MOST_RECORDED_FRAMES));
  std::string json = "{\"frames\":[";
  bool is_first = true;
  for (const ViewFrame& frame : frames(from, to, rate)) {
    if (!is_first) json += ",";
    is_first = false;
    json += frame_json(frame);
  }
  return json + "]}";
}

ViewContent RecordingView::content(const std::string& title) const {
  ViewFacts facts;
  facts.mode = ViewMode::recording;
  facts.title = title;
  facts.device = recording_.info.device.name;
  facts.duration = duration();
  facts.rate = recording_.info.rate;
  facts.most_force = recording_.info.device.grip;
  ViewContent content;
  content.scene = view_scene_json(live_.scene, facts);
  for (const VesselData& vessel : live_.scene.vessels) content.meshes.push_back(mesh_bytes(vessel));
  content.recording = [this](const ViewContent::Query& query) { return answer(query); };
  return content;
}

}  // namespace wholehand
