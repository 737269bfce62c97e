#include "protocols/bone_drilling/drilling_rig.h"

#include "core/base/random.h"
#include "core/subject/drilling/assisting_hand.h"
#include "core/subject/drilling/drilling_hand.h"
#include "core/subject/drilling/drilling_surgeon.h"

namespace haptrial::protocols {
namespace {

constexpr double kAway = 0.015;  // from the bone, where a surgeon's hand begins [m]

/// Place of the hand before anybody asks anything of it.
Eigen::Vector3d start_of(const BoneDefinition& d) {
  if (d.surgeon && !d.charts.empty()) {
    const subject::DrillingChart& chart = *d.charts.front();
    const auto u = static_cast<int>(chart.end.x() / chart.cell);
    const auto v = static_cast<int>(chart.end.y() / chart.cell);
    const float surface = chart.surface[chart.column(u, v)];
    const double depth =
        surface == subject::DrillingChart::kNone ? 0.0 : static_cast<double>(surface) - kAway;
    return d.drilling.scale * chart.world({chart.end.x(), chart.end.y(), depth});
  }
  if (d.osteotomy_hand) {
    return d.drilling.scale * subject::start_of(*d.osteotomy_hand);
  }
  return d.hand_plan.start - 2.0 * d.hand_plan.hover * d.hand_plan.inward;
}

std::vector<std::shared_ptr<const subject::DrillingChart>> charts_of(const BoneDefinition& d) {
  std::vector<std::shared_ptr<const subject::DrillingChart>> charts;
  for (int procedure = 0; procedure < d.design.trials; ++procedure) {
    charts.push_back(d.charts[static_cast<std::size_t>(procedure) % d.charts.size()]);
  }
  return charts;
}

}  // namespace

struct DrillingRig::Second {
  Second(const BoneDefinition& d, const Eigen::Vector3d& start)
      : hand(d.hand, 1.0 / d.rate, start),
        device(d.device, hand, d.rate),
        person({d.beside}, hand, device, d.drilling.scale),
        limits(d.envelope) {}
  subject::Hand hand;
  device::VirtualDevice device;
  subject::AssistingHand person;
  device::EnvelopeLimits limits;
};

/// Each hand sees the same.
class DrillingRig::BothHands final : public stimulus::Observer {
 public:
  BothHands(stimulus::Observer& first, stimulus::Observer& second)
      : first_(first), second_(second) {}
  void observe(const stimulus::Shown& shown, const stimulus::Forces& forces,
               double dt) noexcept override {
    first_.observe(shown, forces, dt);
    second_.observe(shown, forces, dt);
  }

 private:
  stimulus::Observer& first_;
  stimulus::Observer& second_;
};

DrillingRig::DrillingRig(const BoneDefinition& d, const SessionPlace& place, subject::WorkLog* work)
    : hand_(d.hand, 1.0 / d.rate, start_of(d)), device_(d.device, hand_, d.rate) {
  const std::uint64_t seed = derived_seed(place.hand_session_seed, "subject");
  if (d.surgeon && !d.charts.empty()) {
    subject::SurgeonParameters person = *d.surgeon;
    const std::string group = group_of(d.groups, place.participant);
    const auto skill = d.group_skills.find(group);
    person.skill = skill != d.group_skills.end() ? skill->second : person.skill;
    person.earlier = d.procedures_before(place.session, group);
    subject_ = std::make_unique<subject::DrillingSurgeon>(
        person, charts_of(d), hand_, device_, d.drilling.scale,
        derived_seed(place.hand_person_seed, "subject"), 1.0 / d.rate, work);
  } else if (d.osteotomy_hand && d.osteotomy) {
    const subject::OsteotomyTools tools = subject::osteotomy_tools(d.simulator.tools);
    subject_ = std::make_unique<subject::OsteotomyHand>(
        *d.osteotomy_hand, *d.osteotomy, tools, hand_, device_,
        subject::HandFrame{d.drilling.scale, d.drilling.handle}, seed, 1.0 / d.rate);
  } else {
    subject_ = std::make_unique<subject::DrillingHand>(d.hand_plan, hand_, device_,
                                                       d.drilling.scale, seed, 1.0 / d.rate);
  }
  if (d.drilling.second) {
    second_ = std::make_unique<Second>(d, start_of(d) + d.beside);
    both_ = std::make_unique<BothHands>(*subject_, second_->person);
  }
}

DrillingRig::~DrillingRig() = default;

std::vector<DeviceSet::Arm> DrillingRig::others() {
  return second_ ? std::vector<DeviceSet::Arm>{{&second_->device, second_->limits}}
                 : std::vector<DeviceSet::Arm>{};
}

}  // namespace haptrial::protocols
