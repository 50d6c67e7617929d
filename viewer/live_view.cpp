// SPDX-License-Identifier: MIT
#include "viewer/live_view.h"

#include <utility>

namespace wholehand {

LiveView::LiveView(const LiveScene& live, const ViewFacts& facts, std::function<void(const std::string&)> control, int port)
    : maker_(live), frames_(MOST_VIEWERS) {
  ViewContent content;
  content.scene = view_scene_json(live.scene, facts);
  for (const VesselData& vessel : live.scene.vessels) content.meshes.push_back(mesh_bytes(vessel));
  content.frames = &frames_;
  content.control = std::move(control);
  server_ = std::make_unique<ViewServer>(std::move(content), port);
}

void LiveView::show(const DisplayMoment& moment) noexcept {
  try {
    frames_.publish(frame_json(maker_.make(moment.tick, moment.poses, moment.hand, moment.timing)));
  } catch (...) {  // no memory for this frame; the next one comes
  }
}

void LiveView::end(const std::string& reason) {
  frames_.close(reason);
  server_->stop();
}

}  // namespace wholehand
