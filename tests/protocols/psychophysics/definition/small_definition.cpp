#include "tests/protocols/psychophysics/definition/small_definition.h"

#include <sstream>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "protocols/psychophysics/definition/every_value.h"

namespace haptrial::protocols {

const char* const kSmallStaircase = R"([procedure]
kind = "staircase"
variable = "level"
range = [310.0, 600.0]
start = 500.0
steps = [40.0, 20.0]
stop = { reversals = 6, trials = 40 }
)";

std::string small_trials(const std::string& procedure, const std::string& more) {
  return R"([experiment]
protocol = "trials"
name = "small"
[design]
participants = 4
[fields.floor]
type = "wall"
point = [0.0, 0.0, 0.0]
normal = [0.0, 1.0, 0.0]
stiffness = "$stiffness"
damping = 0.0
[intervals]
order = "random"
reference = { stiffness = 300.0 }
comparison = { stiffness = "$level" }
[[stages]]
name = "press"
fields = ["floor"]
until = { time = 0.2 }
[response]
question = "Which was stiffer?"
choices = [{ value = "first" }, { value = "second" }]
correct = "$interval.comparison"
)" + procedure +
         more;
}

void read_small(const std::string& text, TrialsDefinition& definition) {
  Table root = Table::parse(text, "small.toml");
  root.leave("observer");
  read_trials_definition(root, "small.toml", definition);
  definition.check_new_session(root);
  root.finish();
}

std::vector<std::string> problems_of_trials(const std::string& text) {
  std::vector<std::string> problems;
  try {
    TrialsDefinition definition;
    read_small(text, definition);
    check_every_value(definition);
  } catch (const InputError& error) {
    std::istringstream in(error.what());
    for (std::string line; std::getline(in, line);) {
      problems.push_back(line);
    }
  }
  return problems;
}

}  // namespace haptrial::protocols
