#pragma once

#include <time.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "core/base/definition/schema_forward.h"
#include "core/device/device.h"

namespace haptrial::device {

/// Counts the calls into a vendor's library that took longer than a bound. Nothing interrupts such
/// a call; it shows as an overrun of the loop, and here as its cause.
class CallTimer {
 public:
  /// @param bound  [s]
  explicit CallTimer(double bound) noexcept : bound_ns_(static_cast<std::int64_t>(bound * 1e9)) {}

  /// Any thread.
  std::uint64_t slow() const noexcept { return slow_.load(std::memory_order_relaxed); }

  /// Measures from its construction to its end. Servo thread.
  class Scope {
   public:
    explicit Scope(CallTimer& timer) noexcept : timer_(timer), start_(now()) {}
    ~Scope() {
      if (now() - start_ > timer_.bound_ns_) {
        timer_.slow_.fetch_add(1, std::memory_order_relaxed);
      }
    }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    CallTimer& timer_;
    std::int64_t start_;  // [ns]
  };

 private:
  static std::int64_t now() noexcept {
    timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
  }

  std::int64_t bound_ns_;
  std::atomic<std::uint64_t> slow_{0};
};

/// How a Force Dimension device is set up; nothing is left to what its last user chose. The
/// defaults suit an omega.3.
struct ForceDimensionParameters {
  int index{0};                // of the device, 0 to 3
  double max_force{12.0};      // the driver saturates here, at most what the model gives > 0 [N]
  double max_torque{0.1};      // likewise of a wrist with motors > 0 [N·m]
  double max_grip_force{4.0};  // likewise of a gripper with a motor > 0 [N]
  double workspace_radius{0.075};  // > 0 [m]
  double effector_mass{0.0};  // what is mounted on the handle, for gravity compensation >= 0 [kg]
  bool gravity_compensation{true};
  double velocity_window{0.008};  // over which velocity is estimated, whole milliseconds > 0 [s]
  double watchdog{0.02};          // forces go off without a command for so long, steps of 125 µs,
                                  // at most 0.031875; never off > 0 [s]
  int velocity_threshold{-1};     // at which the device brakes, in its own units; -1: keep the
                                  // maker's setting
  double time_guard{0.0};         // a faster position read gives the last one; 0: off >= 0 [s]
  int stop_button{0};             // emergency stop; -1: none
};

/// The keys of [force_dimension].
const Schema<ForceDimensionParameters>& force_dimension_schema();

/// Drives an omega, delta, sigma, lambda or Falcon through the vendor's DHD library, and through
/// its DRD library, where that is installed, for the automatic start-up calibration. A wrist or
/// gripper with motors gives torque or grip force, if the library has what it takes for them.
///
/// The vendor's axes are x to the user, y to the right and z up; this driver is the only place that
/// knows (docs/conventions.md). Its origin is the vendor's.
class ForceDimensionDevice final : public Device {
 public:
  /// Opens, calibrates and configures the device and switches its forces on at zero. May take some
  /// seconds and move the handle: nobody should hold it.
  /// @param rate     of the servo loop, for the count of slow calls > 0 [Hz]
  /// @param library  a path in place of the search for libdrd.so.3, then libdhd.so.3
  /// @throws InputError when the library or one of its functions is missing, or max_force is more
  ///         than the model gives; RunError when no device answers or one refuses its set-up.
  ForceDimensionDevice(const ForceDimensionParameters& parameters, double rate,
                       const std::string& library = "");
  /// Force to zero, forces off, closed.
  ~ForceDimensionDevice() override;

  const DeviceInfo& info() const noexcept override { return info_; }
  bool read(DeviceReading& reading) noexcept override;
  bool write(const Wrench& wrench) noexcept override;
  const char* trouble() const noexcept override { return trouble_; }
  std::uint64_t slow_calls() const noexcept override { return timer_.slow(); }

 private:
  struct Api;
  void open();
  void check_limits() const;
  void configure();
  void configure_safety();
  void find_parts();
  void configure_parts(int window_ms) const;
  int set_wrench(const Wrench& wrench) noexcept;
  bool read_wrist(DeviceReading& reading) noexcept;
  bool read_gripper(DeviceReading& reading) noexcept;
  void close() noexcept;
  void require(int result, const char* what) const;
  bool fail() noexcept;
  bool read_orientation(Eigen::Quaterniond& orientation) noexcept;
  void judge_status(DeviceReading& reading) noexcept;

  ForceDimensionParameters parameters_;
  std::unique_ptr<const Api> api_;
  char id_{-1};
  bool opened_by_drd_{false};
  DeviceInfo info_;
  CallTimer timer_;
  const char* trouble_{""};
};

/// How many devices the library sees, without opening any. @throws InputError as the device does.
int count_force_dimension_devices(const std::string& library = "");

}  // namespace haptrial::device
