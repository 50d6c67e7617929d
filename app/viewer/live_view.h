// SPDX-License-Identifier: MIT
// A live session in the browser: frames of its moments, and the server that delivers them.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "app/viewer/frame.h"
#include "app/viewer/scene.h"
#include "app/viewer/server.h"

namespace wholehand {

class LiveView final : public device::Display {
 public:
  // `live` must outlive it. `control` takes the page's posts if the page is the gripper; else empty. Throws Error as ViewServer does.
  LiveView(const device::LiveScene& live, const ViewFacts& facts, std::function<void(const std::string&)> control, int port);

  const std::string& address() const { return server_->address(); }
  bool is_watched() override { return frames_.viewers() > 0; }
  void show(const device::DisplayMoment& moment) noexcept override;
  // Tells viewers why there are no more frames, and ends the server.
  void end(const std::string& reason) override;

 private:
  const device::LiveScene& live_;
  FrameMaker maker_;
  FrameHub frames_;
  std::unique_ptr<ViewServer> server_;  // declared last: it uses the frames
};

}  // namespace wholehand
