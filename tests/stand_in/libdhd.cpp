// SPDX-License-Identifier: MIT
// A stand-in for Force Dimension's SDK: the documented functions, which do what a test has set and remember what was asked of them.
// As the SDK's, they may be called from several threads.
#include <mutex>
#include <string>

#include "tests/stand_in/dhd_control.h"

namespace {

StandInDhd& control() {
  static StandInDhd stand_in;
  return stand_in;
}

std::mutex& mutex() {
  static std::mutex of_what_is_remembered;
  return of_what_is_remembered;
}

void hook(const char* function) {
  const auto found = control().hooks.find(function);
  if (found != control().hooks.end()) found->second();
}

int code(const char* function) {
  const auto found = control().codes.find(function);
  return found == control().codes.end() ? 0 : found->second;
}

// Remembers the call and gives what it is to return.
int called(const char* function) {
  const std::lock_guard lock(mutex());
  control().calls.push_back(function);
  return code(function);
}

const StandInPose& pose() {
  static const StandInPose rest;
  const StandInDhd& stand_in = control();
  if (stand_in.motion.empty()) return rest;
  const std::size_t read = stand_in.reads > 0 ? stand_in.reads - 1 : 0;
  return stand_in.motion[read < stand_in.motion.size() ? read : stand_in.motion.size() - 1];
}

int give(const std::array<double, 3>& place, double* x, double* y, double* z, const char* function) {
  *x = place[0];
  *y = place[1];
  *z = place[2];
  return code(function);
}

}  // namespace

extern "C" {

StandInDhd* stand_in_dhd() { return &control(); }

int dhdGetDeviceCount() { return static_cast<int>(control().types.size()); }
int dhdOpenID(char number) {
  hook("dhdOpenID");
  const int result = called("dhdOpenID");
  if (result < 0) return result;
  control().opened.push_back(number);
  return number;
}
int dhdOpen() { return dhdOpenID(0); }
int dhdClose(char id) {
  hook("dhdClose");
  control().closed.push_back(id);
  return called("dhdClose");
}
int dhdStop(char) {
  hook("dhdStop");
  return called("dhdStop");
}

const char* dhdGetSystemName(char) { return control().name.c_str(); }
void dhdGetSDKVersion(int* major, int* minor, int* release, int* revision) {
  *major = 3;
  *minor = 17;
  *release = 6;
  *revision = 0;
}
int dhdGetSystemType(char id) {
  const auto& types = control().types;
  const auto device = static_cast<std::size_t>(id);
  return device < types.size() ? types[device] : -1;
}

int dhdGetSerialNumber(unsigned short* serial, char id) {
  const auto device = static_cast<std::size_t>(id);
  if (device >= control().serials.size()) return -1;
  *serial = control().serials[device];
  return code("dhdGetSerialNumber");
}

int dhdGetPositionAndOrientationFrame(double* x, double* y, double* z, double frame[3][3], char) {
  hook("dhdGetPositionAndOrientationFrame");
  ++control().reads;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) frame[row][column] = pose().frame[row][column];
  }
  return give(pose().position, x, y, z, "dhdGetPositionAndOrientationFrame");
}
int dhdGetGripperAngleRad(double* angle, char) {
  *angle = 0;
  return code("dhdGetGripperAngleRad");
}
int dhdGetGripperGap(double* gap, char) {
  *gap = pose().gap;
  return code("dhdGetGripperGap");
}
int dhdGetGripperThumbPos(double* x, double* y, double* z, char) { return give(pose().thumb, x, y, z, "dhdGetGripperThumbPos"); }
int dhdGetGripperFingerPos(double* x, double* y, double* z, char) { return give(pose().finger, x, y, z, "dhdGetGripperFingerPos"); }
unsigned int dhdGetButtonMask(char) { return control().buttons; }

int dhdSetForceAndTorqueAndGripperForce(double fx, double fy, double fz, double tx, double ty, double tz, double grip, char) {
  hook("dhdSetForceAndTorqueAndGripperForce");
  {
    const std::lock_guard lock(mutex());
    control().forces.push_back({fx, fy, fz, tx, ty, tz, grip});
    if (control().on_force) control().on_force(control().forces.back());
  }
  return called("dhdSetForceAndTorqueAndGripperForce");
}
int dhdEnableForce(unsigned char is_enabled, char) {
  hook("dhdEnableForce");
  control().calls.push_back(is_enabled ? "dhdEnableForce 1" : "dhdEnableForce 0");
  return is_enabled ? code("dhdEnableForce") : 0;
}
int dhdSetMaxForce(double force, char) {
  control().max_force = force;
  return called("dhdSetMaxForce");
}
int dhdSetMaxGripperForce(double force, char) {
  control().max_gripper_force = force;
  return called("dhdSetMaxGripperForce");
}
int dhdEnableExpertMode() { return called("dhdEnableExpertMode"); }
#ifndef STAND_IN_LACKS_WATCHDOG
int dhdSetWatchdog(unsigned char duration, char) {
  control().watchdog = duration;
  return called("dhdSetWatchdog");
}
#endif

double dhdGetComFreq(char) { return 1; }
double dhdGetTime() { return 1e-3 * static_cast<double>(control().reads); }
const char* dhdErrorGetLastStr() { return control().error.c_str(); }
}
