#include "experiments/studies/drilling/drilling_learning.h"

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "protocols/definition/groups.h"

namespace haptrial::experiments {

analysis::drilling::LearningNames learning_names(const protocols::BoneDefinition& d) {
  analysis::drilling::LearningNames names;
  for (const protocols::StudyGroup& group : protocols::study_groups(d.text, d.file_name)) {
    names.groups.push_back(group.name);
  }
  for (int session = 1; session <= d.sessions(); ++session) {
    names.sessions.push_back(d.session_name(session));
    if (!d.session_plan(session).gives) {
      names.tests.push_back(d.session_name(session));
    }
  }
  return names;
}

analysis::drilling::LearningPlan read_drilling_learning(Table& root) {
  analysis::drilling::LearningNames names;
  try {
    // A document of its own: what is wrong with it was noted by who read the definition.
    Table copy = root.unread();
    names = learning_names(protocols::read_bone_definition(copy, "", nullptr));
  } catch (const InputError&) {
    names = {};
  }
  return analysis::drilling::read_learning_plan(root, names);
}

}  // namespace haptrial::experiments
