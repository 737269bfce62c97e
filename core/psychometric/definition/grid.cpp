#include "core/psychometric/definition/grid.h"

#include <fmt/format.h>

#include <cmath>

#include "core/psychometric/definition/track.h"

namespace haptrial::psychometric {

std::vector<double> read_grid(Table& table, const std::string& key) {
  if (table.is_table(key)) {
    Table grid = table.table(key);
    return read_spaced_grid(grid);
  }
  return table.is_array(key) ? table.numbers(key, {}, "")
                             : std::vector<double>{table.number(key, {}, "")};
}

std::vector<double> read_spaced_grid(Table& grid) {
  const double from = grid.number("from", {}, ""), to = grid.number("to", {}, "");
  const auto count = static_cast<int>(grid.integer("count", 2, 2000));
  const bool log = grid.has("spacing") && grid.choice("spacing", {"linear", "log"}) == "log";
  if (!(from < to) || (log && from <= 0.0)) {
    grid.reject("from", fmt::format("{}", from), log ? "above 0 and below `to`" : "below `to`");
    return {from};
  }
  std::vector<double> values;
  for (int i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / (count - 1);
    values.push_back(log ? from * std::pow(to / from, share) : from + share * (to - from));
  }
  return values;
}

Axis read_axis(const TrackKeys& keys, const Track& track) {
  Axis axis;
  if (keys.has("scale")) {
    const std::string scale = keys.of("scale").choice("scale", {"linear", "log10", "decibel"});
    axis.scale = scale == "log10"     ? Scale::kLog10
                 : scale == "decibel" ? Scale::kDecibel
                                      : Scale::kLinear;
  }
  keys.track.otherwise("origin", 0.0);
  axis.origin = keys.has("origin") ? keys.of("origin").number("origin", {}, track.unit) : 0.0;
  if (axis.scale != Scale::kLinear && track.low <= axis.origin) {
    keys.of("scale").reject("scale", "logarithmic", "\"linear\", or a range above the origin");
    axis.scale = Scale::kLinear;
  }
  return axis;
}

}  // namespace haptrial::psychometric
