#include "experiments/studies/drilling/drilling_learning.h"

#include "analysis/bone_drilling/report/learned_quantities.h"
#include "core/base/definition/table.h"
#include "experiments/studies/learning_names.h"
#include "protocols/bone_drilling/definition/bone_definition.h"

namespace haptrial::experiments {

analysis::LearningPlan read_drilling_learning(Table& root,
                                              const protocols::BoneDefinition* definition) {
  const auto names =
      definition == nullptr ? analysis::LearningNames{} : learning_names(*definition);
  return analysis::read_learning_plan(root, names, analysis::drilling::drilling_outcomes());
}

}  // namespace haptrial::experiments
