#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "experiments/studies/rehearsal/rehearsal.h"

namespace haptrial::experiments {

struct PowerPlan;

/// What goes wrong in some cells of a question.
struct QuestionStrain {
  std::string name;
  std::vector<GivenKey> keys;  // with their values
  double lost{0.0};            // participants: below 1 a share, rounded up, else how many
  std::string refused;         // why it cannot be simulated; empty: it can
};

/// One participant lost, one in ten lost, and what the study itself knows. What changes a key that
/// the question varies is refused.
std::vector<QuestionStrain> strains_of(const Rehearsal& rehearsal, const PowerPlan& plan);

/// The keys of a cell under a strain. @param participants  as planned
std::vector<GivenKey> keys_under(const QuestionStrain& strain, long participants);

}  // namespace haptrial::experiments
