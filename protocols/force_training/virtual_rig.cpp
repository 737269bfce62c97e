#include "protocols/force_training/virtual_rig.h"

#include <utility>

#include "core/base/random.h"
#include "core/subject/hand.h"
#include "core/subject/hand_cvode.h"

namespace haptrial::protocols {
namespace {

std::unique_ptr<subject::HandModel> make_hand(const ForceDefinition& d) {
  const Eigen::Vector3d start = Eigen::Vector3d::Zero();
  if (d.integrator == Integrator::kCvode) {
    constexpr double kSlipSpeed = 1e-3;  // the smooth friction law is sharp below the guide's speed
    constexpr double kTolerance = 1e-8;
    return std::make_unique<subject::CvodeHand>(d.hand, kSlipSpeed, kTolerance, start);
  }
  return std::make_unique<subject::Hand>(d.hand, 1.0 / d.rate, start);
}

}  // namespace

VirtualRig::VirtualRig(const ForceDefinition& d, std::uint64_t person_seed,
                       std::uint64_t session_seed, std::vector<subject::Lesson> lessons)
    : hand_(make_hand(d)), device_(d.device, *hand_, d.rate) {
  const std::uint64_t seed = derived_seed(person_seed, "subject");
  std::optional<subject::PaceParameters> pace;
  if (d.pace) {
    pace = d.pace->draw(seed);
  }
  std::optional<subject::PathParameters> path;
  if (d.paths) {
    path = d.paths->draw(seed);
  }
  auto person = std::make_unique<subject::VirtualSubject>(d.population.draw(seed), d.hand, *hand_,
                                                          derived_seed(session_seed, "subject"),
                                                          1.0 / d.rate, pace, path);
  person->remember(std::move(lessons));
  subject_ = std::move(person);
}

}  // namespace haptrial::protocols
