#include "experiments/command/line/shipped_studies.h"

#include "experiments/studies/drilling/bone_study.h"
#include "experiments/studies/force/force_study.h"
#include "experiments/studies/psychophysics/trials_study.h"
#include "experiments/studies/registry.h"

namespace haptrial::experiments {

void add_shipped_studies() {
  add_study(force_study());
  add_study(bone_study());
  add_study(trials_study());
}

}  // namespace haptrial::experiments
