// SPDX-License-Identifier: MIT
// A recorded session in the browser, at any moment.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/viewer/frame.h"
#include "app/viewer/server.h"
#include "device/recordings/recording.h"

namespace wholehand {

constexpr int MOST_RECORDED_FRAMES = 600;  // in one answer

// From any thread.
class RecordingView {
 public:
  // The scene that was recorded, its meshes read. Throws Error (usage): no ticks, or a scene that cannot be live.
  RecordingView(const Scene& scene, device::Recording recording);

  double duration() const;  // s, to the end of the last tick
  // Frames at `from`, `from` + 1 / `rate`, .. up to `to`, s: each of the newest tick by then, or the first if there is none yet.
  std::vector<ViewFrame> frames(double from, double to, double rate) const;
  // scene.json and recording of it, for a server, which must not outlive this.
  ViewContent content(const std::string& title) const;

 private:
  std::size_t tick_by(double time) const;
  device::DisplayTiming timing_of(std::size_t tick) const;
  std::string answer(const ViewContent::Query& query) const;

  device::Recording recording_;
  device::LiveScene live_;
  device::VesselHistory history_;
};

}  // namespace wholehand
