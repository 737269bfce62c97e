#include "experiments/command/deform/calibration_run.h"

namespace haptrial::experiments {

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
