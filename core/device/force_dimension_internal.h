#pragma once

#include <string>

#include "core/base/dynamic_library.h"
#include "core/device/force_dimension.h"

// The vendor's library; for the files of this driver alone.
namespace haptrial::device {

/// Loads libdrd.so.3, or else libdhd.so.3. @param library  a path in place of the search
/// @throws InputError when it is missing
DynamicLibrary open_force_dimension_library(const std::string& library);

/// The functions of the vendor's library that are used here.
struct ForceDimensionDevice::Api {
  explicit Api(const std::string& path);

  DynamicLibrary library;
  int (*count)();
  int (*open)(char);
  int (*close)(char);
  const char* (*system_name)(char);
  int (*system_type)(char);  // null in old libraries
  int (*enable_force)(unsigned char, char);
  int (*stop)(char);
  int (*set_effector_mass)(double, char);
  int (*set_gravity_compensation)(int, char);
  int (*get_position)(double*, double*, double*, char);
  int (*config_linear_velocity)(int, int, char);
  int (*get_linear_velocity)(double*, double*, double*, char);
  int (*set_force)(double, double, double, char);
  unsigned (*get_button_mask)(char);
  bool (*has_wrist)(char);  // null in libraries before 3
  int (*get_orientation)(double (*)[3], char);
  // Null in libraries that know no motors of a wrist or gripper.
  bool (*has_active_wrist)(char);
  int (*get_angular_velocity)(double*, double*, double*, char);
  int (*config_angular_velocity)(int, int, char);
  int (*set_max_torque)(double, char);
  bool (*has_active_gripper)(char);
  int (*get_gripper_gap)(double*, char);
  int (*get_gripper_velocity)(double*, char);
  int (*config_gripper_velocity)(int, int, char);
  int (*set_max_gripper_force)(double, char);
  int (*set_wrench)(double, double, double, double, double, double, double, char);
  int (*get_status)(int*, char);
  int (*set_max_force)(double, char);
  int (*enable_expert_mode)();
  int (*disable_expert_mode)();
  int (*set_time_guard)(int, char);
  int (*set_watchdog)(unsigned char, char);
  int (*set_velocity_threshold)(unsigned, char);
  int (*last_error)();
  // Null where DRD is not installed.
  int (*drd_open)(char);
  int (*drd_close)(char);
  bool (*drd_is_supported)(char);
  bool (*drd_is_initialized)(char);
  int (*drd_auto_init)(char);
  int (*drd_stop)(bool, char);

  bool has_drd() const noexcept {
    return drd_open && drd_close && drd_is_supported && drd_is_initialized && drd_auto_init &&
           drd_stop;
  }
  bool knows_torque() const noexcept {
    return has_active_wrist && get_orientation && get_angular_velocity && config_angular_velocity &&
           set_max_torque && set_wrench;
  }
  bool knows_grip() const noexcept {
    return has_active_gripper && get_gripper_gap && get_gripper_velocity &&
           config_gripper_velocity && set_max_gripper_force && set_wrench;
  }
};

}  // namespace haptrial::device
