#include "core/base/error.h"
#include "core/device/force_dimension_internal.h"

namespace haptrial::device {
namespace {

constexpr const char* kForceDimensionFrom =
    "the Force Dimension SDK, from https://www.forcedimension.com/software/sdk";

}  // namespace

DynamicLibrary open_force_dimension_library(const std::string& library) {
  if (!library.empty()) {
    return {library, kForceDimensionFrom};
  }
  // libdrd brings the DHD functions with it. Two libraries side by side might not share their
  // devices, so that all functions come from one.
  try {
    return {"libdrd.so.3", kForceDimensionFrom};
  } catch (const InputError&) {
    return {"libdhd.so.3", kForceDimensionFrom};
  }
}

ForceDimensionDevice::Api::Api(const std::string& path)
    : library(open_force_dimension_library(path)) {
  library.get(count, "dhdGetDeviceCount");
  library.get(open, "dhdOpenID");
  library.get(close, "dhdClose");
  library.get(system_name, "dhdGetSystemName");
  library.get(enable_force, "dhdEnableForce");
  library.get(stop, "dhdStop");
  library.get(set_effector_mass, "dhdSetEffectorMass");
  library.get(set_gravity_compensation, "dhdSetGravityCompensation");
  library.get(get_position, "dhdGetPosition");
  library.get(config_linear_velocity, "dhdConfigLinearVelocity");
  library.get(get_linear_velocity, "dhdGetLinearVelocity");
  library.get(set_force, "dhdSetForce");
  library.get(get_button_mask, "dhdGetButtonMask");
  library.get(get_status, "dhdGetStatus");
  library.get(set_max_force, "dhdSetMaxForce");
  library.get(enable_expert_mode, "dhdEnableExpertMode");
  library.get(disable_expert_mode, "dhdDisableExpertMode");
  library.get(set_time_guard, "dhdSetTimeGuard");
  library.get(set_watchdog, "dhdSetWatchdog");
  library.get(set_velocity_threshold, "dhdSetVelocityThreshold");
  library.get(last_error, "dhdErrorGetLast");
  library.find(system_type, "dhdGetSystemType");
  library.find(has_wrist, "dhdHasWrist");
  library.find(get_orientation, "dhdGetOrientationFrame");
  library.find(has_active_wrist, "dhdHasActiveWrist");
  library.find(get_angular_velocity, "dhdGetAngularVelocityRad");
  library.find(config_angular_velocity, "dhdConfigAngularVelocity");
  library.find(set_max_torque, "dhdSetMaxTorque");
  library.find(has_active_gripper, "dhdHasActiveGripper");
  library.find(get_gripper_gap, "dhdGetGripperGap");
  library.find(get_gripper_velocity, "dhdGetGripperLinearVelocity");
  library.find(config_gripper_velocity, "dhdConfigGripperVelocity");
  library.find(set_max_gripper_force, "dhdSetMaxGripperForce");
  library.find(set_wrench, "dhdSetForceAndTorqueAndGripperForce");
  library.find(drd_open, "drdOpenID");
  library.find(drd_close, "drdClose");
  library.find(drd_is_supported, "drdIsSupported");
  library.find(drd_is_initialized, "drdIsInitialized");
  library.find(drd_auto_init, "drdAutoInit");
  library.find(drd_stop, "drdStop");
}

}  // namespace haptrial::device
