#include "experiments/studies/mark_rule.h"

#include "core/base/definition/schema.h"
#include "core/base/definition/table.h"
#include "core/record/read/marked_trials.h"

namespace haptrial::experiments {

void read_mark_rule(Table& root) {
  if (root.has("analysis")) {
    Table analysis = root.table("analysis");
    record::MarkRule rule;
    record::mark_rule_schema().read(analysis, rule);
  }
}

}  // namespace haptrial::experiments
