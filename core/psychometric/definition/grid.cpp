#include "core/psychometric/definition/grid.h"

#include <fmt/format.h>

#include <cmath>

#include "core/base/definition/schema.h"
#include "core/psychometric/definition/track_keys.h"

namespace haptrial::psychometric {
namespace {

struct SpacedGrid {
  double from{0.0}, to{1.0};
  int count{2};
  bool log{false};  // equal ratios of neighbours, else equal differences
};

const Schema<SpacedGrid>& spaced_grid_schema() {
  using G = SpacedGrid;
  static const auto schema =
      Schema<G>()
          .number("from", &G::from, {}, "", "First value of a grid of levels or parameters")
          .required()
          .number("to", &G::to, {}, "", "Last value of a grid of levels or parameters")
          .required()
          .integer("count", &G::count, 2, 2000, "Number of values of a grid, its ends among them")
          .required()
          .choice("spacing", &G::log, {{"linear", false}, {"log", true}},
                  "Spacing of the values of a grid: equal differences, or equal ratios");
  return schema;
}

const Schema<std::vector<double>>& levels_schema() {
  static const auto schema =
      Schema<std::vector<double>>()
          .custom("levels", "Levels that may be presented: a list, or { from, to, count, spacing }",
                  [](Table& table, const std::string& key, std::vector<double>& levels) {
                    levels = read_grid(table, key);
                  })
          .required()
          .otherwise(kProceduresOwn);
  return schema;
}

}  // namespace

std::vector<double> read_grid(Table& table, const std::string& key) {
  if (table.is_table(key)) {
    Table grid = table.table(key);
    return read_spaced_grid(grid);
  }
  return table.is_array(key) ? table.numbers(key, {}, "")
                             : std::vector<double>{table.number(key, {}, "")};
}

std::vector<double> read_spaced_grid(Table& table) {
  const SpacedGrid grid = spaced_grid_schema().read(table);
  if (!(grid.from < grid.to) || (grid.log && grid.from <= 0.0)) {
    table.reject("from", fmt::format("{}", grid.from),
                 grid.log ? "above 0 and below `to`" : "below `to`");
    return {grid.from};
  }
  std::vector<double> values;
  for (int i = 0; i < grid.count; ++i) {
    const double share = static_cast<double>(i) / (grid.count - 1);
    values.push_back(grid.log ? grid.from * std::pow(grid.to / grid.from, share)
                              : grid.from + share * (grid.to - grid.from));
  }
  return values;
}

std::vector<double> read_levels(const TrackKeys& keys) {
  std::vector<double> levels;
  levels_schema().read(keys.track, keys.procedure, levels);
  return levels;
}

}  // namespace haptrial::psychometric
