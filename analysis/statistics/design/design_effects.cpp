#include "analysis/statistics/design/design_effects.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "analysis/statistics/variance/anova.h"
#include "analysis/statistics/variance/factorial_anova.h"
#include "analysis/statistics/variance/mixed_anova.h"
#include "analysis/statistics/variance/multifactor_anova.h"
#include "analysis/statistics/variance/repeated_anova.h"
#include "analysis/statistics/variance/welch_anova.h"

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

Defined<EffectTest> within_effect(const std::string& factor, const std::string& test,
                                  const Defined<WithinEffect>& found) {
  if (!found) {
    return Undefined{found.because()};
  }
  EffectTest effect =
      described(factor, test, found->f, found->df, found->df_error, found->p_greenhouse_geisser);
  if (found->df > 1.0) {
    effect.epsilon = found->sphericity.greenhouse_geisser;
  }
  return effect;
}

Defined<EffectTest> between_effect(const std::string& factor, const std::string& test,
                                   const Defined<Anova>& found) {
  if (!found) {
    return Undefined{found.because()};
  }
  return described(factor, test, found->f, found->df_between, found->df_within, found->p);
}

std::string together(const Factor& a, const Factor& b) { return a.name + " × " + b.name; }

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

Effects two_within(const DesignTable& table) {
  const auto found = two_way_repeated_measures_anova(
      rows_of(table, table.complete(), all_cells(table)), table.factors[0].levels.size());
  if (!found) {
    return {Undefined{found.because()}};
  }
  const char* test = "two-way repeated-measures analysis of variance";
  return {within_effect(table.factors[0].name, test, found->a),
          within_effect(table.factors[1].name, test, found->b),
          within_effect(together(table.factors[0], table.factors[1]), test, found->interaction)};
}

/// @param between, within  which factor is which
Effects mixed(const DesignTable& table, std::size_t between, std::size_t within) {
  std::vector<Rows> groups;
  for (std::size_t level = 0; level < table.factors[between].levels.size(); ++level) {
    std::vector<std::size_t> cells;
    for (std::size_t cell = 0; cell < table.cells.size(); ++cell) {
      if (table.cells[cell][between] == level) {
        cells.push_back(cell);
      }
    }
    std::vector<std::size_t> members;
    for (const std::size_t s : table.complete()) {
      if (table.means[s][cells.front()]) {
        members.push_back(s);
      }
    }
    groups.push_back(rows_of(table, members, cells));
  }
  const auto found = mixed_anova(groups, Squares::kMarginal);
  if (!found) {
    return {Undefined{found.because()}};
  }
  const char* test = "mixed analysis of variance";
  const Factor& group = table.factors[between];
  const Factor& condition = table.factors[within];
  return {between_effect(group.name, test, found->group),
          within_effect(condition.name, test, found->condition),
          within_effect(together(group, condition), test, found->interaction)};
}

Effects two_between(const DesignTable& table) {
  const auto found = two_way_anova(groups_of(table), table.factors[0].levels.size());
  if (!found) {
    return {Undefined{found.because()}};
  }
  const char* test = "two-way analysis of variance";
  return {between_effect(table.factors[0].name, test, found->a),
          between_effect(table.factors[1].name, test, found->b),
          between_effect(together(table.factors[0], table.factors[1]), test, found->interaction)};
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

/// Three or four factors, each within or between participants.
Effects several(const DesignTable& table) {
  std::vector<std::size_t> within, between;
  for (std::size_t f = 0; f < table.factors.size(); ++f) {
    (table.factors[f].within ? within : between).push_back(f);
  }
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
    effects.push_back(within_effect(fmt::format("{}", fmt::join(names, " × ")),
                                    fmt::format("analysis of variance of {} factors",
                                                table.factors.size() == 3 ? "three" : "four"),
                                    found.test));
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
  if (factors.size() > 2) {
    return several(table);
  }
  if (factors[0].within == factors[1].within) {
    return factors[0].within ? two_within(table) : two_between(table);
  }
  return factors[0].within ? mixed(table, 1, 0) : mixed(table, 0, 1);
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
