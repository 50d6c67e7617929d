// SPDX-License-Identifier: MIT
#include "app/commands/live_displays.h"

#include <fmt/format.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "app/commands/open_gripper.h"
#include "app/viewer/control.h"
#include "base/files/json.h"
#include "base/system/output.h"
#include "base/system/udp.h"

namespace wholehand {
namespace {

// `stiffness`: N/m of the hand's gap.
std::string limits_json(const device::ViewLimits& limits, double stiffness) {
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

}  // namespace

LiveDisplays::LiveDisplays(const LiveOptions& options) : options_(options) {
  if (options_.stream.empty()) return;
  target_ = parse_osc_url(options_.stream);
  refuse_own_port(options_, *target_);
}

void LiveDisplays::open(device::LiveRun& run, const Scene& scene, const device::GripperLimits& gripper, device::ViewInput* input) {
  if (target_) open_stream(run);
  if (options_.view) open_view(run, scene, gripper, input);
}

void LiveDisplays::open_stream(device::LiveRun& run) {
  stream_.emplace(*target_, run.live());
  run.add(*stream_);
  if (stream_->note().empty()) return;
  print_note("live: " + stream_->note());
  run.add_note(stream_->note());
}

void LiveDisplays::open_view(device::LiveRun& run, const Scene& scene, const device::GripperLimits& gripper,
                             device::ViewInput* input) {
  ViewFacts facts;
  facts.title = scene.name;
  facts.device = gripper.name;
  facts.rate = scene.live.rate;
  facts.most_force = gripper.grip;
  std::function<void(const std::string&)> control;
  if (input) {
    facts.control_limits = limits_json(input->limits(), scene.force.k_open / input->workspace().gap_slope());
    control = [input](const std::string& body) { input->post(parse_view_control(body)); };
  }
  view_.emplace(run.live(), facts, std::move(control), options_.view_port);
  run.add(*view_);
}

void LiveDisplays::open_window() {
  if (view_) window_.emplace(view_->address(), options_.json);
}

}  // namespace wholehand
