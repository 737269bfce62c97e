#include "experiments/preview/tried_pass.h"

#include <utility>

namespace haptrial::experiments {

TriedPass::TriedPass(const protocols::Definition& definition, const Eigen::Vector3d& start)
    : rate_(definition.rate), start_(start), mouse_(page_hand(definition, start)) {}

void TriedPass::begin(std::unique_ptr<protocols::Pass> pass) {
  pass_ = std::move(pass);
  pass_->begin(0);
  output_ = {};
}

TriedTrial::Moment TriedPass::tick(const Eigen::Vector3d& pointer) {
  before_tick();
  mouse_.reach({pointer, Eigen::Quaterniond::Identity()});
  device::DeviceReading reading;
  mouse_.read(reading);
  reading.buttons = buttons_;
  output_ = is_over() ? protocols::PassOutput{} : pass_->tick(reading, 1.0 / rate_);
  mouse_.write({output_.force});
  return {reading.tool, output_.force};
}

}  // namespace haptrial::experiments
