#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <optional>
#include <vector>

#include "analysis/device/certificate_record.h"
#include "analysis/device/excitation.h"
#include "core/device/device.h"
#include "core/device/envelope.h"
#include "core/device/force_sensor.h"
#include "core/device/handle_part.h"
#include "core/realtime/servo_loop.h"
#include "experiments/command/sessions/device_bench.h"
#include "protocols/definition/definition.h"

namespace haptrial::experiments {

/// Walls along one axis that grow stiffer until one swings on, then between the last two. The
/// command itself takes the free handle back from each and presses it against the next, so that no
/// hand damps it; a handle that the press does not bring to a wall ends the search:
///
///     f = stiffness · max(-x, 0) - press        x along the axis
class WallLadder {
 public:
  static constexpr std::size_t kMost = 40;  // walls

  /// @param axis  0 to 2 for x to z
  /// @param most  that is commanded; under 3 N all forces are smaller in proportion > 0 [N]
  WallLadder(double rate, int axis, double most) noexcept;
  /// @returns the command for the tick. Servo thread.
  Eigen::Vector3d command(const PointState& tool) noexcept;
  bool done() const noexcept { return done_; }
  std::vector<analysis::WallStep> steps() const;

 private:
  bool is_ready(double x, double v) noexcept;
  double taking_back(double x, double v) noexcept;
  void judge() noexcept;

  double rate_;
  int axis_;
  double share_;  // of the forces at which a strong device presses and is taken back
  std::array<analysis::WallStep, kMost> steps_{};
  std::size_t count_{0};
  double stiffness_{200.0};               // of the wall now [N/m]
  double passive_{0.0}, active_{0.0};     // [N/m]
  bool pressing_{false};                  // against the wall; else the handle is taken back
  long tick_{0};                          // since that began
  double gathered_{0.0};                  // force that friction took, of taking it back [N]
  double released_{0.0};                  // x where the handle was let go [m]
  std::array<double, 3> low_{}, high_{};  // of x in the thirds of the time at the wall [m]
  bool lost_{false};                      // the handle went off
  bool done_{false};
};

/// The measurement of a certificate behind the envelope: part after part, each recorded whole.
/// Servo thread: tick(), which neither allocates, locks, waits nor throws. Any thread: part(),
/// start(), stop().
class CertificateTask final : public realtime::ServoTask {
 public:
  /// Takes a simulated handle to where it must be at the end of the tick. Servo thread.
  using Mount = std::function<void(analysis::CertificatePart part, long tick)>;

  /// @param device, sensor, excitation  outlive this; the sensor may be null
  /// @param parts  in their order; each waits for start() unless there is a mount
  /// @param of      the part of the device's handle that is measured, from where it is at first
  /// @param radius  of the fingers about the axis of a rotation [m]
  CertificateTask(device::Device& device, device::ForceSensor* sensor,
                  const analysis::Excitation& excitation,
                  std::vector<analysis::CertificatePart> parts, Mount mount = {},
                  device::Part of = device::Part::kTip, double radius = 1.0);

  bool tick(const realtime::Tick& tick) noexcept override;
  void start() noexcept { start_.store(true, std::memory_order_release); }
  void stop() noexcept { stop_.store(true, std::memory_order_relaxed); }
  bool stopped() const noexcept { return stopped_.load(std::memory_order_acquire); }
  /// The part that runs or waits to be started; kDone after the last.
  analysis::CertificatePart part() const noexcept { return shown_.load(std::memory_order_acquire); }

  /// After the loop.
  device::Fault fault() const noexcept { return envelope_.fault(); }
  const char* trouble() const noexcept { return trouble_; }
  analysis::CertificateRecord record() const;

 private:
  bool read(device::DeviceReading& reading) noexcept;
  bool write(const Eigen::Vector3d& force) noexcept;
  Eigen::Vector3d command(const device::DeviceReading& reading) noexcept;
  /// @param moved    the axis that is driven
  /// @param centred  how much of it other forces hold, 0 to 1
  Eigen::Vector3d catching(const PointState& tool, int moved, double centred) const noexcept;
  /// @param measured  null: the sensor gave nothing
  void keep(const device::DeviceReading& reading, const Eigen::Vector3d& command,
            const device::MeasuredForce* measured) noexcept;
  void end_part() noexcept;

  device::Device& device_;
  device::Part of_;
  double radius_;
  std::optional<Eigen::Vector3d> origin_;           // of a rotation or grip [m]
  Eigen::Vector3d place_{Eigen::Vector3d::Zero()};  // of it, a tick ago [m]
  device::ForceSensor* sensor_;
  const analysis::Excitation& excitation_;
  device::Envelope envelope_;
  std::vector<analysis::CertificatePart> parts_;
  Mount mount_;
  analysis::CertificateRecord record_;  // its columns have their length from the beginning
  WallLadder walls_;
  std::size_t at_{0};  // of the parts
  long tick_{0};       // of the part
  std::array<std::vector<double>, static_cast<std::size_t>(analysis::CertificatePart::kDone)>
      tick_at_;  // of each part, on the sensor's clock [s]
  const char* trouble_{""};
  std::array<bool, static_cast<std::size_t>(analysis::CertificatePart::kDone)> unmeasured_{};
  std::atomic<bool> start_{false};
  std::atomic<bool> stop_{false};
  std::atomic<bool> stopped_{false};
  std::atomic<analysis::CertificatePart> shown_{analysis::CertificatePart::kDone};
};

/// How far a part is moved to either side at the fingers [m].
double reach_of(device::Part part, double radius, double workspace_radius);

/// The commands for a part. @param most  force that the device gives there [N]
analysis::Excitation excitation_of(const protocols::DeviceArm& arm,
                                   const analysis::DrivenAxes& axes, double most,
                                   double workspace_radius);

/// The known load of a part; 0: none [kg].
double load_of(const DeviceTestOptions& options, const protocols::DeviceArm& arm);

/// The parts of a measurement without a sensor. A rotation or grip is not let go to be moved: its
/// ways are too short to identify anything from.
std::vector<analysis::CertificatePart> parts_without_sensor(const DeviceTestOptions& options,
                                                            const protocols::DeviceArm& arm);

}  // namespace haptrial::experiments
