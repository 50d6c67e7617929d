// SPDX-License-Identifier: MIT
#include "tests/support/live_script.h"

#include <algorithm>
#include <cmath>

#include "tests/support/scenes.h"

namespace wholehand {
namespace {

constexpr double STILL_FROM = 3.8, STILL_TO = 4.6, END = 7;  // s of an ordinary user: tilted and still, and done

}  // namespace

double ease(double time, double from, double to) {
  const double s = std::clamp((time - from) / (to - from), 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

Scene live_scene() {
  Scene scene = scene_of({beaker1(), beaker3()});
  scene.vessels[0].liquid_name = "water";
  scene.vessels[0].liquid_fill = 0.5;
  scene.vessels[0].place = {0.02, 0.01, -0.03};
  scene.vessels[1].place = {0.4, 0, 0.3};
  scene.liquid = LiquidData{};
  scene.liquid->fills = {0, 0.5, 1};
  scene.task = TaskData{};
  scene.task->target_place = {0.02, 0.05, -0.10};
  scene.task->target_diameter = 0.05;
  scene.task->amounts = {{"water", 200e-6}};
  scene.task->tolerance = 20e-6;
  scene.task->destination = {0.4, 0.1, 0};
  return scene;
}

std::array<double, 2> own_gap(const HandData& hand) {
  const core_f64::Hand ready = ready_hand(hand);
  return {ready.scale * ready.gap_closed, ready.scale * ready.gap_open};
}

wholehand::Rotation turned(char axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  if (axis == 'x') return {1, 0, 0, 0, c, -s, 0, s, c};
  if (axis == 'y') return {c, 0, s, 0, 1, 0, -s, 0, c};
  return {c, -s, 0, s, c, 0, 0, 0, 1};
}

wholehand::Rotation product(const wholehand::Rotation& a, const wholehand::Rotation& b) {
  wholehand::Rotation result{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) result[3 * i + j] += a[3 * i + k] * b[3 * k + j];
  return result;
}

double LiveScript::pause() const { return std::max((STILL_TO - STILL_FROM) / hurry, 0.7); }

double LiveScript::seconds() const { return (END - (STILL_TO - STILL_FROM)) / hurry + pause(); }

device::GripperState LiveScript::at(std::int64_t tick) const {
  const double so_far = static_cast<double>(tick) / rate, still = STILL_FROM / hurry;
  const double time = so_far < still             ? hurry * so_far
                      : so_far < still + pause() ? STILL_FROM + (so_far - still) * (STILL_TO - STILL_FROM) / pause()
                                                 : STILL_TO + hurry * (so_far - still - pause());
  // off the middle, so that one tip touches before the other; to 4 mm inside of the beaker's 80
  const double close = ease(time, 0.3, 1.3), open = ease(time, 5.6, 6.2);
  device::GripperState state;
  state.gap = 0.127 + (0.091 - 0.127) * close + (0.125 - 0.091) * open;
  const double lift = 0.15 * ease(time, 1.5, 2.2);
  const wholehand::Rotation heading = turned('y', azimuth);
  const double aside = 3e-3 * (1 - ease(time, 0.9, 1.4));
  state.position = {vessel[0] + aside * heading[0], vessel[1] + height + lift, vessel[2] + aside * heading[6]};
  // about the line through the tips, away from the palm
  const double turn = tilt * (ease(time, 2.3, 3.8) - ease(time, 4.6, 5.5));
  state.rotation = product(heading, turned('x', -turn));
  state.sequence = static_cast<std::uint32_t>(tick + 1);
  state.time = static_cast<double>(tick) / rate;
  return state;
}

}  // namespace wholehand
