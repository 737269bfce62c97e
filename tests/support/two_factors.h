#pragma once

#include <cstddef>
#include <vector>

#include "analysis/statistics/variance/multifactor_anova.h"

namespace haptrial::test {

/// The analysis of variance of two factors, by the tables in which textbooks write them.
struct TwoFactors {
  analysis::Defined<analysis::WithinEffect> a{analysis::Undefined{""}}, b{analysis::Undefined{""}},
      interaction{analysis::Undefined{""}};
};

using Rows = std::vector<std::vector<double>>;  // (participants x cells)

inline TwoFactors two_factors(const analysis::MultifactorTable& table) {
  const auto found = analysis::multifactor_anova(table);
  return {found[0].test, found[1].test, found[2].test};
}

/// Both within participants; levels of b run fastest in a row.
inline TwoFactors two_within(const Rows& rows, std::size_t levels_a) {
  return two_factors({{levels_a, rows.front().size() / levels_a},
                      {},
                      rows,
                      std::vector<std::vector<std::size_t>>(rows.size())});
}

/// a between participants, b within. @param groups  tables of the levels of a
inline TwoFactors mixed_factors(const std::vector<Rows>& groups) {
  analysis::MultifactorTable table{{groups.front().front().size()}, {groups.size()}, {}, {}};
  for (std::size_t g = 0; g < groups.size(); ++g) {
    for (const auto& row : groups[g]) {
      table.values.push_back(row);
      table.groups.push_back({g});
    }
  }
  return two_factors(table);
}

/// Both between participants. @param cells  values of each, levels of b running fastest
inline TwoFactors two_between(const std::vector<std::vector<double>>& cells, std::size_t levels_a) {
  const std::size_t levels_b = cells.size() / levels_a;
  analysis::MultifactorTable table{{}, {levels_a, levels_b}, {}, {}};
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    for (const double value : cells[cell]) {
      table.values.push_back({value});
      table.groups.push_back({cell / levels_b, cell % levels_b});
    }
  }
  return two_factors(table);
}

}  // namespace haptrial::test
