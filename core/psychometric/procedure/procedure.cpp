#include "core/psychometric/procedure/procedure.h"

#include <cmath>
#include <stdexcept>

namespace haptrial::psychometric {

void replay(Procedure& procedure, std::span<const Outcome> outcomes) {
  for (const Outcome& outcome : outcomes) {
    procedure.report(outcome.answer, outcome.applied);
  }
}

namespace checks {

void require(bool holds, const char* who, const std::string& sentence) {
  if (!holds) {
    throw std::invalid_argument(std::string(who) + ": " + sentence);
  }
}

void require_running(bool running, const char* who) {
  if (!running) {
    throw std::logic_error(std::string(who) + ": the procedure is finished");
  }
}

std::size_t outcome_of(double answer, std::size_t outcomes, const char* who) {
  const bool known =
      answer >= 0.0 && answer < static_cast<double>(outcomes) && answer == std::floor(answer);
  require(known, who, "answer must be a whole number from 0 to " + std::to_string(outcomes - 1));
  return static_cast<std::size_t>(answer);
}

double single_level(const Level& applied, const char* who) {
  require(applied.size() == 1 && std::isfinite(applied[0]), who,
          "applied must be one finite number");
  return applied[0];
}

}  // namespace checks
}  // namespace haptrial::psychometric
