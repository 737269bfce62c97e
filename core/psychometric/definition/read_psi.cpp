#include "core/psychometric/definition/read_procedures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "core/base/definition/schema.h"
#include "core/psychometric/definition/grid.h"
#include "core/psychometric/definition/track.h"
#include "core/psychometric/definition/track_keys.h"
#include "core/psychometric/procedure/psi_definition.h"

namespace haptrial::psychometric {
namespace {

void read_sigmoid(Table& table, const std::string& key, PsychometricParameters& function) {
  try {
    set_sigmoid(function, table.text(key), Scale::kLog10);
  } catch (const std::invalid_argument& error) {
    table.reject(key, fmt::format("is refused: {}", error.what()));
  }
}

const Schema<PsychometricParameters>& psi_function_schema() {
  using P = PsychometricParameters;
  static const auto schema = Schema<P>()
                                 .number("guess", &P::guess, {0.0, 0.99}, "1",
                                         "Share of answers 1 far below the threshold")
                                 .custom("function", kFunctionText, read_sigmoid)
                                 .otherwise(kFunctionAbsent);
  return schema;
}

/// The levels that a psi may present, as the range of a track.
PsiParameters read_psi_function(const TrackKeys& keys, Track& track) {
  PsiParameters p;
  p.levels = read_levels(keys);
  const auto [least, most] = std::minmax_element(p.levels.begin(), p.levels.end());
  track.low = p.levels.empty() ? 0.0 : *least;
  track.high = p.levels.empty() ? 1.0 : *most;
  p.function.axis = read_axis(keys, track);
  p.function.guess = 0.5;
  psi_function_schema().read(keys.track, keys.procedure, p.function);
  track.falls = p.function.falling;
  return p;
}

/// The levels and, as a threshold may lie beyond what can be presented, as many as half of them on
/// either side, on the axis.
std::vector<double> thresholds_around(const PsiParameters& p, const Track& track) {
  std::vector<double> values = p.levels;
  if (values.size() < 2) {
    return values;
  }
  const Axis& axis = p.function.axis;
  const double low = axis.at(track.low), high = axis.at(track.high);
  const double step = (high - low) / static_cast<double>(values.size() - 1);
  for (std::size_t i = 1; i <= (p.levels.size() + 1) / 2; ++i) {
    values.push_back(axis.level(low - static_cast<double>(i) * step));
    values.push_back(axis.level(high + static_cast<double>(i) * step));
  }
  std::ranges::sort(values);
  return values;
}

void set_default_grids(const Track& track, PsiParameters& p) {
  const Axis& axis = p.function.axis;
  const double span = std::abs(axis.at(track.high) - axis.at(track.low));
  p.threshold.values = thresholds_around(p, track);
  p.width.values = {0.125 * span, 0.25 * span, 0.5 * span, span};
  p.lapse.values = {0.0, 0.02, 0.05};
}

const Schema<PsiParameters>& psi_schema() {
  using P = PsiParameters;
  static const auto schema =
      Schema<P>()
          .custom("threshold",
                  "Thresholds that psi considers: a list, or { from, to, count, spacing }",
                  [](Table& table, const std::string& key, P& p) {
                    p.threshold.values = read_grid(table, key);
                  })
          .otherwise("the levels, and half as far beyond them")
          .custom("width",
                  "Widths of the psychometric function that psi considers, on the axis of the "
                  "scale: a list, or { from, to, count, spacing }",
                  [](Table& table, const std::string& key, P& p) {
                    p.width.values = read_grid(table, key);
                  })
          .otherwise("an eighth, a quarter, half and all of the range")
          .custom("lapse",
                  "Lapse rates that psi considers: a list, or { from, to, count, spacing }",
                  [](Table& table, const std::string& key, P& p) {
                    p.lapse.values = read_grid(table, key);
                  })
          .otherwise("0, 0.02, 0.05")
          .custom("marginal", "Whether psi chooses levels that tell of the threshold alone",
                  [](Table& table, const std::string& key, P& p) {
                    p.width.nuisance = p.lapse.nuisance = table.boolean(key);
                  })
          .otherwise("false");
  return schema;
}

}  // namespace

void read_psi(const TrackKeys& keys, Track& track) {
  const QuestStop stop = read_quest_stop(keys, track);
  PsiParameters p = read_psi_function(keys, track);
  set_default_grids(track, p);
  psi_schema().read(keys.track, keys.procedure, p);
  track.finds_level = p.threshold.values.size() > 1;
  try {
    const auto tables = std::make_shared<const QuestTables>(psi_definition(p));
    begin_with(keys, tables, stop, track);
  } catch (const std::invalid_argument& error) {
    keys.of("levels").reject("levels", fmt::format("cannot be used as stated: {}", error.what()));
  }
}

}  // namespace haptrial::psychometric
