#include "analysis/statistics/design/interval_word.h"

#include <fmt/format.h>

#include "analysis/document/number.h"

namespace haptrial::analysis {

std::string interval_word(const Defined<MeanInterval>& m) {
  return m ? fmt::format("{} [{}, {}]", number(m->mean), number(m->low), number(m->high)) : "–";
}

}  // namespace haptrial::analysis
