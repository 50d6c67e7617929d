// SPDX-License-Identifier: MIT
// The stand-in for Haply's Inverse Service as a program: for benchmarks, and to try a session without a device.
//
//   stand_in_haply_service [--port N] [--grip] [--fault NAME AFTER_S] [--play FILE]
//
// prints its port, and runs until its input ends. The devices move first, then rest for the calibration, and begin to open the hand at 2 s. FILE has
// lines of time since then, position of the hand, direction from left to right tip (device frame), and gap, all in SI, 8 numbers each.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/stand_in/haply_service.h"

namespace {

using wholehand::stand_in::HaplyFault;
using wholehand::stand_in::HaplyMotion;

constexpr double TRAVEL_END = 0.5, REST_END = 2;  // s
constexpr const char* FAULTS[] = {"none",     "silent",  "flood", "no_json", "no_state",  "no_number", "no_finite",
                                  "vanished", "foreign", "split", "closed",  "skips_one", "halves"};

struct Pose {
  double time = 0, x = 0, y = 0, z = 0, along_x = 1, along_y = 0, along_z = 0, gap = 0;
};

HaplyMotion tips_of(const Pose& pose) {
  HaplyMotion motion;
  for (int side = 0; side < 2; ++side) {
    const double half = (side == 0 ? -0.5 : 0.5) * pose.gap;
    motion.cursors[static_cast<std::size_t>(side)] = {pose.x + half * pose.along_x, -(pose.z + half * pose.along_z),
                                                      pose.y + half * pose.along_y};
  }
  return motion;
}

Pose open_and_wave(double time) {
  constexpr double OPEN = 0.08;  // m
  Pose pose;
  pose.x = 0.05 * std::sin(time);
  pose.y = 0.03 * std::sin(1.7 * time);
  pose.gap = OPEN * std::min(1.0, time) * (0.75 + 0.25 * std::cos(2 * time));
  return pose;
}

Pose played(const std::vector<Pose>& poses, double time) {
  const auto next = std::find_if(poses.begin(), poses.end(), [time](const Pose& pose) { return pose.time > time; });
  if (next == poses.begin()) return poses.front();
  if (next == poses.end()) return poses.back();
  const Pose &a = *(next - 1), &b = *next;
  const double t = (time - a.time) / (b.time - a.time);
  const auto between = [t](double from, double to) { return from + t * (to - from); };
  return {time,
          between(a.x, b.x),
          between(a.y, b.y),
          between(a.z, b.z),
          between(a.along_x, b.along_x),
          between(a.along_y, b.along_y),
          between(a.along_z, b.along_z),
          between(a.gap, b.gap)};
}

std::vector<Pose> read_poses(const char* path) {
  std::ifstream file(path);
  std::vector<Pose> poses;
  for (Pose p; file >> p.time >> p.x >> p.y >> p.z >> p.along_x >> p.along_y >> p.along_z >> p.gap;) poses.push_back(p);
  return poses;
}

}  // namespace

int main(int count, char** arguments) {
  wholehand::stand_in::HaplyOptions options;
  std::vector<Pose> poses;
  HaplyFault fault = HaplyFault::none;
  double fault_time = 0;
  for (int k = 1; k < count; ++k) {
    const std::string name = arguments[k];
    if (name == "--port" && k + 1 < count) {
      options.port = std::atoi(arguments[++k]);
    } else if (name == "--grip") {
      options.sides = {"right"};
      options.has_grip = true;
    } else if (name == "--play" && k + 1 < count) {
      poses = read_poses(arguments[++k]);
    } else if (name == "--fault" && k + 2 < count) {
      const auto found = std::find(std::begin(FAULTS), std::end(FAULTS), std::string(arguments[k + 1]));
      fault = static_cast<HaplyFault>(found == std::end(FAULTS) ? 0 : found - std::begin(FAULTS));
      fault_time = std::atof(arguments[k + 2]);
      k += 2;
    } else {
      std::fprintf(stderr, "unknown: %s\n", name.c_str());
      return 2;
    }
  }
  wholehand::stand_in::HaplyService service(options);
  service.move([&](double time) {
    if (fault != HaplyFault::none && time > fault_time) service.misbehave_within(fault);
    if (time < TRAVEL_END) return tips_of({time, 0.03 * std::sin(time / TRAVEL_END * 3.14159265358979)});
    if (time < REST_END) return tips_of({});
    HaplyMotion motion = tips_of(poses.empty() ? open_and_wave(time - REST_END) : played(poses, time - REST_END));
    motion.is_pressed = std::fmod(time, 2.0) < 1;
    return motion;
  });
  std::printf("%d\n", service.port());
  std::fflush(stdout);
  while (std::getchar() != EOF) {
  }
  return 0;
}
