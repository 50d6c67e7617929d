// SPDX-License-Identifier: MIT
#include "app/viewer/live_view.h"

#include <utility>

namespace wholehand {

LiveView::LiveView(const device::LiveScene& live, const ViewFacts& facts, std::function<void(const std::string&)> control, int port)
    : live_(live), maker_(live), frames_(MOST_VIEWERS) {
  ViewContent content;
  content.scene = view_scene_json(live.scene, facts);
  for (const VesselData& vessel : live.scene.vessels) content.meshes.push_back(mesh_bytes(vessel));
  content.frames = &frames_;
  content.control = std::move(control);
  server_ = std::make_unique<ViewServer>(std::move(content), port);
}

void LiveView::show(const device::DisplayMoment& moment) noexcept {
  try {
    ViewFrame frame = maker_.make(moment.tick, moment.poses, moment.hand, moment.timing);
    if (moment.advice && moment.advice->vessel >= 0) frame.advice = frame_advice(live_.scene, *moment.advice, moment.poses);
    frames_.publish(frame_json(frame));
  } catch (...) {  // no memory for this frame; the next one comes
  }
}

void LiveView::end(const std::string& reason) {
  frames_.close(reason);
  server_->stop();
}

}  // namespace wholehand
