#include "analysis/psychophysics/study/covariate.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>
#include <string>

#include "core/base/error.h"

namespace haptrial::analysis::trials {

void add_covariate(const std::vector<PageScore>& scores, Covariate& covariate) {
  if (covariate.name.empty()) {
    return;
  }
  std::set<std::string> known;
  for (const PageScore& score : scores) {
    const std::string name = score.page + "." + score.score;
    known.insert(name);
    if (name == covariate.name) {
      covariate.values.emplace(score.participant, score.value);
    }
  }
  if (covariate.values.empty()) {
    throw InputError(fmt::format(
        "analysis.covariate is \"{}\", of which no session has a score; {}", covariate.name,
        known.empty() ? std::string("no page was answered with one")
                      : fmt::format("there are: {}", fmt::join(known, ", "))));
  }
}

}  // namespace haptrial::analysis::trials
