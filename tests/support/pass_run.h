#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "core/device/virtual_device.h"
#include "protocols/force_training/trajectory_pass.h"
#include "protocols/interface/session_task.h"
#include "tests/support/hand_on_handle.h"

namespace haptrial::test {

/// How often, and how late in ticks a force is.
struct Loop {
  double rate;
  int delay;
};
/// A pass that runs on a loop, tick by tick.
class PassRun {
 public:
  PassRun(protocols::Pass& pass, const Loop& loop, double hand) : loop_(loop), hand_(hand) {
    device::VirtualDeviceParameters parameters;
    parameters.force_delay = loop.delay;
    parameters.velocity_window = 8;
    device_ = std::make_unique<device::VirtualDevice>(parameters, hand_, loop.rate);
    task_ = std::make_unique<protocols::SessionTask>(
        protocols::SessionTask::Parts{
            .devices = {{device_.get(), device::EnvelopeLimits{}}},
            .loop = {0.22, loop.rate, device::readings_in_window(8, loop.rate), loop.delay},
            .log = log_},
        protocols::SessionTask::Leave::kNever);
    task_->start(pass, 0);
  }

  HandOnHandle& hand() { return hand_; }
  bool idle() const { return task_->idle(); }
  device::Fault fault() const { return task_->result().fault; }

  /// @returns the seconds with the force at its limit.
  double advance(double seconds) {
    int at_limit = 0;
    for (int i = 0; i < static_cast<int>(seconds * loop_.rate) && !task_->idle(); ++i) {
      const auto at =
          static_cast<std::int64_t>(std::llround(1e9 * static_cast<double>(tick_) / loop_.rate));
      task_->tick({tick_++, at, 1.0 / loop_.rate});
      log_.flush([&](auto samples) {
        for (const record::Sample& sample : samples) {
          at_limit += sample.force.norm() >= 0.98 * 12.0;
          stage = sample.stage;
          force = sample.force;
        }
      });
    }
    return at_limit / loop_.rate;
  }
  double advance_to(record::Stage wanted) {
    double at_limit = 0.0;
    for (int i = 0; i < 2000 && stage != wanted && !task_->idle(); ++i) {
      at_limit += advance(0.01);
    }
    return at_limit;
  }

  record::Stage stage{record::Stage::kIdle};
  Eigen::Vector3d force{Eigen::Vector3d::Zero()};

 private:
  Loop loop_;
  HandOnHandle hand_;
  std::unique_ptr<device::VirtualDevice> device_;
  protocols::SessionTask::Log log_;
  std::unique_ptr<protocols::SessionTask> task_;
  std::uint64_t tick_{0};
};

}  // namespace haptrial::test
