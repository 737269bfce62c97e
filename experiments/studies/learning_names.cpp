#include "experiments/studies/learning_names.h"

#include "protocols/definition/definition.h"
#include "protocols/definition/groups.h"

namespace haptrial::experiments {

analysis::LearningNames learning_names(const protocols::Definition& d) {
  analysis::LearningNames names;
  for (const protocols::StudyGroup& group : d.groups) {
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

}  // namespace haptrial::experiments
