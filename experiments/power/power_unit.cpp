#include "experiments/power/power_unit.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "core/base/error.h"
#include "core/base/random.h"
#include "core/base/scratch_folder.h"
#include "experiments/control/interrupt.h"
#include "experiments/studies/experiment.h"
#include "experiments/study/study_run.h"

namespace haptrial::experiments {
namespace fs = std::filesystem;
namespace {

/// A cell's definition, and what simulates it.
struct ReadyCell {
  std::unique_ptr<protocols::Definition> definition;
  std::unique_ptr<StudySimulation> study_simulation;
};

ReadyCell ready(const PowerQuestion& question, const PowerUnit& unit) {
  const std::vector<NamedText> parts = question.parts_of(question.cells[unit.cell]);
  ReadyCell cell;
  const protocols::Protocol& protocol = question.study->protocol();
  Table root = Table::parse(parts);
  cell.definition = protocol.read(root, parts.front().file_name, nullptr);
  root.check();
  cell.study_simulation = question.study->study_simulation(*cell.definition, parts.back().file_name,
                                                           question.plan.watch);
  if (unit.sessions) {
    protocol.load(*cell.definition, question.folder);
  }
  return cell;
}

SimulatedStudy in_full(const PowerQuestion& question, const ReadyCell& cell, std::uint64_t seed) {
  const ScratchFolder folder("power");
  DryRun dry;
  dry.participants = cell.definition->design.participants;
  dry.seed = seed;
  dry.folder = folder.path() / "sessions";
  run_dry(question.study->protocol(), *cell.definition, dry);
  return cell.study_simulation->sessions(session_files(dry.folder));
}

}  // namespace

std::string PowerUnit::file() const {
  return fmt::format("{}-{:05}-{:07}.part", sessions ? 's' : 'r', cell, first);
}

std::vector<PowerUnit> units_of(const PowerQuestion& question) {
  const PowerPlan& plan = question.plan;
  const bool sessions = plan.depth == PowerDepth::kSessions;
  std::vector<PowerUnit> units;
  for (std::size_t i = 0; i < question.cells.size(); ++i) {
    const QuestionCell& cell = question.cells[i];
    const int all = cell.null ? plan.null_replications : plan.replications;
    for (int first = 0; first < all; first += plan.block) {
      units.push_back({i, sessions, first, std::min(plan.block, all - first)});
    }
    for (int first = 0; cell.checked && first < plan.checked_replications; ++first) {
      units.push_back({i, true, first, 1});
    }
  }
  return units;
}

std::vector<SimulatedStudy> simulated(const PowerQuestion& question, const PowerUnit& unit) {
  const ReadyCell cell = ready(question, unit);
  const std::uint64_t seed =
      derived_seed(question.plan.seed, "power cell " + question.cells[unit.cell].name);
  std::vector<SimulatedStudy> all;
  for (int i = unit.first; i < unit.first + unit.count; ++i) {
    if (interrupted()) {
      throw RunError("interrupted");
    }
    const std::uint64_t own = derived_seed(seed, fmt::format("replication {}", i));
    try {
      all.push_back(unit.sessions ? in_full(question, cell, own)
                                  : cell.study_simulation->responses(own));
    } catch (const InputError& error) {
      all.emplace_back().failures.push_back(error.what());
    } catch (const RunError& error) {
      if (interrupted()) {
        throw;
      }
      all.emplace_back().failures.push_back(error.what());
    }
  }
  return all;
}

}  // namespace haptrial::experiments
