#include "analysis/statistics/design/design_effects.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "analysis/statistics/variance/anova.h"
#include "analysis/statistics/variance/multifactor_anova.h"
#include "analysis/statistics/variance/repeated_anova.h"

namespace haptrial::analysis {
namespace {

using Effects = std::vector<Defined<EffectTest>>;
using Rows = std::vector<std::vector<double>>;

Rows rows_of(const DesignTable& table, const std::vector<std::size_t>& subjects,
             const std::vector<std::size_t>& cells) {
  Rows rows;
  for (const std::size_t s : subjects) {
    auto& row = rows.emplace_back();
    for (const std::size_t cell : cells) {
      row.push_back(*table.means[s][cell]);
    }
  }
  return rows;
}

std::vector<std::size_t> all_cells(const DesignTable& table) {
  std::vector<std::size_t> cells(table.cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    cells[i] = i;
  }
  return cells;
}

/// Participants' means by cell, where everybody has one cell.
Rows groups_of(const DesignTable& table) {
  Rows groups(table.cells.size());
  for (const auto& row : table.means) {
    for (std::size_t cell = 0; cell < row.size(); ++cell) {
      if (row[cell]) {
        groups[cell].push_back(*row[cell]);
      }
    }
  }
  return groups;
}

EffectTest described(const std::string& factor, const std::string& test, double f, double df,
                     double df_error, double p) {
  EffectTest effect{factor, test, f, df, df_error, p, std::nullopt};
  effect.size = partial_eta_squared(f, df, df_error);
  return effect;
}

Defined<EffectTest> described(const std::string& factor, const std::string& test,
                              const MultifactorEffect& found) {
  if (!found.test) {
    return Undefined{found.test.because()};
  }
  EffectTest effect = described(factor, test, found.test->f, found.test->df, found.test->df_error,
                                found.test->p_greenhouse_geisser);
  if (!found.within.empty() && found.test->df > 1.0) {
    effect.epsilon = found.test->sphericity.greenhouse_geisser;
  }
  return effect;
}

Effects one_within(const DesignTable& table) {
  const auto found = repeated_measures_anova(rows_of(table, table.complete(), all_cells(table)));
  if (!found) {
    return {Undefined{found.because()}};
  }
  EffectTest effect = described(table.factors[0].name, "repeated-measures analysis of variance",
                                found->f, found->df_condition, found->df_error, found->p_corrected);
  if (found->df_condition > 1.0) {
    effect.epsilon = found->epsilon;
  }
  return {effect};
}

Effects one_between(const DesignTable& table) {
  const auto found = welch_anova(groups_of(table));
  if (!found) {
    return {Undefined{found.because()}};
  }
  return {described(table.factors[0].name, "Welch's analysis of variance", found->f,
                    found->df_between, found->df_within, found->p)};
}

/// The cell of a participant under levels of the factors within.
/// @param cell  any of the participant's  @param number  of the levels, the last running fastest
std::size_t cell_within(const DesignTable& table, std::size_t cell,
                        const std::vector<std::size_t>& within, std::size_t number) {
  std::vector<std::size_t> levels = table.cells[cell];
  for (std::size_t f = within.size(); f-- > 0;) {
    const std::size_t count = table.factors[within[f]].levels.size();
    levels[within[f]] = number % count;
    number /= count;
  }
  return static_cast<std::size_t>(std::ranges::find(table.cells, levels) - table.cells.begin());
}

MultifactorTable multifactor_table(const DesignTable& table, const std::vector<std::size_t>& within,
                                   const std::vector<std::size_t>& between) {
  MultifactorTable values;
  std::size_t cells = 1;
  for (const std::size_t f : within) {
    values.within.push_back(table.factors[f].levels.size());
    cells *= values.within.back();
  }
  for (const std::size_t f : between) {
    values.between.push_back(table.factors[f].levels.size());
  }
  for (const std::size_t s : table.complete()) {
    const auto& means = table.means[s];
    const auto own = static_cast<std::size_t>(
        std::ranges::find_if(means, [](const auto& mean) { return mean.has_value(); }) -
        means.begin());
    auto& row = values.values.emplace_back();
    for (std::size_t number = 0; number < cells; ++number) {
      row.push_back(*means[cell_within(table, own, within, number)]);
    }
    auto& group = values.groups.emplace_back();
    for (const std::size_t f : between) {
      group.push_back(table.cells[own][f]);
    }
  }
  return values;
}

/// The name of the analysis of several factors. @param within, between  how many
std::string name_of_analysis(std::size_t within, std::size_t between) {
  if (within + between > 2) {
    return fmt::format("analysis of variance of {} factors",
                       within + between == 3 ? "three" : "four");
  }
  return within == 2    ? "two-way repeated-measures analysis of variance"
         : between == 2 ? "two-way analysis of variance"
                        : "mixed analysis of variance";
}

/// Two to four factors, each within or between participants.
Effects several(const DesignTable& table) {
  std::vector<std::size_t> within, between;
  for (std::size_t f = 0; f < table.factors.size(); ++f) {
    (table.factors[f].within ? within : between).push_back(f);
  }
  const std::string test = name_of_analysis(within.size(), between.size());
  Effects effects;
  for (const MultifactorEffect& found :
       multifactor_anova(multifactor_table(table, within, between))) {
    std::vector<std::string> names;
    for (const std::size_t f : found.between) {
      names.push_back(table.factors[between[f]].name);
    }
    for (const std::size_t f : found.within) {
      names.push_back(table.factors[within[f]].name);
    }
    effects.push_back(described(fmt::format("{}", fmt::join(names, " × ")), test, found));
  }
  return effects;
}

/// The table without factors of one level, which vary nothing.
DesignTable varied(DesignTable table) {
  for (std::size_t f = table.factors.size(); f-- > 0;) {
    if (table.factors[f].levels.size() < 2) {
      const auto at = static_cast<std::ptrdiff_t>(f);
      table.factors.erase(table.factors.begin() + at);
      for (auto& levels : table.cells) {
        levels.erase(levels.begin() + at);
      }
    }
  }
  return table;
}

}  // namespace

Effects design_effects(const DesignTable& all) {
  const DesignTable table = varied(all);
  const auto& factors = table.factors;
  if (factors.empty() || table.cells.size() < 2) {
    return {Undefined{"there are fewer than two conditions"}};
  }
  if (factors.size() == 1) {
    return factors[0].within ? one_within(table) : one_between(table);
  }
  if (factors.size() > 4) {
    return {Undefined{"there are more than four factors; their cells are compared two by two"}};
  }
  if (!table.crossed) {
    return {Undefined{"some combinations of levels have no trials; cells are compared two by two"}};
  }
  return several(table);
}

Defined<RankAnova> design_ranks(const DesignTable& all) {
  const DesignTable table = varied(all);
  if (table.factors.size() != 1) {
    return Undefined{"it is for one factor"};
  }
  return table.factors[0].within ? friedman(rows_of(table, table.complete(), all_cells(table)))
                                 : kruskal_wallis(groups_of(table));
}

}  // namespace haptrial::analysis
