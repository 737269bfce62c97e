#include "experiments/studies/drilling/drilling_learning.h"

#include "analysis/bone_drilling/report/learned_quantities.h"
#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "experiments/studies/learning_names.h"
#include "protocols/bone_drilling/definition/bone_definition.h"

namespace haptrial::experiments {

analysis::LearningPlan read_drilling_learning(Table& root) {
  analysis::LearningNames names;
  try {
    // A document of its own: what is wrong with it was noted by who read the definition.
    Table copy = root.unread();
    names = learning_names(protocols::read_bone_definition(copy, "", nullptr));
  } catch (const InputError&) {
    names = {};
  }
  return analysis::read_learning_plan(root, names, analysis::drilling::drilling_outcomes());
}

}  // namespace haptrial::experiments
