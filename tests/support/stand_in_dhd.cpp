// A stand-in for Force Dimension's DHD library: its C functions, over a simulated handle. One
// period of 1 ms passes with every force that is set.

#include <time.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <limits>

#include "tests/support/stand_in_dhd.h"
#include "tests/support/stand_in_record.h"

using haptrial::test::Failure;
using haptrial::test::StandInHandle;
using haptrial::test::StandInSetup;
using haptrial::test::StandInView;

namespace haptrial::test {
StandInHandle dhd_handle;
int dhd_error = 0;
}  // namespace haptrial::test

namespace {

constexpr double kPeriod = 1e-3;      // [s]
constexpr double kMotorsGive = 12.0;  // [N] on an axis
constexpr int kNoDevice = 5;          // numbers of errors
constexpr int kCommunication = 2;
constexpr int kTimeout = 7;
constexpr int kExpertModeDisabled = 9;
constexpr int kNotReady = 12;

StandInHandle& handle = haptrial::test::dhd_handle;
bool expert = false;
haptrial::test::ForceRecord forces;
haptrial::test::FailureFromEnvironment told;

int failed(int error) {
  haptrial::test::dhd_error = error;
  return -1;
}

int setting(const char* name, bool needs_expert = false) {
  if (needs_expert && !expert) {
    return failed(kExpertModeDisabled);
  }
  handle.note(name);
  return handle.open ? 0 : failed(kNoDevice);
}

int link() {
  if (!handle.open || handle.fails(Failure::kLostLink)) {
    return failed(kCommunication);
  }
  return handle.fails(Failure::kTimeout) ? failed(kTimeout) : 0;
}

int force_off_cause() {
  return handle.fails(Failure::kForcesOffByButton)     ? 1
         : handle.fails(Failure::kForcesOffByVelocity) ? 2
         : handle.fails(Failure::kForcesOffByWatchdog) ? 3
                                                       : 0;
}

}  // namespace

extern "C" {

void stand_in_reset() {
  handle = {};
  expert = false;
}
void stand_in_fail(int failure, long tick) {
  handle.failure = static_cast<Failure>(failure);
  handle.failure_tick = tick;
}
void stand_in_place(const double* p) { handle.place(p); }
void stand_in_turn(const double* rows) {
  std::copy_n(rows, 9, handle.turn.begin());
  handle.wrist = true;
}
void stand_in_activate() { handle.active = handle.wrist = true; }
void stand_in_buttons(unsigned mask) { handle.buttons = mask; }
void stand_in_view(StandInView* out) { handle.view(out, 1.0); }
void stand_in_setup(StandInSetup* out) { *out = handle.setup; }

int dhdGetDeviceCount() { return handle.fails(Failure::kNoDevice) ? 0 : 1; }
int dhdErrorGetLast() { return haptrial::test::dhd_error; }
const char* dhdGetSystemName(char) { return "omega.3"; }
int dhdGetSystemType(char) { return 33; }

int dhdOpenID(char index) {
  if (index != 0 || handle.fails(Failure::kNoDevice)) {
    return failed(kNoDevice);
  }
  handle.open = true;
  if (std::getenv("STAND_IN_ACTIVE") != nullptr) {
    stand_in_activate();
  }
  handle.note("dhdOpen");
  return 0;
}
int dhdClose(char) {
  handle.note("dhdClose");
  handle.open = handle.forces_on = false;
  return 0;
}
int dhdStop(char) { return setting("stop"); }

int dhdEnableForce(unsigned char on, char) {
  handle.forces_on = on != 0;
  return setting(on != 0 ? "force_on" : "force_off");
}
int dhdSetEffectorMass(double kg, char) {
  handle.setup.effector_mass = kg;
  return setting("mass");
}
int dhdSetGravityCompensation(int on, char) {
  handle.setup.gravity = on;
  return setting("gravity");
}
int dhdConfigLinearVelocity(int ms, int mode, char) {
  handle.setup.window_ms = ms;
  handle.setup.window_mode = mode;
  return setting("window");
}
int dhdSetMaxForce(double newton, char) {
  handle.setup.max_force = newton;
  return setting("max_force");
}
int dhdEnableExpertMode() {
  expert = true;
  return 0;
}
int dhdDisableExpertMode() {
  expert = false;
  return setting("expert_off");
}
int dhdSetTimeGuard(int us, char) {
  handle.setup.time_guard_us = us;
  return setting("time_guard", true);
}
int dhdSetWatchdog(unsigned char value, char) {
  handle.setup.watchdog = value;
  return setting("watchdog", true);
}
int dhdSetVelocityThreshold(unsigned value, char) {
  handle.setup.threshold = static_cast<int>(value);
  return setting("threshold", true);
}

int dhdGetPosition(double* x, double* y, double* z, char) {
  if (link() < 0) {
    return -1;
  }
  if (handle.fails(Failure::kSlowCall)) {
    const timespec pause{0, 5'000'000};
    nanosleep(&pause, nullptr);
  }
  if (handle.fails(Failure::kCrash)) {
    ::raise(SIGSEGV);
  }
  while (handle.fails(Failure::kHang)) {
    ::pause();
  }
  const bool not_finite = handle.fails(Failure::kNotFinite);
  *x = not_finite ? std::numeric_limits<double>::quiet_NaN() : handle.position[0];
  *y = handle.position[1] + (handle.fails(Failure::kJump) ? 0.02 : 0.0);
  *z = handle.position[2];
  return handle.fails(Failure::kTimeGuard) ? 1 : 0;
}
int dhdGetLinearVelocity(double* x, double* y, double* z, char) {
  if (link() < 0) {
    return -1;
  }
  *x = handle.velocity[0];
  *y = handle.velocity[1];
  *z = handle.velocity[2];
  return 0;
}
int dhdSetForce(double x, double y, double z, char) {
  if (link() < 0) {
    return -1;
  }
  if (handle.fails(Failure::kForceRefused)) {
    return failed(kNotReady);
  }
  const double asked[3] = {x, y, z};
  constexpr double kWatchdogStep = 125e-6;  // [s]
  forces.add({x, y, z}, kWatchdogStep * handle.setup.watchdog);
  if (told.begins(std::hypot(x, y, z))) {
    stand_in_fail(told.number(), handle.ticks);
  }
  bool saturated = handle.fails(Failure::kSaturated);
  for (std::size_t i = 0; i < 3; ++i) {
    handle.force[i] = std::clamp(asked[i], -kMotorsGive, kMotorsGive);
    saturated = saturated || handle.force[i] != asked[i];
  }
  handle.forces_on = handle.forces_on && force_off_cause() == 0;
  handle.step(kPeriod);
  handle.forces_on = handle.forces_on && force_off_cause() == 0;
  return saturated ? 2 : 0;
}
bool dhdHasWrist(char) { return handle.wrist; }
bool dhdHasActiveWrist(char) { return handle.active; }
bool dhdHasActiveGripper(char) { return handle.active; }
int dhdConfigAngularVelocity(int ms, int, char) {
  handle.setup.angular_window_ms = ms;
  return setting("angular_window");
}
int dhdConfigGripperVelocity(int ms, int, char) {
  handle.setup.gripper_window_ms = ms;
  return setting("gripper_window");
}
int dhdSetMaxTorque(double torque, char) {
  handle.setup.max_torque = torque;
  return setting("max_torque");
}
int dhdSetMaxGripperForce(double force, char) {
  handle.setup.max_grip_force = force;
  return setting("max_grip");
}
int dhdGetAngularVelocityRad(double* x, double* y, double* z, char) {
  *x = handle.spin[0];
  *y = handle.spin[1];
  *z = handle.spin[2];
  return link();
}
int dhdGetGripperGap(double* gap, char) {
  *gap = handle.gap;
  return link();
}
int dhdGetGripperLinearVelocity(double* speed, char) {
  *speed = handle.gap_speed;
  return link();
}
int dhdSetForceAndTorqueAndGripperForce(double x, double y, double z, double tx, double ty,
                                        double tz, double grip, char id) {
  handle.torque = {tx, ty, tz};
  handle.grip = grip;
  return dhdSetForce(x, y, z, id);
}
int dhdGetOrientationFrame(double (*rows)[3], char) {
  if (link() < 0) {
    return -1;
  }
  for (std::size_t i = 0; i < 9; ++i) {
    rows[i / 3][i % 3] = handle.turn[i];
  }
  return 0;
}
unsigned dhdGetButtonMask(char) {
  return handle.buttons | (handle.fails(Failure::kButton) ? 1u : 0u);
}
int dhdGetStatus(int* status, char) {
  std::fill_n(status, 17, 0);
  status[0] = status[1] = status[2] = 1;
  status[5] = handle.forces_on ? 1 : 0;
  status[14] = force_off_cause();
  return 17;
}

}  // extern "C"
