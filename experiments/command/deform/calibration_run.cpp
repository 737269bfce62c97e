#include "experiments/command/deform/calibration_run.h"

#include "core/base/parallel.h"

namespace haptrial::experiments {
namespace {

using deformable::CalibrationProblem;
using deformable::SpringBody;

/// Measures of one load with the constants set by hand and those found.
JudgedLoad judged(const AnsweredLoad& given, const SpringBody& springs,
                  const deformable::SpringConstants& hand,
                  const deformable::SpringConstants& constants) {
  const CalibrationProblem alone(springs, {given.answer});
  JudgedLoad load;
  load.name = given.named.load.name;
  load.part = given.part;
  load.reference = given.named.setup.reference.empty() ? "elements" : given.named.setup.reference;
  load.markers = !given.answer.markers.empty();
  load.moved = load_error(given.answer, springs.rest);
  load.at_reference = given.answer.reference;
  load.hand = alone.error(hand, false).mean;
  load.at_hand = alone.rest(hand, 0);
  const auto found = alone.error(constants, false);
  load.found = found.mean;
  load.unstable = found.unstable;
  load.at_found = alone.rest(constants, 0);
  if (load.unstable.empty()) {
    load.shape = load_error(given.answer, load.at_found, deformable::ErrorMeasure::kShape);
    const double wanted = way_of_tool(given.answer.load, springs.rest, given.answer.reference);
    load.force = wanted / way_of_tool(given.answer.load, springs.rest, load.at_found) - 1.0;
  }
  return load;
}

}  // namespace

void judge_loads(const std::vector<AnsweredLoad>& loads, const SpringBody& springs,
                 const deformable::SpringConstants& hand, int threads, CalibrationRun& run) {
  run.loads.resize(loads.size());
  parallel_for(loads.size(), threads,
               [&](std::size_t i) { run.loads[i] = judged(loads[i], springs, hand, run.springs); });
}

double seen_error(const CalibrationRun& run, bool by_hand) {
  double sum = 0.0;
  int seen = 0;
  for (const JudgedLoad& load : run.loads) {
    if (load.part == LoadPart::kSeen) {
      sum += by_hand ? load.hand : load.found;
      ++seen;
    }
  }
  return sum / seen;
}

double share_left(const CalibrationRun& run, LoadPart part) {
  double sum = 0.0;
  int loads = 0;
  for (const JudgedLoad& load : run.loads) {
    if (load.part == part) {
      sum += load.found / load.moved;
      ++loads;
    }
  }
  return loads == 0 ? NAN : sum / loads;
}

}  // namespace haptrial::experiments
