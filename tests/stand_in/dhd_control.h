// SPDX-License-Identifier: MIT
// What a test sets and sees of the stand-in for Force Dimension's SDK (libdhd.cpp), which it finds by the symbol `stand_in_dhd`.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <string>
#include <vector>

struct StandInPose {
  std::array<double, 3> position{}, thumb{}, finger{};  // m
  std::array<std::array<double, 3>, 3> frame{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  double gap = 0;  // m
};

struct StandInDhd {
  // ---- what the library does ----
  std::vector<int> types{35};         // of each device, as dhdGetSystemType gives it
  std::string name = "omega.7";       // of every device
  std::vector<StandInPose> motion{};  // a pose a read; then the last one stays
  std::map<std::string, int> codes;   // what a function returns, by its name; 0 where there is none
  std::string error = "no error";     // dhdErrorGetLastStr
  unsigned int buttons = 0;
  std::vector<unsigned short> serials{4001, 4002};       // of the first devices; others have none
  std::map<std::string, std::function<void()>> hooks{};  // called first by the function of that name, on the caller's thread
  std::function<void(const std::array<double, 7>&)> on_force{};  // called last where a force is set

  // ---- what was done to it ----
  std::vector<std::string> calls;             // in order, without queries
  std::vector<std::array<double, 7>> forces;  // force, torque, gripper force
  std::vector<int> opened, closed;            // numbers
  double max_force = -1, max_gripper_force = -1;
  int watchdog = -1;
  std::size_t reads = 0;
};
