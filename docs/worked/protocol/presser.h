#pragma once

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "core/device/virtual_device.h"
#include "core/subject/hand.h"
#include "protocols/interface/rig.h"
#include "spring_pass.h"
#include "springs_definition.h"

/// The virtual participant: presses with 3 N, remembers how stiff each spring felt, and answers.
class Presser final : public haptrial::protocols::Rig, public haptrial::stimulus::Observer {
 public:
  Presser(const SpringsDefinition& d, std::uint64_t seed)
      : hand_(d.hand, 1.0 / d.rate, Eigen::Vector3d::Zero()), device_(d.device, hand_, d.rate) {
    constexpr double kWeber = 0.08;
    for (int trial = 1; trial <= d.design.trials; ++trial) {  // the same whenever it comes
      haptrial::RandomStream random(seed, "judgement " + std::to_string(trial));
      noise_.push_back(kWeber * d.standard * std::sqrt(2.0) * random.normal());
    }
  }
  haptrial::device::Device& device() override { return device_; }
  haptrial::stimulus::Observer* subject() override { return this; }

  void observe(const haptrial::stimulus::Shown& shown, const haptrial::stimulus::Forces& forces,
               double) noexcept override {
    const SpringView* view = shown.as<SpringView>();
    const int interval = view != nullptr ? view->interval : 0;
    haptrial::subject::HandCommand command;
    command.press = interval > 0 ? 3.0 : 0.0;
    hand_.command(command);
    constexpr double kDeepEnough = 0.002;  // [m]
    if (interval > 0 && shown.tool.y() < -kDeepEnough) {
      felt_[interval - 1] = forces[0].y() / -shown.tool.y();
    }
    std::uint32_t button = 0;
    if (view != nullptr && view->asked) {
      const double noise = noise_[static_cast<std::size_t>(view->trial - 1)];
      button = felt_[0] + noise > felt_[1] ? 1u : 2u;
    }
    device_.hold(button, 0.0, Eigen::Quaterniond::Identity());
  }

 private:
  haptrial::subject::Hand hand_;
  haptrial::device::VirtualDevice device_;
  std::vector<double> noise_;
  std::array<double, 2> felt_{};
};
