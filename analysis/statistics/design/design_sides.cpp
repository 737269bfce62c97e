#include "analysis/statistics/design/design_sides.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "core/base/error.h"

namespace haptrial::analysis {
namespace {

/// The mean of a participant's cells of a side; nothing without any.
std::optional<double> side_of(const DesignTable& table, std::size_t subject, const Cells& cells) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const std::size_t cell : cells) {
    if (const auto& mean = table.means[subject][cell]) {
      sum += *mean;
      ++count;
    }
  }
  return count > 0 ? std::optional(sum / static_cast<double>(count)) : std::nullopt;
}

void add(Sides& sides, std::size_t subject, const std::vector<std::size_t>& stratum,
         std::optional<double> first, std::optional<double> second) {
  auto& [in_a, in_b] = sides.strata[stratum];
  if (first) {
    sides.a.push_back(*first);
    sides.subjects_a.push_back(subject);
    in_a.push_back(*first);
  }
  if (second) {
    sides.b.push_back(*second);
    sides.subjects_b.push_back(subject);
    in_b.push_back(*second);
  }
}

std::set<std::size_t> levels_in(const DesignTable& table, const Cells& cells, std::size_t factor) {
  std::set<std::size_t> levels;
  for (const std::size_t cell : cells) {
    levels.insert(table.cells[cell][factor]);
  }
  return levels;
}

/// Factors between participants of which both sides have the same levels, several.
std::vector<std::size_t> factors_across(const DesignTable& table, const Cells& a, const Cells& b) {
  std::vector<std::size_t> across;
  for (std::size_t f = 0; f < table.factors.size(); ++f) {
    const auto levels = levels_in(table, a, f);
    if (!table.factors[f].within && levels.size() > 1 && levels == levels_in(table, b, f)) {
      across.push_back(f);
    }
  }
  return across;
}

/// The combinations of the other factors' levels that some cells have.
std::set<std::vector<std::size_t>> combinations_beside(const DesignTable& table, const Cells& cells,
                                                       std::size_t factor) {
  std::set<std::vector<std::size_t>> combinations;
  for (const std::size_t cell : cells) {
    std::vector<std::size_t> levels = table.cells[cell];
    levels.erase(levels.begin() + static_cast<std::ptrdiff_t>(factor));
    combinations.insert(levels);
  }
  return combinations;
}

bool is_condition(const DesignTable& table, const std::string& side) {
  return std::ranges::find(table.names, side) != table.names.end();
}

/// The factor of which both sides have one level, each another; nothing if there is none.
std::optional<std::size_t> compared_factor(const DesignTable& table, const Cells& a,
                                           const Cells& b) {
  for (std::size_t f = 0; f < table.factors.size(); ++f) {
    const auto in_a = levels_in(table, a, f), in_b = levels_in(table, b, f);
    if (in_a.size() == 1 && in_b.size() == 1 && in_a != in_b) {
      return f;
    }
  }
  return std::nullopt;
}

std::vector<std::size_t> stratum_of(const DesignTable& table, std::size_t subject,
                                    const std::vector<std::size_t>& factors) {
  const auto& means = table.means[subject];
  const auto own = std::find_if(means.begin(), means.end(), [](const auto& m) { return !!m; });
  std::vector<std::size_t> stratum;
  for (const std::size_t f : factors) {
    stratum.push_back(table.cells[static_cast<std::size_t>(own - means.begin())][f]);
  }
  return stratum;
}

}  // namespace

Cells cells_at(const DesignTable& table, std::size_t factor, std::size_t level) {
  Cells cells;
  for (std::size_t cell = 0; cell < table.cells.size(); ++cell) {
    if (table.cells[cell][factor] == level) {
      cells.push_back(cell);
    }
  }
  return cells;
}

Cells cells_of(const DesignTable& table, const std::string& side) {
  const auto cell = std::find(table.names.begin(), table.names.end(), side);
  if (cell != table.names.end()) {
    return {static_cast<std::size_t>(cell - table.names.begin())};
  }
  Cells found;
  for (std::size_t f = 0; f < table.factors.size(); ++f) {
    const auto& levels = table.factors[f].levels;
    const auto level = std::find(levels.begin(), levels.end(), side);
    if (level == levels.end()) {
      continue;
    }
    if (!found.empty()) {
      throw InputError(fmt::format(
          "the planned test of '{}' could mean a level of several factors; name levels differently",
          side));
    }
    found = cells_at(table, f, static_cast<std::size_t>(level - levels.begin()));
  }
  return found;
}

std::vector<std::string> known_sides(const DesignTable& table) {
  std::vector<std::string> known = table.names;
  if (table.factors.size() > 1) {
    for (const Factor& factor : table.factors) {
      known.insert(known.end(), factor.levels.begin(), factor.levels.end());
    }
  }
  return known;
}

std::optional<std::string> why_not_comparable(const DesignTable& table, const PlannedTest& sides,
                                              const Cells& a, const Cells& b) {
  if (a.empty() || b.empty()) {
    return fmt::format("there are no trials of '{}'", a.empty() ? sides.a : sides.b);
  }
  if (table.crossed || is_condition(table, sides.a) || is_condition(table, sides.b)) {
    return std::nullopt;
  }
  const auto factor = compared_factor(table, a, b);
  if (!factor) {
    return std::nullopt;
  }
  const auto of_a = combinations_beside(table, a, *factor);
  const auto of_b = combinations_beside(table, b, *factor);
  // Levels nested in others have no combination in common, and are compared as they are.
  const bool share = std::ranges::any_of(of_a, [&](const auto& c) { return of_b.contains(c); });
  if (of_a == of_b || !share) {
    return std::nullopt;
  }
  return fmt::format(
      "some combinations of levels have no trials, so '{}' and '{}' differ in other factors, too; "
      "name conditions, such as '{}'",
      sides.a, sides.b, table.names.front());
}

Sides values_of(const DesignTable& table, const Cells& a, const Cells& b) {
  const bool single = a.size() == 1 && b.size() == 1;
  std::vector<std::size_t> subjects = table.complete();
  if (single) {
    subjects.resize(table.subjects.size());
    std::iota(subjects.begin(), subjects.end(), std::size_t{0});
  }
  const auto across = factors_across(table, a, b);
  Sides paired;
  paired.paired = true;
  Sides apart;
  for (const std::size_t subject : subjects) {
    const auto first = side_of(table, subject, a);
    const auto second = side_of(table, subject, b);
    const auto stratum = stratum_of(table, subject, across);
    if (first && second) {
      add(paired, subject, stratum, first, second);
    }
    add(apart, subject, stratum, first, second);
  }
  return paired.a.empty() ? apart : paired;
}

}  // namespace haptrial::analysis
