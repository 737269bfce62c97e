#include "tests/core/device/device_rigs.h"

#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "core/device/force_dimension.h"
#include "core/device/handle_physics.h"
#include "core/device/hapi_board.h"
#include "core/device/haply.h"
#include "core/device/mouse.h"
#include "core/device/open_haptics.h"
#include "core/device/paddle_board.h"
#include "core/device/replay.h"
#include "core/device/virtual_device.h"
#include "tests/support/boards/simulated_board.h"
#include "tests/support/haply_service.h"

namespace haptrial::test {

using Eigen::Vector3d;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

StandIn::StandIn(const std::string& name)
    : path(std::string(HAPTRIAL_BINARY_DIR) + "/lib" + name + ".so"), library(path, "the tests") {
  library.get(reset, "stand_in_reset");
  library.get(fail, "stand_in_fail");
  library.get(place, "stand_in_place");
  library.get(turn, "stand_in_turn");
  library.get(activate, "stand_in_activate");
  library.get(buttons, "stand_in_buttons");
  library.get(view, "stand_in_view");
  library.get(set_up, "stand_in_setup");
  library.find(manual, "stand_in_manual");
  library.find(step, "stand_in_step");
  reset();
}

StandInView StandIn::look() const {
  StandInView seen;
  view(&seen);
  return seen;
}

StandInSetup StandIn::setup() const {
  StandInSetup seen;
  set_up(&seen);
  return seen;
}

namespace {

device::VirtualDeviceParameters fine_electronics() {
  device::VirtualDeviceParameters p;
  p.position_quantum = 1e-7;
  return p;
}

/// A handle that breaks on command.
class BreakableMass final : public device::HandlePhysics {
 public:
  PointState step(const Vector3d& force, double dt) noexcept override {
    PointState state = mass.step(force, dt);
    if (++ticks >= failure_tick) {
      if (failure == Failure::kNotFinite) {
        state.position.y() = kNan;
      } else if (failure == Failure::kJump) {
        state.position.z() += 0.02;
      }
    }
    return state;
  }
  PointState state() const noexcept override { return mass.state(); }

  device::CoupledMass mass{device::CoupledMassParameters{}};
  Failure failure{Failure::kNone};
  long failure_tick{0};
  long ticks{0};
};

class VirtualDeviceRig final : public Rig {
 public:
  device::Device& device() override { return *device_; }
  double compliance() const override { return 1.0 / 400.0; }
  void place(const Vector3d& p) override { handle_.mass.set_anchor(p); }
  std::vector<RigFailure> failures() const override {
    return {{Failure::kNotFinite, "not finite"}, {Failure::kJump, "jump"}};
  }
  void fail(Failure failure, long tick) override {
    handle_.failure = failure;
    handle_.failure_tick = tick;
  }
  double force_after_close() override { return 0.0; }

 private:
  BreakableMass handle_;
  std::optional<device::VirtualDevice> device_{std::in_place, fine_electronics(), handle_,
                                               kRigRate};
};

class MouseRig final : public Rig {
 public:
  device::Device& device() override { return device_; }
  double compliance() const override { return 1.0 / 400.0; }
  void place(const Vector3d& p) override {
    device_.move(p.x(), p.z());
    device_.press(-p.y() / compliance());
  }
  bool press_button() override {
    device_.set_buttons(1);
    return true;
  }
  double force_after_close() override { return 0.0; }

 private:
  static device::MouseParameters parameters() {
    device::MouseParameters p;
    p.electronics = fine_electronics();
    return p;
  }
  device::MouseDevice device_{parameters(), kRigRate};
};

/// A hand that goes round in a circle.
class ReplayRig final : public Rig {
 public:
  ReplayRig() { fail(Failure::kNone, 0); }
  device::Device& device() override { return *device_; }
  void place(const Vector3d& p) override {
    device_.emplace(std::vector<PointState>(20000, {p, Vector3d::Zero()}), kRigRate);
  }
  std::vector<RigFailure> failures() const override {
    return {{Failure::kLostLink, "end of the recording"},
            {Failure::kNotFinite, "not finite"},
            {Failure::kJump, "jump"}};
  }
  void fail(Failure failure, long tick) override {
    std::vector<PointState> hand;
    for (int i = 0; i < 20000; ++i) {
      const double angle = 4.0 * i / kRigRate;
      hand.push_back({0.02 * Vector3d(std::cos(angle), 0.0, std::sin(angle)),
                      0.08 * Vector3d(-std::sin(angle), 0.0, std::cos(angle))});
    }
    if (failure == Failure::kLostLink) {
      hand.resize(static_cast<std::size_t>(tick));
    } else if (failure == Failure::kNotFinite) {
      hand[static_cast<std::size_t>(tick)].velocity.x() = kNan;
    } else if (failure == Failure::kJump) {
      hand[static_cast<std::size_t>(tick)].position.y() = 0.02;
    }
    device_.emplace(std::move(hand), kRigRate);
  }
  double force_after_close() override { return 0.0; }

 private:
  std::optional<device::ReplayDevice> device_;
};

double norm(const double (&v)[3]) { return std::hypot(v[0], v[1], v[2]); }

class ForceDimensionRig final : public Rig {
 public:
  explicit ForceDimensionRig(const std::string& library) : stand_in_(library) {
    device_.emplace(device::ForceDimensionParameters{}, kRigRate, stand_in_.path);
  }
  device::Device& device() override { return *device_; }
  double compliance() const override { return 1.0 / 200.0; }
  void place(const Vector3d& p) override {
    const double theirs[3] = {p.z(), p.x(), p.y()};  // to the user, right, up
    stand_in_.place(theirs);
  }
  bool press_button() override {
    stand_in_.buttons(1);
    return true;
  }
  std::vector<RigFailure> failures() const override {
    return {{Failure::kLostLink, "lost link"},
            {Failure::kTimeout, "time-out"},
            {Failure::kNotFinite, "not finite"},
            {Failure::kJump, "jump"},
            {Failure::kForcesOffByButton, "forces off by button"},
            {Failure::kForcesOffByVelocity, "forces off by velocity"},
            {Failure::kForcesOffByWatchdog, "forces off by watchdog"},
            {Failure::kForceRefused, "force refused"},
            {Failure::kSlowCall, "slow call", true},
            {Failure::kSaturated, "saturated", true},
            {Failure::kTimeGuard, "time guard", true}};
  }
  void fail(Failure failure, long tick) override {
    stand_in_.fail(static_cast<int>(failure), tick + 1);  // one force is set at the start
  }
  double force_after_close() override {
    device_.reset();
    const StandInView seen = stand_in_.look();
    return seen.forces_on || seen.open ? kNan : norm(seen.force);
  }

 private:
  StandIn stand_in_;
  std::optional<device::ForceDimensionDevice> device_;
};

class OpenHapticsRig final : public Rig {
 public:
  OpenHapticsRig() : stand_in_("stand_in_hd") {
    stand_in_.manual(1);
    device_.emplace(device::OpenHapticsParameters{}, kRigRate, stand_in_.path);
  }
  ~OpenHapticsRig() override {
    device_.reset();
    stand_in_.manual(0);
  }
  device::Device& device() override { return *device_; }
  void period() override { stand_in_.step(); }
  double compliance() const override { return 1.0 / 200.0; }
  void place(const Vector3d& p) override {
    const double theirs[3] = {1e3 * p.x(), 1e3 * p.y(), 1e3 * p.z()};  // [mm]
    stand_in_.place(theirs);
  }
  bool press_button() override {
    stand_in_.buttons(1);
    return true;
  }
  std::vector<RigFailure> failures() const override {
    return {{Failure::kLostLink, "lost link", false, 1},
            {Failure::kTimeout, "time-out", false, 1},
            {Failure::kNotFinite, "not finite", false, 1},
            {Failure::kJump, "jump", false, 1},
            {Failure::kForcesOffByVelocity, "forces off by velocity", false, 1},
            {Failure::kMotorsWarm, "motors warm", false, 1},
            {Failure::kForceRefused, "force refused", false, 1},
            {Failure::kStall, "stall", false, 21}};
  }
  void fail(Failure failure, long tick) override {
    stand_in_.fail(static_cast<int>(failure), tick);
  }
  double force_after_close() override {
    device_.reset();
    const StandInView seen = stand_in_.look();
    return seen.forces_on || seen.open ? kNan : norm(seen.force);
  }

 private:
  StandIn stand_in_;
  std::optional<device::OpenHapticsDevice> device_;
};

/// An Inverse3 whose service is stepped by hand.
class HaplyRig final : public Rig {
 public:
  HaplyRig() { open(1.0); }  // a busy machine may be slow to step
  ~HaplyRig() override { device_.reset(); }
  device::Device& device() override { return *device_; }
  void period() override { service_.step(); }
  double compliance() const override { return 1.0 / StandInHandle::kStiffness; }
  void place(const Vector3d& p) override {
    const double theirs[3] = {p.x(), -p.z(), p.y()};  // to the right, away from the user, up
    service_.with_handle([&](StandInHandle& handle) { handle.place(theirs); });
  }
  bool press_button() override {
    service_.with_handle([](StandInHandle& handle) { handle.buttons = 1; });
    return true;
  }
  std::vector<RigFailure> failures() const override {
    return {{Failure::kLostLink, "lost link"},
            {Failure::kMalformed, "half a state"},
            {Failure::kMissingField, "missing field"},
            {Failure::kNotFinite, "not a number"},
            {Failure::kOtherDevice, "state of another device"},
            {Failure::kNoGrip, "lost grip"},
            {Failure::kNoPower, "no power"},
            {Failure::kJump, "jump"},
            {Failure::kButton, "stop button"},
            {Failure::kStall, "stall", false, 21},
            {Failure::kLate, "late states", true},
            {Failure::kDoubled, "doubled states", true},
            {Failure::kMissing, "missing states", true}};
  }
  void fail(Failure failure, long tick) override {
    open(0.02);
    service_.fail(failure, tick);
  }
  double force_after_close() override {
    device_.reset();
    while (service_.has_client()) {  // it answers what was sent before the end
      service_.step();
    }
    return service_.force_size();
  }

 private:
  void open(double patience) {
    device::HaplyParameters parameters;
    parameters.port = service_.port();
    parameters.patience = patience;
    device_.reset();
    device_.emplace(parameters, kRigRate);
  }
  HaplyService service_{{.rate = 0.0}};
  std::optional<device::HaplyDevice> device_;
};

/// A board on a pseudo-terminal, whose time the suite lets pass.
class BoardRig final : public Rig {
 public:
  using Open = std::unique_ptr<device::SerialBoard>(const std::string& port);
  BoardRig(std::unique_ptr<BoardFirmware> firmware, const Vector3d& free, Open* open)
      : board_(std::move(firmware), free) {
    board_.start();
    device_ = open(board_.port());
    board_.stop();
  }
  device::Device& device() override { return *device_; }
  void period() override {
    board_.step([this] { return device_->readings(); });
  }
  bool period_is_the_drivers() const override { return false; }
  double compliance() const override { return 1.0 / 400.0; }
  void place(const Vector3d& p) override { board_.mass.set_anchor(p); }
  bool press_button() override {
    board_.buttons = 1;
    return !board_.firmware().answers();
  }
  std::vector<RigFailure> failures() const override {
    return {{Failure::kLostLink, "lost link", false, 21},
            {Failure::kTimeout, "silent", false, 21},
            {Failure::kNotFinite, "not finite", false, 21},
            {Failure::kStall, "torn", false, 21},
            {Failure::kHang, "noise", false, 21},
            {Failure::kJump, "jump", false, 1},
            {Failure::kSlowCall, "late", true},
            {Failure::kSaturated, "doubled", true},
            {Failure::kTimeGuard, "every other is missing", true}};
  }
  void fail(Failure failure, long tick) override {
    static const std::map<Failure, BoardFailure> kOfBoards{
        {Failure::kLostLink, BoardFailure::kUnplugged},
        {Failure::kTimeout, BoardFailure::kSilent},
        {Failure::kNotFinite, BoardFailure::kNotFinite},
        {Failure::kStall, BoardFailure::kTorn},
        {Failure::kHang, BoardFailure::kNoise},
        {Failure::kJump, BoardFailure::kJump},
        {Failure::kSlowCall, BoardFailure::kLate},
        {Failure::kSaturated, BoardFailure::kDoubled},
        {Failure::kTimeGuard, BoardFailure::kEveryOther}};
    board_.fail(kOfBoards.at(failure), tick);
  }
  double force_after_close() override {
    device_.reset();
    board_.drain();
    return board_.force().norm();
  }

 private:
  SimulatedBoard board_;
  std::unique_ptr<device::SerialBoard> device_;
};

std::unique_ptr<Rig> pantograph_rig() {
  return std::make_unique<BoardRig>(std::make_unique<HapiFirmware>(), Vector3d(1.0, 0.0, 1.0),
                                    [](const std::string& port) {
                                      device::HapiParameters parameters;
                                      parameters.line.port = port;
                                      return device::open_hapi_board(parameters, kRigRate);
                                    });
}

std::unique_ptr<Rig> paddle_rig() {
  return std::make_unique<BoardRig>(
      std::make_unique<PaddleFirmware>(), Vector3d::UnitX(), [](const std::string& port) {
        return device::open_paddle_board(example_paddle(port), kRigRate);
      });
}

}  // namespace

device::PaddleParameters example_paddle(const std::string& port) {
  device::PaddleParameters parameters;
  parameters.line.port = port;
  parameters.columns = {"-", "x", "buttons"};
  parameters.position_scale = -1e-3;
  parameters.position_zero = 100.0;
  parameters.command = "T{x}";
  parameters.force_scale = 0.08;
  return parameters;
}

std::vector<RigKind> every_rig() {
  return {
      {"virtual", []() -> std::unique_ptr<Rig> { return std::make_unique<VirtualDeviceRig>(); }},
      {"replay", []() -> std::unique_ptr<Rig> { return std::make_unique<ReplayRig>(); }},
      {"mouse", []() -> std::unique_ptr<Rig> { return std::make_unique<MouseRig>(); }},
      {"force_dimension",
       []() -> std::unique_ptr<Rig> {
         return std::make_unique<ForceDimensionRig>("stand_in_dhd");
       }},
      {"force_dimension_without_drd",
       []() -> std::unique_ptr<Rig> {
         return std::make_unique<ForceDimensionRig>("stand_in_dhd_only");
       }},
      {"open_haptics", []() -> std::unique_ptr<Rig> { return std::make_unique<OpenHapticsRig>(); }},
      {"haply", []() -> std::unique_ptr<Rig> { return std::make_unique<HaplyRig>(); }},
      {"hapi", pantograph_rig},
      {"paddle", paddle_rig}};
}

}  // namespace haptrial::test
