#include "experiments/command/deform/calibration_loads.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "core/base/error.h"
#include "core/deformable/calibration/made_loads.h"
#include "experiments/command/deform/deform_files.h"

namespace haptrial::experiments {
namespace {

using deformable::CalibrationLoad;
using deformable::LoadCase;
using deformable::StaticSolver;
using Eigen::Vector3d;

/// Answers by elements, whose solver is made at the first one.
class Answers {
 public:
  Answers(const DeformBody& body, const MemoryBudget& budget)
      : body_(body), budget_(budget), elastic_(body.mesh, body.elasticity) {}

  std::vector<Vector3d> displacement(const LoadCase& load) {
    if (!solver_) {
      solver_.emplace(static_solver(body_, elastic_, budget_));
    }
    return solver_->solve(load).displacement;
  }

  CalibrationLoad answer(const NamedLoad& load) {
    const auto file = body_.setup.path_of(load.setup.reference);
    const bool given = !load.setup.reference.empty();
    CalibrationLoad answer{load.load, {}, {}};
    if (given && has_markers(file)) {
      answer.markers = read_markers(file, body_.mesh);
    } else if (given) {
      answer.reference = moved_by(body_.mesh, read_displacements(file, body_.mesh));
    }
    if (answer.reference.empty()) {
      answer.reference = moved_by(body_.mesh, displacement(load.load));
    }
    return answer;
  }

  /// The load is halved until elements can answer it: a push that moves a body by as much as
  /// others may tear it where it acts.
  CalibrationLoad answer_smaller(LoadCase load) {
    constexpr int kHalvings = 6;
    for (int i = 0;; ++i) {
      try {
        return {load, moved_by(body_.mesh, displacement(load)), {}};
      } catch (const InputError&) {
        if (i == kHalvings) {
          throw;
        }
      }
      for (deformable::NodalForce& nodal : load.forces) {
        nodal.force *= 0.5;
      }
    }
  }

 private:
  const DeformBody& body_;
  const MemoryBudget& budget_;
  deformable::ElasticBody elastic_;
  std::optional<StaticSolver> solver_;
};

std::vector<LoadCase> made_cases(const DeformBody& body, const std::vector<AnsweredLoad>& loads,
                                 int made, const MemoryBudget& budget) {
  std::vector<LoadCase> seen;
  std::vector<std::vector<Vector3d>> given;
  for (const AnsweredLoad& load : loads) {
    if (load.part != LoadPart::kSeen) {
      continue;
    }
    seen.push_back(load.named.load);
    std::vector<Vector3d>& displacement = given.emplace_back(load.answer.reference);
    for (std::size_t v = 0; v < displacement.size(); ++v) {
      displacement[v] -= body.mesh.vertices[v];
    }
  }
  deformable::Elasticity linear = body.elasticity;
  linear.law = deformable::Law::kLinear;
  const deformable::ElasticBody elastic(body.mesh, linear);
  StaticSolver solver = static_solver(body, elastic, budget);
  Progress progress("making loads", 0.0);
  const auto response = [&](LoadCase load) {
    check_interrupt();
    constexpr double kSmall = 1e-6;  // turns nothing inside out
    for (deformable::NodalForce& nodal : load.forces) {
      nodal.force *= kSmall;
    }
    std::vector<Vector3d> displacement = solver.solve(load).displacement;
    for (Vector3d& u : displacement) {
      u /= kSmall;
    }
    return displacement;
  };
  return deformable::made_loads(body.mesh, deformable::common_holds(seen), given,
                                static_cast<std::size_t>(made), response);
}

void check_makes(const std::vector<NamedLoad>& loads) {
  for (const NamedLoad& load : loads) {
    if (!load.setup.reference.empty() && !load.setup.unseen) {
      throw InputError(fmt::format(
          "load '{}' has a reference from a file; loads that are made (--made) get theirs from "
          "elements and would mix the two; leave --made out, or mark the load as unseen",
          load.load.name));
    }
  }
}

}  // namespace

std::vector<AnsweredLoad> answered_loads(const DeformBody& body,
                                         const std::vector<NamedLoad>& loads, int made,
                                         const MemoryBudget& budget) {
  if (std::ranges::all_of(loads, [](const NamedLoad& load) { return load.setup.unseen; })) {
    throw InputError("calibration: every load is unseen; one at least must be seen");
  }
  if (made > 0) {
    check_makes(loads);
  }
  Answers answers(body, budget);
  std::vector<AnsweredLoad> result;
  Progress progress("reference", static_cast<double>(loads.size()) + made);
  const auto add = [&](AnsweredLoad load) {
    result.push_back(std::move(load));
    progress.update(static_cast<double>(result.size()), result.back().named.load.name, 0.0);
    check_interrupt();
  };
  for (const NamedLoad& load : loads) {
    add({load, answers.answer(load), load.setup.unseen ? LoadPart::kUnseen : LoadPart::kSeen});
  }
  if (made == 0) {
    return result;
  }
  bool held_out = false;
  for (const LoadCase& load : made_cases(body, result, made, budget)) {
    add({{{}, load, false},
         answers.answer_smaller(load),
         held_out ? LoadPart::kHeldOut : LoadPart::kSeen});
    held_out = !held_out;
  }
  return result;
}

std::vector<CalibrationLoad> answers_of(const std::vector<AnsweredLoad>& loads, LoadPart part) {
  std::vector<CalibrationLoad> result;
  for (const AnsweredLoad& load : loads) {
    if (load.part == part) {
      result.push_back(load.answer);
    }
  }
  return result;
}

}  // namespace haptrial::experiments
