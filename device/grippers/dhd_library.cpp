// SPDX-License-Identifier: MIT
#include "device/grippers/dhd_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "base/text/error.h"
#include "base/text/text.h"

namespace wholehand::device {

const std::vector<std::string> DHD_LIBRARY_NAMES{"libdhd.so.3", "libdhd.so", "libdrd.so.3", "libdrd.so"};

namespace {

Error is_unusable(const std::string& why) {
  return failure_error(why + "; get it from https://www.forcedimension.com/software/sdk and name its path", Remedy::name_library);
}

struct Loaded {
  void* handle = nullptr;
  std::string path;
  std::string problem;  // the loader's words, one line; empty if there is a handle
};

// Whether a path, not a bare name, leads to something that is no file: the loader would wait for a pipe without end.
bool is_no_file(const std::string& path) {
  std::error_code absent;
  return path.find('/') != std::string::npos && std::filesystem::exists(path, absent) &&
         !std::filesystem::is_regular_file(path, absent);
}

Loaded load(const std::string& path) {
  if (is_no_file(path)) return {nullptr, path, path + ": is no file but a folder, device or pipe"};
  Loaded loaded{dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL), path, ""};
  if (loaded.handle) return loaded;
  const char* words = dlerror();
  loaded.problem = words ? words : "no reason given";
  std::replace(loaded.problem.begin(), loaded.problem.end(), '\n', ' ');
  return loaded;
}

// `from` tells who named the path.
Loaded load_named(const std::string& path, const std::string& from) {
  Loaded loaded = load(path);
  if (!loaded.handle) throw is_unusable(fmt::format("cannot load Force Dimension's SDK{}: {}", from, loaded.problem));
  return loaded;
}

Loaded load_first(const std::vector<std::string>& names) {
  std::string reason;
  for (const std::string& name : names) {
    Loaded loaded = load(name);
    if (loaded.handle) return loaded;
    // one that is there and does not load says more than one that is not there
    const bool is_absent = loaded.problem.rfind(name + ": cannot open shared object file", 0) == 0;
    if (!is_absent && reason.empty()) reason = loaded.problem;
  }
  if (!reason.empty()) throw is_unusable("cannot load Force Dimension's SDK: " + reason);
  throw is_unusable(fmt::format("Force Dimension's SDK is not there (looked for {})", joined(names, ", ")));
}

template <class Function>
bool find_symbol(const Loaded& loaded, const char* symbol, Function*& function) {
  function = reinterpret_cast<Function*>(dlsym(loaded.handle, symbol));
  return function != nullptr;
}

template <class Function>
void need_symbol(const Loaded& loaded, const char* symbol, Function*& function) {
  if (find_symbol(loaded, symbol, function)) return;
  throw is_unusable(
      fmt::format("{} lacks the function {}: it is not Force Dimension's SDK, or too old a release", loaded.path, symbol));
}

}  // namespace

DhdLibrary load_dhd_library(const std::string& path, const std::vector<std::string>& names) {
  const char* variable = std::getenv("WHOLEHAND_DHD_LIBRARY");
  Loaded loaded;
  if (!path.empty()) {
    loaded = load_named(path, "");
  } else if (variable && *variable) {
    loaded = load_named(variable, " (named by WHOLEHAND_DHD_LIBRARY)");
  } else {
    loaded = load_first(names);
  }

  DhdLibrary dhd{};
  dhd.path = loaded.path;
  need_symbol(loaded, "dhdGetDeviceCount", dhd.get_device_count);
  need_symbol(loaded, "dhdGetSDKVersion", dhd.get_sdk_version);
  need_symbol(loaded, "dhdOpenID", dhd.open_id);
  need_symbol(loaded, "dhdClose", dhd.close);
  need_symbol(loaded, "dhdStop", dhd.stop);
  need_symbol(loaded, "dhdGetSystemName", dhd.get_system_name);
  need_symbol(loaded, "dhdGetSystemType", dhd.get_system_type);
  need_symbol(loaded, "dhdGetPositionAndOrientationFrame", dhd.get_position_and_orientation_frame);
  need_symbol(loaded, "dhdGetGripperGap", dhd.get_gripper_gap);
  need_symbol(loaded, "dhdGetGripperThumbPos", dhd.get_gripper_thumb_pos);
  need_symbol(loaded, "dhdGetGripperFingerPos", dhd.get_gripper_finger_pos);
  need_symbol(loaded, "dhdSetForceAndTorqueAndGripperForce", dhd.set_force_and_torque_and_gripper_force);
  need_symbol(loaded, "dhdEnableForce", dhd.enable_force);
  need_symbol(loaded, "dhdSetMaxForce", dhd.set_max_force);
  need_symbol(loaded, "dhdSetMaxGripperForce", dhd.set_max_gripper_force);
  need_symbol(loaded, "dhdEnableExpertMode", dhd.enable_expert_mode);
  need_symbol(loaded, "dhdSetWatchdog", dhd.set_watchdog);
  need_symbol(loaded, "dhdGetTime", dhd.get_time);
  need_symbol(loaded, "dhdErrorGetLastStr", dhd.error_get_last_str);
  find_symbol(loaded, "dhdGetButtonMask", dhd.get_button_mask);
  find_symbol(loaded, "dhdGetSerialNumber", dhd.get_serial_number);
  return dhd;
}

}  // namespace wholehand::device
