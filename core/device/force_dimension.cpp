#include "core/device/force_dimension.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/device/force_dimension_internal.h"

namespace haptrial::device {
namespace {

constexpr double kWatchdogStep = 125e-6;  // [s]
constexpr double kLongestWatchdog = 255 * kWatchdogStep;
constexpr unsigned char kOn = 1;
constexpr unsigned char kOff = 0;
constexpr int kVelocityWindowMode = 0;
constexpr int kStatusConnected = 1;  // places in the status words
constexpr int kStatusForce = 5;
constexpr int kStatusForceOffCause = 14;
constexpr int kStatusWords = 32;  // 17 today; room for a later library

constexpr std::array<const char*, 7> kForceOffCauses{
    "the device switched its motors off and gives no cause",
    "the device's force button switched the motors off",
    "the device switched its motors off because the handle was too fast",
    "the device's watchdog switched the motors off because no force came in time",
    "the device's library switched the motors off",
    "the motors went off because the USB connection was lost",
    "the device switched its motors off because nobody held the handle"};

constexpr std::array<const char*, 23> kErrors{
    "the device failed and gives no cause",
    "the device failed",
    "the communication with the device failed; check cable and power",
    "the device's controller is busy",
    "the device's driver is missing",
    "no device was found; check cable and power",
    "the device is not available; another program may hold it",
    "the device did not answer in time",
    "the device cannot compute its position here",
    "the device refused a setting that only its expert mode allows",
    "the device does not know this function",
    "the device's library ran out of memory",
    "the device is not ready",
    "the device's library misses a file",
    "the device's configuration is not valid",
    "there is no device with this index",
    "the device's library no longer has this function",
    "the device's library was given no place for its result",
    "the device's redundant encoders disagree",
    "the device's forces are not enabled",
    "the device is in use by another program",
    "the device refused a value",
    "the device's automatic control is not running"};

/// Greatest force, torque and grip force of a device according to its maker, by the number of its
/// system type.
struct Model {
  int type;
  const char* name;
  double max_force;            // [N]
  double max_torque{0.2};      // of a wrist with motors [N·m]
  double max_grip_force{8.0};  // of a gripper with a motor [N]
};
constexpr std::array<Model, 6> kModels{{{33, "omega.3", 12.0},
                                        {60, "Falcon", 8.0},
                                        {63, "delta.3", 20.0},
                                        {104, "sigma.7", 20.0, 0.4},
                                        {105, "sigma.7", 20.0, 0.4},
                                        {206, "sigma.3", 20.0}}};
constexpr Model kOther{-1, "device of a type that is not known here", 12.0};

Model model_of(int type) noexcept {
  const auto* const found = std::find_if(kModels.begin(), kModels.end(),
                                         [type](const Model& model) { return model.type == type; });
  return found != kModels.end() ? *found : kOther;
}

template <std::size_t n>
const char* sentence(const std::array<const char*, n>& sentences, int number) noexcept {
  const bool known = number >= 0 && number < static_cast<int>(n);
  return sentences[known ? static_cast<std::size_t>(number) : 0];
}

void check(const ForceDimensionParameters& p, double rate) {
  const bool good = p.index >= 0 && p.index <= 3 && p.max_force > 0.0 && p.max_torque > 0.0 &&
                    p.max_grip_force > 0.0 && p.workspace_radius > 0.0 && p.effector_mass >= 0.0 &&
                    p.velocity_window >= 0.001 && p.watchdog > 0.0 &&
                    p.watchdog <= kLongestWatchdog + 1e-9 && p.velocity_threshold >= -1 &&
                    p.time_guard >= 0.0 && rate > 0.0;
  if (!good) {
    throw std::invalid_argument("ForceDimensionDevice: a parameter is out of its bounds");
  }
}

}  // namespace

const Schema<ForceDimensionParameters>& force_dimension_schema() {
  using P = ForceDimensionParameters;
  static const auto schema =
      Schema<P>()
          .integer("index", &P::index, 0, 3, "Number of the device if several are connected")
          .number("max_force", &P::max_force, {0.0, 100.0, true}, "N",
                  "Force at which the driver saturates; at most what the model gives is used")
          .number("max_torque", &P::max_torque, {0.0, 10.0, true}, "N·m",
                  "Torque at which the driver saturates, of a wrist with motors; at most what the "
                  "model gives")
          .number("max_grip_force", &P::max_grip_force, {0.0, 100.0, true}, "N",
                  "Grip force at which the driver saturates, of a gripper with a motor; at most "
                  "what the model gives")
          .number("workspace_radius", &P::workspace_radius, {0.0, 2.0, true}, "m",
                  "Radius of the device's workspace")
          .number("effector_mass", &P::effector_mass, {0.0, 2.0}, "kg",
                  "Mass mounted on the handle, which gravity compensation carries, too")
          .flag("gravity_compensation", &P::gravity_compensation,
                "Whether the device carries its own weight")
          .number("velocity_window", &P::velocity_window, {0.001, 0.1}, "s",
                  "Time over which velocity is estimated")
          .number("watchdog", &P::watchdog, {0.001, kLongestWatchdog}, "s",
                  "Time without a command after which the motors are switched off")
          .integer("velocity_threshold", &P::velocity_threshold, 0, 1'000'000,
                   "Velocity at which the device brakes, in its own units")
          .otherwise("the device's own")
          .number("time_guard", &P::time_guard, {0.0, 0.01}, "s",
                  "Shortest time between two readings; a faster one gives the last position; 0: "
                  "off")
          .integer("stop_button", &P::stop_button, -1, 31,
                   "Button of the handle for emergency stops; -1: none");
  return schema;
}

ForceDimensionDevice::ForceDimensionDevice(const ForceDimensionParameters& parameters, double rate,
                                           const std::string& library)
    : parameters_((check(parameters, rate), parameters)),
      api_(std::make_unique<const Api>(library)),
      info_{"", parameters.max_force, parameters.workspace_radius, false},
      timer_(1.0 / rate) {
  open();
  try {
    configure();
  } catch (...) {
    close();
    throw;
  }
}

ForceDimensionDevice::~ForceDimensionDevice() { close(); }

void ForceDimensionDevice::require(int result, const char* what) const {
  if (result < 0) {
    throw RunError(fmt::format("the Force Dimension device could not {}: {}", what,
                               sentence(kErrors, api_->last_error())));
  }
}

void ForceDimensionDevice::open() {
  const int present = api_->count();
  if (present <= parameters_.index) {
    throw RunError(
        fmt::format("Force Dimension device {} was not found ({} connected); check cable and power",
                    parameters_.index, present < 0 ? 0 : present));
  }
  const char index = static_cast<char>(parameters_.index);
  int id = api_->has_drd() ? api_->drd_open(index) : -1;
  opened_by_drd_ = id >= 0;
  if (id < 0) {
    id = api_->open(index);
  }
  require(id, "be opened");
  id_ = static_cast<char>(id);
}

/// No definition may claim more than the device gives.
void ForceDimensionDevice::check_limits() const {
  const Model model = model_of(api_->system_type != nullptr ? api_->system_type(id_) : -1);
  const auto check = [&](const char* key, double claimed, double most, const char* unit) {
    if (claimed > most) {
      throw InputError(fmt::format(
          "force_dimension.{} is {} {}; allowed: at most {} {}, which is what the {} gives", key,
          claimed, unit, most, unit, model.name));
    }
  };
  check("max_force", parameters_.max_force, model.max_force, "N");
  if (info_.max_torque > 0.0) {
    check("max_torque", parameters_.max_torque, model.max_torque, "N·m");
  }
  if (info_.max_grip_force > 0.0) {
    check("max_grip_force", parameters_.max_grip_force, model.max_grip_force, "N");
  }
}

/// Notes which motors and sensors the handle has beside those of its tip.
void ForceDimensionDevice::find_parts() {
  const Api& api = *api_;
  info_.senses_orientation =
      api.has_wrist != nullptr && api.get_orientation != nullptr && api.has_wrist(id_);
  if (api.knows_torque() && api.has_active_wrist(id_)) {
    info_.senses_orientation = true;
    info_.torque_axes = Eigen::Vector3d::Ones();
    info_.max_torque = parameters_.max_torque;
  }
  if (api.knows_grip() && api.has_active_gripper(id_)) {
    info_.max_grip_force = parameters_.max_grip_force;
  }
}

void ForceDimensionDevice::configure_parts(int window_ms) const {
  const Api& api = *api_;
  if (info_.max_torque > 0.0) {
    require(api.config_angular_velocity(window_ms, kVelocityWindowMode, id_),
            "set its window of angular velocity");
    require(api.set_max_torque(parameters_.max_torque, id_), "set its torque limit");
  }
  if (info_.max_grip_force > 0.0) {
    require(api.config_gripper_velocity(window_ms, kVelocityWindowMode, id_),
            "set its gripper's velocity window");
    require(api.set_max_gripper_force(parameters_.max_grip_force, id_), "set its grip force limit");
  }
}

/// Set again at every start: a program before this one may have switched them off.
void ForceDimensionDevice::configure_safety() {
  const Api& api = *api_;
  const ForceDimensionParameters& p = parameters_;
  require(api.enable_expert_mode(), "enter its expert mode");
  const auto watchdog = static_cast<unsigned char>(std::lround(p.watchdog / kWatchdogStep));
  require(api.set_watchdog(watchdog, id_), "set its watchdog");
  if (p.velocity_threshold >= 0) {
    require(api.set_velocity_threshold(static_cast<unsigned>(p.velocity_threshold), id_),
            "set its velocity threshold");
  }
  require(api.set_time_guard(static_cast<int>(std::lround(1e6 * p.time_guard)), id_),
          "set its time guard");
  require(api.disable_expert_mode(), "leave its expert mode");
}

void ForceDimensionDevice::configure() {
  find_parts();
  check_limits();
  const Api& api = *api_;
  const ForceDimensionParameters& p = parameters_;
  if (opened_by_drd_ && api.drd_is_supported(id_)) {
    if (!api.drd_is_initialized(id_)) {
      require(api.drd_auto_init(id_), "calibrate itself");
    }
    require(api.drd_stop(true, id_), "leave its automatic control");
  }
  require(api.set_effector_mass(p.effector_mass, id_), "take the effector mass");
  require(api.set_gravity_compensation(p.gravity_compensation ? 1 : 0, id_),
          "set its gravity compensation");
  const auto window_ms = static_cast<int>(std::lround(1e3 * p.velocity_window));
  require(api.config_linear_velocity(window_ms, kVelocityWindowMode, id_),
          "set its velocity window");
  require(api.set_max_force(p.max_force, id_), "set its force limit");
  configure_parts(window_ms);
  configure_safety();
  require(set_wrench({}), "take a force of zero");
  require(api.enable_force(kOn, id_), "switch its forces on");
  const char* const name = api.system_name(id_);
  info_.name = fmt::format("Force Dimension {}", name != nullptr ? name : "device");
}

void ForceDimensionDevice::close() noexcept {
  if (id_ < 0) {
    return;
  }
  set_wrench({});
  api_->enable_force(kOff, id_);
  api_->stop(id_);
  opened_by_drd_ ? api_->drd_close(id_) : api_->close(id_);
  id_ = -1;
}

bool ForceDimensionDevice::fail() noexcept {
  trouble_ = sentence(kErrors, api_->last_error());
  return false;
}

bool ForceDimensionDevice::read(DeviceReading& reading) noexcept {
  const CallTimer::Scope timed(timer_);
  double px = 0.0;
  double py = 0.0;
  double pz = 0.0;
  double vx = 0.0;
  double vy = 0.0;
  double vz = 0.0;
  // Above zero is not an error: 1 says that the time guard gave the last values again.
  if (api_->get_position(&px, &py, &pz, id_) < 0 ||
      api_->get_linear_velocity(&vx, &vy, &vz, id_) < 0) {
    return fail();
  }
  DeviceReading fresh;
  fresh.tool.position = {py, pz, px};
  fresh.tool.velocity = {vy, vz, vx};
  if (!read_wrist(fresh) || !read_gripper(fresh)) {
    return fail();
  }
  fresh.buttons = api_->get_button_mask(id_);
  fresh.stop_pressed = is_pressed(fresh.buttons, parameters_.stop_button);
  trouble_ = "";
  judge_status(fresh);
  reading = fresh;
  return true;
}

bool ForceDimensionDevice::read_wrist(DeviceReading& reading) noexcept {
  if (info_.senses_orientation && !read_orientation(reading.orientation)) {
    return false;
  }
  if (info_.max_torque <= 0.0) {
    return true;
  }
  double wx = 0.0;
  double wy = 0.0;
  double wz = 0.0;
  const bool read = api_->get_angular_velocity(&wx, &wy, &wz, id_) >= 0;
  reading.angular_velocity = {wy, wz, wx};
  return read;
}

bool ForceDimensionDevice::read_gripper(DeviceReading& reading) noexcept {
  return info_.max_grip_force <= 0.0 ||
         (api_->get_gripper_gap(&reading.opening, id_) >= 0 &&
          api_->get_gripper_velocity(&reading.opening_speed, id_) >= 0);
}

bool ForceDimensionDevice::read_orientation(Eigen::Quaterniond& orientation) noexcept {
  double rows[3][3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
  if (api_->get_orientation(rows, id_) < 0) {
    return false;
  }
  constexpr int kTheirs[3] = {1, 2, 0};  // the vendor's axis that is our x, y, z
  Eigen::Matrix3d turn;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      turn(i, j) = rows[kTheirs[i]][kTheirs[j]];
    }
  }
  orientation = Eigen::Quaterniond(turn).normalized();
  return true;
}

void ForceDimensionDevice::judge_status(DeviceReading& reading) noexcept {
  std::array<int, kStatusWords> status{};
  if (api_->get_status(status.data(), id_) < 0) {
    fail();
    reading.forces_on = false;
  } else if (status[kStatusConnected] == 0 || status[kStatusForce] == 0) {
    trouble_ = sentence(kForceOffCauses, status[kStatusForceOffCause]);
    reading.forces_on = false;
  }
}

bool ForceDimensionDevice::write(const Wrench& wrench) noexcept {
  const CallTimer::Scope timed(timer_);
  return set_wrench(wrench) >= 0 || fail();
}

/// The vendor's axes turn into ours without a reflection, so that a torque is mapped as a force is.
int ForceDimensionDevice::set_wrench(const Wrench& wrench) noexcept {
  const Eigen::Vector3d& f = wrench.force;
  const Eigen::Vector3d& t = wrench.torque;
  if (info_.max_torque > 0.0 || info_.max_grip_force > 0.0) {
    return api_->set_wrench(f.z(), f.x(), f.y(), t.z(), t.x(), t.y(), wrench.grip, id_);
  }
  return api_->set_force(f.z(), f.x(), f.y(), id_);
}

int count_force_dimension_devices(const std::string& library) {
  const DynamicLibrary loaded = open_force_dimension_library(library);
  int (*count)() = nullptr;
  loaded.get(count, "dhdGetDeviceCount");
  return count();
}

}  // namespace haptrial::device
