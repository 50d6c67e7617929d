// SPDX-License-Identifier: MIT
// What shows a live session besides its lines: the view in the browser (--view) and the OSC stream (--stream).
#pragma once

#include <optional>

#include "app/commands/live_options.h"
#include "core/scene.h"
#include "device/grippers/view_gripper.h"
#include "device/run/live_run.h"
#ifdef HAS_VIEWER
#include "app/viewer/browser.h"
#include "app/viewer/live_view.h"
#include "app/viewer/osc_stream.h"
#endif

namespace wholehand {

#ifdef HAS_VIEWER
class LiveDisplays {
 public:
  // `options` must outlive the object. Throws Error (usage) for a stream to the port where the gripper listens.
  explicit LiveDisplays(const LiveOptions& options);
  // Adds those that the options ask for to the run. The view listens from here on. `input`: what the page controls, or null; it and the run must
  // outlive the object.
  void open(device::LiveRun& run, const Scene& scene, const device::GripperLimits& gripper, device::ViewInput* input);
  // The view's window, if there is a view.
  void open_window();

 private:
  void open_stream(device::LiveRun& run);
  void open_view(device::LiveRun& run, const Scene& scene, const device::GripperLimits& gripper, device::ViewInput* input);

  const LiveOptions& options_;
  std::optional<HostPort> target_;
  std::optional<LiveView> view_;
  std::optional<BrowserWindow> window_;
  std::optional<OscStream> stream_;
};
#else
struct LiveDisplays {
  explicit LiveDisplays(const LiveOptions&) {}
  void open(device::LiveRun&, const Scene&, const device::GripperLimits&, device::ViewInput*) {}
  void open_window() {}
};
#endif

}  // namespace wholehand
