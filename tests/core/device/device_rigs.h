#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/dynamic_library.h"
#include "core/device/device.h"
#include "core/device/paddle_board.h"
#include "tests/support/stand_in.h"

namespace haptrial::test {

inline constexpr double kRigRate = 1000.0;  // [Hz]

/// How a failure reaches a device and what it must come to.
struct RigFailure {
  Failure failure;
  std::string name;
  bool harmless{false};  // the device goes on
  long delay{0};         // ticks until it may show
};

/// A device with what stands behind it, so that one suite runs over all of them.
class Rig {
 public:
  virtual ~Rig() = default;
  virtual device::Device& device() = 0;
  /// One period passes behind the device, where its write() does not do that by itself.
  virtual void period() {}
  /// Whether period() runs the driver's own code, which must not allocate, and not that of a board.
  virtual bool period_is_the_drivers() const { return true; }
  /// How far a held force of 1 N moves the tool in the end [m].
  virtual double compliance() const { return 0.0; }
  /// Has the tool go to p by what stands behind the device [m].
  virtual void place(const Eigen::Vector3d& p) = 0;
  virtual bool press_button() { return false; }
  virtual std::vector<RigFailure> failures() const { return {}; }
  virtual void fail(Failure, long /*tick*/) {}
  /// Closes the device. @returns the force that the motors give then, or NaN where nobody knows.
  virtual double force_after_close() = 0;
};

struct RigKind {
  std::string name;
  std::unique_ptr<Rig> (*make)();
};
std::vector<RigKind> every_rig();

/// Set-up for the lines of PaddleFirmware with one axis.
device::PaddleParameters example_paddle(const std::string& port);

/// The controls of a stand-in library, which stays loaded while this lives.
struct StandIn {
  explicit StandIn(const std::string& name);
  ~StandIn() { reset(); }  // the loader may keep the library
  StandIn(const StandIn&) = delete;
  StandIn& operator=(const StandIn&) = delete;
  StandInView look() const;
  StandInSetup setup() const;

  std::string path;
  DynamicLibrary library;
  void (*reset)();
  void (*fail)(int, long);
  void (*place)(const double*);
  void (*turn)(const double*);
  void (*activate)();
  void (*buttons)(unsigned);
  void (*view)(StandInView*);
  void (*set_up)(StandInSetup*);
  void (*manual)(int);  // null but for HD
  void (*step)();
};

}  // namespace haptrial::test
