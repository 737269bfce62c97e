#pragma once

#include <Eigen/Core>
#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "core/device/handle_physics.h"

namespace haptrial::test {

/// Failure of a simulated board from some tick on.
enum class BoardFailure {
  kNone,
  kSilent,      // it gives no readings
  kUnplugged,   // its line is gone
  kNotFinite,   // readings that are no numbers
  kTorn,        // every reading lacks its end
  kNoise,       // bytes at random in place of readings
  kJump,        // the handle is 20 mm off
  kDoubled,     // each reading comes twice
  kEveryOther,  // a reading is left out now and then
  kLate,        // each reading comes with the next one
};

/// The firmware of a board, which takes and gives bytes; the physics are the same for all.
class BoardFirmware {
 public:
  virtual ~BoardFirmware() = default;
  /// Whether a reading is sent for each force, else by the board's own clock.
  virtual bool answers() const = 0;
  /// Takes what came from the computer. @returns how many forces it commanded
  virtual int take(const std::string& bytes) = 0;
  /// Force of the motors on the handle, in W, as commanded last [N].
  virtual Eigen::Vector3d force(const Eigen::Vector3d& handle) const = 0;
  /// A reading for the computer.
  virtual std::string reading(const Eigen::Vector3d& handle, unsigned buttons) const = 0;
};

/// A board on a pseudo-terminal: a mass in a hand behind a firmware. Either each step() is one
/// millisecond, or a thread lets time pass.
class SimulatedBoard {
 public:
  explicit SimulatedBoard(std::unique_ptr<BoardFirmware> firmware,
                          const Eigen::Vector3d& free = Eigen::Vector3d::Ones());
  ~SimulatedBoard();
  SimulatedBoard(const SimulatedBoard&) = delete;
  SimulatedBoard& operator=(const SimulatedBoard&) = delete;

  const std::string& port() const { return name_; }
  /// Answers on a thread of its own until stop(). @param delay  before the first word [ms]
  /// @param hand  what the hand does, called every millisecond with the time [s]; may be empty
  void start(int delay = 0, std::function<void(SimulatedBoard&, double)> hand = {});
  void stop();
  /// One millisecond. @param readings  count of the readings that the driver has taken; the step
  /// ends when it has the new one
  void step(const std::function<std::uint64_t()>& readings);
  /// @param tick  from now on [ms]
  void fail(BoardFailure failure, long tick);
  void unplug();

  // These belong to the thread that steps, or to the hand.
  device::CoupledMass mass{device::CoupledMassParameters{}};
  std::atomic<unsigned> buttons{0};
  /// Force that the motors give now; any thread once the board is stopped.
  Eigen::Vector3d force() const { return firmware_->force(mass.state().position); }
  BoardFirmware& firmware() { return *firmware_; }
  /// Takes what is still on the line.
  void drain();

 private:
  bool hear(int most_ms);
  bool is_understood() const;
  void say(const std::string& bytes);
  std::string next_reading();
  void pass_millisecond();
  void run(int delay, const std::function<void(SimulatedBoard&, double)>& hand);

  std::unique_ptr<BoardFirmware> firmware_;
  Eigen::Vector3d free_;  // axes along which the handle moves
  int line_{-1};
  int other_end_{-1};
  std::string name_;
  BoardFailure failure_{BoardFailure::kNone};
  long failure_tick_{0};
  long ticks_{0};
  std::string held_back_;
  std::atomic<bool> over_{false};
  std::thread thread_;
};

/// A pantograph behind hAPI. Its kinematics are closed forms of their own: inverse kinematics, and
/// forces from torques by the derivative of these.
class HapiFirmware final : public BoardFirmware {
 public:
  struct Setup {
    unsigned motor_ports{0}, encoder_ports{0};
    std::string directions;              // of motors, then encoders
    float offset[2]{}, resolution[2]{};  // by ports
    int count{0};
  };
  bool first_firmware{false};  // of 2017
  Setup setup;
  double torque[2]{};                     // of motors 1 and 2 [N·m]
  std::optional<Eigen::Vector2d> angles;  // in place of those of the handle [deg]

  bool answers() const override { return true; }
  int take(const std::string& bytes) override;
  Eigen::Vector3d force(const Eigen::Vector3d& handle) const override;
  std::string reading(const Eigen::Vector3d& handle, unsigned buttons) const override;

  /// Angles of the motors for a handle in the pantograph's plane [rad].
  static Eigen::Vector2d angles_at(const Eigen::Vector2d& handle);

 private:
  std::string came_;
};

/// A board with lines: "t,X,buttons" with X in millimetres, and a torque on a lever of 80 mm.
class PaddleFirmware final : public BoardFirmware {
 public:
  bool planar{false};  // x and z, as "X Z", and a force for each
  double value[2]{};   // that were commanded
  int malformed{0};
  bool waits_for_start{false};

  bool answers() const override { return false; }
  int take(const std::string& bytes) override;
  Eigen::Vector3d force(const Eigen::Vector3d& handle) const override;
  std::string reading(const Eigen::Vector3d& handle, unsigned buttons) const override;

 private:
  std::string came_;
  bool started_{false};
  mutable long lines_{0};
};

}  // namespace haptrial::test
