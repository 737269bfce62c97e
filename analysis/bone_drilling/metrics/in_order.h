#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "analysis/bone_drilling/metrics/procedure.h"

namespace haptrial::analysis::drilling {

/// Shows a procedure's rows to a visitor in the order in which they happened; of one tick first the
/// view, then crumbs, the tick itself, removals, cuts.
/// @param visitor  has view(View), crumb(Debris), tick(ToolTick), removal(Removal), cut(Removal)
/// @param through  only rows up to this sequence number; `from` is where each list goes on, and is
///                 brought up to date
template <class Rows, class Visitor>
void visit_in_order(const Rows& rows, Visitor&& visitor, std::array<std::size_t, 5>& from,
                    std::uint64_t through = std::numeric_limits<std::uint64_t>::max()) {
  constexpr std::uint64_t kNone = std::numeric_limits<std::uint64_t>::max();
  const auto next = [](const auto& list, std::size_t at) {
    return at < list.size() ? list[at].sequence : kNone;
  };
  while (true) {
    const std::array<std::uint64_t, 5> due{next(rows.views, from[0]), next(rows.crumbs, from[1]),
                                           next(rows.ticks, from[2]), next(rows.removals, from[3]),
                                           next(rows.cuts, from[4])};
    const auto first = std::min_element(due.begin(), due.end());
    if (*first == kNone || *first > through) {
      return;
    }
    const auto which = static_cast<std::size_t>(first - due.begin());
    const std::size_t at = from[which]++;
    if (which == 0) {
      visitor.view(rows.views[at]);
    } else if (which == 1) {
      visitor.crumb(rows.crumbs[at]);
    } else if (which == 2) {
      visitor.tick(rows.ticks[at]);
    } else if (which == 3) {
      visitor.removal(rows.removals[at]);
    } else {
      visitor.cut(rows.cuts[at]);
    }
  }
}

template <class Visitor>
void visit_in_order(const Procedure& procedure, Visitor&& visitor) {
  std::array<std::size_t, 5> from{};
  visit_in_order(procedure, visitor, from);
}

}  // namespace haptrial::analysis::drilling
