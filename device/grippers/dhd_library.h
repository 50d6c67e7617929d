// SPDX-License-Identifier: MIT
// Loads Force Dimension's SDK at run time if it is installed. Building, and running without such a device, need nothing from the vendor.
#pragma once

#include <string>
#include <vector>

namespace wholehand::device {

// The SDK calls in use, by the vendor's names without `dhd`. Except those that return text or time, they return a negative number on failure and 0 or
// a positive one otherwise: 1 (asked again too soon, repeats the last answer) and 2 (a motor is saturated) are no errors. `id` comes from open_id.
// The prototypes are declared anew from the documentation of the SDK (3.x), https://www.forcedimension.com/sdk.
struct DhdLibrary {
  std::string path;  // as it was loaded

  int (*get_device_count)();
  void (*get_sdk_version)(int* major, int* minor, int* release, int* revision);
  int (*open_id)(char number);
  int (*close)(char id);
  int (*stop)(char id);  // no force, brakes
  const char* (*get_system_name)(char id);
  int (*get_system_type)(char id);
  int (*get_position_and_orientation_frame)(double* x, double* y, double* z, double frame[3][3], char id);  // m
  int (*get_gripper_gap)(double* gap, char id);                                                             // m
  int (*get_gripper_thumb_pos)(double* x, double* y, double* z, char id);                                   // m
  int (*get_gripper_finger_pos)(double* x, double* y, double* z, char id);                                  // m
  int (*set_force_and_torque_and_gripper_force)(double fx, double fy, double fz, double tx, double ty, double tz, double grip,
                                                char id);  // N, N m, N
  int (*enable_force)(unsigned char is_enabled, char id);
  int (*set_max_force)(double force, char id);          // N
  int (*set_max_gripper_force)(double force, char id);  // N
  int (*enable_expert_mode)();
  int (*set_watchdog)(unsigned char duration, char id);  // in units of 125 us, 0: off
  double (*get_time)();                                  // s
  const char* (*error_get_last_str)();

  // null if this release of the SDK has none
  unsigned int (*get_button_mask)(char id) = nullptr;
  int (*get_serial_number)(unsigned short* serial, char id) = nullptr;
};

// The SDK's file names, in search order, if no path is given. libdrd contains all of libdhd.
extern const std::vector<std::string> DHD_LIBRARY_NAMES;

// Loads `path` or, if it is empty, what the environment variable WHOLEHAND_DHD_LIBRARY names, or else the first existing one of `names`. An explicit
// name is never replaced by another. Stays loaded until the process ends, because a vendor's library may have threads. Throws Error (failure): the
// loader's words; or what the SDK is, where to get it and how to name its path; or the symbol that the library lacks.
DhdLibrary load_dhd_library(const std::string& path, const std::vector<std::string>& names = DHD_LIBRARY_NAMES);

}  // namespace wholehand::device
