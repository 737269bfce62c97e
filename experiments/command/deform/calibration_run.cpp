#include "experiments/command/deform/calibration_run.h"

namespace haptrial::experiments {

double seen_error(const CalibrationRun& run, bool by_hand) {
  double sum = 0.0;
  int seen = 0;
  for (const JudgedLoad& load : run.loads) {
    if (!load.unseen) {
      sum += by_hand ? load.hand : load.found;
      ++seen;
    }
  }
  return sum / seen;
}

}  // namespace haptrial::experiments
