#include "core/device/open_haptics.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <thread>

#include "core/base/definition/schema.h"
#include "core/base/dynamic_library.h"
#include "core/base/error.h"

namespace haptrial::device {
namespace {

constexpr unsigned kCurrentButtons = 0x2000;
constexpr unsigned kPosition = 0x2050;         // [mm]
constexpr unsigned kVelocity = 0x2051;         // [mm/s]
constexpr unsigned kTransform = 0x2052;        // 4 x 4, by columns
constexpr unsigned kAngularVelocity = 0x2053;  // [rad/s]
constexpr unsigned kOutputs = 0x2554;          // motors
constexpr unsigned kForce = 0x2700;
constexpr unsigned kTorque = 0x2701;            // of a device with six motors [mN·m]
constexpr unsigned kNominalMaxTorque = 0x2622;  // likewise [mN·m]
constexpr int kWithTorque = 6;                  // motors
constexpr double kMillinewtonmetre = 1e-3;      // [N·m]
constexpr unsigned kNominalMaxForce = 0x2603;
constexpr double kForceOfATouch = 3.3;  // the weakest of them, where the device says nothing [N]
constexpr unsigned kForceOutput = 0x4000;
constexpr unsigned kInvalidDevice = 0xFFFFFFFF;
constexpr unsigned kGoOn = 1;
constexpr unsigned short kPriority = 0xFFFF;  // before any other callback
constexpr double kMillimetre = 1e-3;

constexpr const char* kOpenHapticsFrom =
    "OpenHaptics for Linux, from https://support.3dsystems.com";

struct ErrorInfo {  // as the vendor lays it out
  unsigned code;
  int internal;
  unsigned device;
};

const char* hd_sentence(unsigned error) noexcept {
  switch (error) {
    case 0x200:
      return "the device's motors are too warm";
    case 0x201:
      return "the device was asked for more force than it allows";
    case 0x202:
      return "the device was asked for too hard an impulse";
    case 0x203:
      return "the device's handle was too fast";
    case 0x204:
      return "the device could not give the force";
    case 0x300:
      return "the device reports a fault of its own";
    case 0x302:
      return "the communication with the device failed; check cable and power";
    case 0x304:
      return "the timer of the device's scheduler failed";
    default:
      return "the device failed";
  }
}

/// These leave the device answering, but without the force that was asked for.
bool only_force_is_off(unsigned error) noexcept { return error >= 0x200 && error <= 0x204; }

void check_hd(const OpenHapticsParameters& p, double rate) {
  if (!(p.max_force > 0.0 && p.max_torque > 0.0 && p.workspace_radius > 0.0 && p.patience > 0.0 &&
        rate > 0.0)) {
    throw std::invalid_argument("OpenHapticsDevice: a parameter is out of its bounds");
  }
}

}  // namespace

/// The functions of the vendor's library that are used here.
struct OpenHapticsDevice::Api {
  explicit Api(const std::string& path)
      : library(path.empty() ? "libHD.so" : path, kOpenHapticsFrom) {
    library.get(init_device, "hdInitDevice");
    library.get(disable_device, "hdDisableDevice");
    library.get(make_current, "hdMakeCurrentDevice");
    library.get(enable, "hdEnable");
    library.get(disable, "hdDisable");
    library.get(set_scheduler_rate, "hdSetSchedulerRate");
    library.get(start_scheduler, "hdStartScheduler");
    library.get(stop_scheduler, "hdStopScheduler");
    library.get(schedule, "hdScheduleAsynchronous");
    library.get(unschedule, "hdUnschedule");
    library.get(begin_frame, "hdBeginFrame");
    library.get(end_frame, "hdEndFrame");
    library.get(get_double, "hdGetDoublev");
    library.get(get_integer, "hdGetIntegerv");
    library.get(set_double, "hdSetDoublev");
    library.get(get_error, "hdGetError");
  }

  DynamicLibrary library;
  unsigned (*init_device)(const char*);
  void (*disable_device)(unsigned);
  void (*make_current)(unsigned);
  void (*enable)(unsigned);
  void (*disable)(unsigned);
  void (*set_scheduler_rate)(unsigned long);
  void (*start_scheduler)();
  void (*stop_scheduler)();
  unsigned long (*schedule)(unsigned (*)(void*), void*, unsigned short);
  void (*unschedule)(unsigned long);
  void (*begin_frame)(unsigned);
  void (*end_frame)(unsigned);
  void (*get_double)(unsigned, double*);
  void (*get_integer)(unsigned, int*);
  void (*set_double)(unsigned, const double*);
  ErrorInfo (*get_error)();
};

const Schema<OpenHapticsParameters>& open_haptics_schema() {
  using P = OpenHapticsParameters;
  static const auto schema =
      Schema<P>()
          .text("name", &P::name, "Name of the device, as the vendor's set-up program gave it")
          .otherwise("the default device")
          .number("max_force", &P::max_force, {0.0, 100.0, true}, "N",
                  "Force at which the driver saturates; at most the device's own limit is used")
          .number("max_torque", &P::max_torque, {0.0, 10.0, true}, "N·m",
                  "Torque at which the driver saturates, of a device with six motors; at most the "
                  "device's own limit is used")
          .number("workspace_radius", &P::workspace_radius, {0.0, 2.0, true}, "m",
                  "Radius of the device's workspace")
          .number("patience", &P::patience, {0.002, 1.0}, "s",
                  "Silence between the loop and the vendor's scheduler after which the force is "
                  "switched off")
          .integer("stop_button", &P::stop_button, -1, 31,
                   "Button of the handle for emergency stops; -1: none");
  return schema;
}

OpenHapticsDevice::OpenHapticsDevice(const OpenHapticsParameters& parameters, double rate,
                                     const std::string& library)
    : parameters_((check_hd(parameters, rate), parameters)),
      api_(std::make_unique<const Api>(library)),
      device_(api_->init_device(parameters.name.empty() ? nullptr : parameters.name.c_str())),
      patience_ticks_(std::max(1, static_cast<int>(std::lround(parameters.patience * rate)))) {
  require("be opened");
  if (device_ == kInvalidDevice) {
    throw RunError("the OpenHaptics device could not be opened; check cable and power");
  }
  try {
    start(rate);
  } catch (...) {
    close();
    throw;
  }
}

OpenHapticsDevice::~OpenHapticsDevice() { close(); }

void OpenHapticsDevice::require(const char* what) const {
  const ErrorInfo error = api_->get_error();
  if (error.code != 0) {
    throw RunError(fmt::format("the OpenHaptics device could not {}: {} (0x{:x})", what,
                               hd_sentence(error.code), error.code));
  }
}

void OpenHapticsDevice::start(double rate) {
  api_->make_current(device_);
  double nominal = 0.0;
  api_->get_double(kNominalMaxForce, &nominal);
  require("say its greatest force");
  info_ = {
      fmt::format("OpenHaptics {}", parameters_.name.empty() ? "default device" : parameters_.name),
      std::min(nominal > 0.0 ? nominal : kForceOfATouch, parameters_.max_force),
      parameters_.workspace_radius, false, true};
  find_torque();
  api_->enable(kForceOutput);
  require("switch its forces on");
  callback_ = api_->schedule(&OpenHapticsDevice::frame, this, kPriority);
  api_->set_scheduler_rate(static_cast<unsigned long>(std::lround(rate)));
  require("run at this rate");
  api_->start_scheduler();
  scheduler_runs_ = true;
  // Errors from here on are the callback's to fetch; a start that failed shows as silence.
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(1);
  while (!sensed_.read(latest_)) {
    if (std::chrono::steady_clock::now() > deadline) {
      throw RunError(
          "the OpenHaptics device's scheduler gives no positions; check cable and power");
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

/// A device that does not say how much torque it gives gives none here.
void OpenHapticsDevice::find_torque() {
  int motors = 0;
  double nominal = 0.0;
  api_->get_integer(kOutputs, &motors);
  if (motors == kWithTorque) {
    api_->get_double(kNominalMaxTorque, &nominal);
  }
  require("say its greatest torque");
  if (nominal > 0.0) {
    info_.torque_axes = Eigen::Vector3d::Ones();
    info_.max_torque = std::min(kMillinewtonmetre * nominal, parameters_.max_torque);
  }
}

void OpenHapticsDevice::close() noexcept {
  ending_.store(true, std::memory_order_release);
  if (scheduler_runs_) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));  // a frame of zero force
    api_->stop_scheduler();
    api_->unschedule(callback_);
  }
  api_->begin_frame(device_);
  give({});
  api_->end_frame(device_);
  api_->disable(kForceOutput);
  api_->disable_device(device_);
}

unsigned OpenHapticsDevice::frame(void* self) {
  static_cast<OpenHapticsDevice*>(self)->exchange();
  return kGoOn;
}

void OpenHapticsDevice::give(const Wrench& wrench) noexcept {
  api_->set_double(kForce, wrench.force.data());
  if (info_.max_torque > 0.0) {
    const Eigen::Vector3d torque = wrench.torque / kMillinewtonmetre;
    api_->set_double(kTorque, torque.data());
  }
}

void OpenHapticsDevice::exchange() noexcept {
  const Api& api = *api_;
  if (command_.read(wrench_)) {
    frames_without_command_ = 0;
  } else if (++frames_without_command_ > patience_ticks_) {
    wrench_ = {};
  }
  if (ending_.load(std::memory_order_acquire)) {
    wrench_ = {};
  }
  double p[3] = {0.0, 0.0, 0.0};
  double v[3] = {0.0, 0.0, 0.0};
  Eigen::Matrix4d transform = Eigen::Matrix4d::Identity();
  int buttons = 0;
  api.begin_frame(device_);
  api.get_double(kPosition, p);
  api.get_double(kVelocity, v);
  api.get_double(kTransform, transform.data());
  api.get_integer(kCurrentButtons, &buttons);
  Sensed now;
  if (info_.max_torque > 0.0) {
    api.get_double(kAngularVelocity, now.reading.angular_velocity.data());
  }
  give(wrench_);
  api.end_frame(device_);

  now.reading.tool.position = kMillimetre * Eigen::Vector3d(p[0], p[1], p[2]);
  now.reading.tool.velocity = kMillimetre * Eigen::Vector3d(v[0], v[1], v[2]);
  now.reading.orientation =
      Eigen::Quaterniond(Eigen::Matrix3d(transform.topLeftCorner<3, 3>())).normalized();
  now.reading.buttons = static_cast<std::uint32_t>(buttons);
  now.reading.stop_pressed = is_pressed(now.reading.buttons, parameters_.stop_button);
  note_error(api.get_error().code);
  now.error = error_;
  now.reading.forces_on = now.error == 0;
  sensed_.write(now);
}

// Held for a while: the next frame, without an error, may replace this one before it was read.
void OpenHapticsDevice::note_error(unsigned error) noexcept {
  if (error != 0) {
    error_ = error;
    error_frames_ = patience_ticks_;
  } else if (error_frames_ > 0 && --error_frames_ == 0) {
    error_ = 0;
  }
}

bool OpenHapticsDevice::read(DeviceReading& reading) noexcept {
  if (sensed_.read(latest_)) {
    ticks_without_news_ = 0;
  } else {
    stale_.fetch_add(1, std::memory_order_relaxed);
    ++ticks_without_news_;
  }
  if (ticks_without_news_ > patience_ticks_) {
    trouble_ = "the device's scheduler gives no positions";
    return false;
  }
  trouble_ = latest_.error == 0 ? "" : hd_sentence(latest_.error);
  if (latest_.error != 0 && !only_force_is_off(latest_.error)) {
    return false;
  }
  reading = latest_.reading;
  return true;
}

bool OpenHapticsDevice::write(const Wrench& wrench) noexcept {
  command_.write(wrench);
  return true;
}

void check_open_haptics_library(const std::string& library) {
  const DynamicLibrary loaded(library.empty() ? "libHD.so" : library, kOpenHapticsFrom);
  void (*begin_frame)(unsigned) = nullptr;
  loaded.get(begin_frame, "hdBeginFrame");
}

}  // namespace haptrial::device
