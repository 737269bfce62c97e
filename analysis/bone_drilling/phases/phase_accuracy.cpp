#include "analysis/bone_drilling/phases/phase_accuracy.h"

#include <set>

namespace haptrial::analysis::drilling {
namespace {

void hold_against(const PhaseModel& model, const PhaseCase& each, Eigen::MatrixXd& ticks) {
  const std::vector<int> found = phases_of(model, each.actions);
  for (std::size_t t = 0; t < found.size(); ++t) {
    if (each.phase[t] >= 0) {
      const Action& action = each.actions[t];
      ticks(each.phase[t], found[t]) += static_cast<double>(action.last + 1 - action.first);
    }
  }
}

}  // namespace

double PhaseAccuracy::right() const {
  const double all = ticks.sum();
  return all > 0.0 ? ticks.trace() / all : 0.0;
}

double PhaseAccuracy::chance() const {
  const double all = ticks.sum();
  return all > 0.0 ? ticks.rowwise().sum().maxCoeff() / all : 0.0;
}

double PhaseAccuracy::kappa() const {
  const double all = ticks.sum();
  if (!(all > 0.0)) {
    return 0.0;
  }
  const double expected =
      ticks.rowwise().sum().dot(ticks.colwise().sum().transpose()) / (all * all);
  return expected < 1.0 ? (right() - expected) / (1.0 - expected) : 0.0;
}

Defined<PhaseAccuracy> left_out_accuracy(std::span<const PhaseCase> cases,
                                         const std::vector<std::string>& phases) {
  std::set<std::string> people;
  for (const PhaseCase& each : cases) {
    people.insert(each.participant);
  }
  if (people.size() < 2) {
    return Undefined{"there are fewer than two participants"};
  }
  const auto count = static_cast<Eigen::Index>(phases.size());
  PhaseAccuracy accuracy{Eigen::MatrixXd::Zero(count, count)};
  for (const std::string& person : people) {
    std::vector<PhaseCase> others;
    for (const PhaseCase& each : cases) {
      if (each.participant != person) {
        others.push_back(each);
      }
    }
    const Defined<PhaseModel> model = learn_phases(others, phases);
    if (!model) {
      return Undefined{"without " + person + " " + model.because()};
    }
    for (const PhaseCase& each : cases) {
      if (each.participant == person) {
        hold_against(*model, each, accuracy.ticks);
      }
    }
  }
  return accuracy;
}

}  // namespace haptrial::analysis::drilling
