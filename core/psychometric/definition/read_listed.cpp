#include "core/psychometric/definition/read_procedures.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "core/psychometric/definition/grid.h"
#include "core/psychometric/definition/track.h"
#include "core/psychometric/definition/track_keys.h"
#include "core/psychometric/procedure/listed.h"

namespace haptrial::psychometric {
namespace {

ListParameters read_listed(const TrackKeys& keys, Track& track) {
  ListParameters list;
  list.levels = read_levels(keys);
  list_schema().read(keys.track, keys.procedure, list);
  const auto [least, most] = std::minmax_element(list.levels.begin(), list.levels.end());
  track.low = list.levels.empty() ? 0.0 : *least;
  track.high = list.levels.empty() ? 0.0 : *most;
  track.most_trials = static_cast<int>(list.levels.size()) * list.repetitions;
  track.listed = true;
  track.rule = fmt::format(
      "Levels were {}, each presented {}{}.", words_of(list.levels),
      list.repetitions == 1 ? std::string("once") : fmt::format("{} times", list.repetitions),
      list.in_rounds ? ", each once before any came again" : ", shuffled");
  return list;
}

const Schema<std::optional<double>>& modulus_schema() {
  static const auto schema =
      Schema<std::optional<double>>()
          .custom("modulus", "Number that the first level of a magnitude estimation is called",
                  [](Table& table, const std::string& key, std::optional<double>& modulus) {
                    modulus = table.number(key, kPositive, "");
                  })
          .otherwise("none is stated");
  return schema;
}

}  // namespace

const Schema<ListParameters>& list_schema() {
  using L = ListParameters;
  static const auto schema =
      Schema<L>()
          .integer("repetitions", &L::repetitions, 1, 10000,
                   "Presentations of each level, or adjustments from each start")
          .flag("in_rounds", &L::in_rounds,
                "Whether each level, or start, comes once before any comes again");
  return schema;
}

void read_constant(const TrackKeys& keys, Track& track) {
  const ListParameters list = read_listed(keys, track);
  track.begin = [list](std::uint64_t seed, const std::string& name) {
    return std::make_unique<ConstantStimuli>(list, seed, name);
  };
}

void read_magnitude(const TrackKeys& keys, Track& track) {
  const ListParameters list = read_listed(keys, track);
  std::optional<double> modulus;
  modulus_schema().read(keys.track, keys.procedure, modulus);
  track.rule += modulus ? fmt::format(" The first level was to be called {:g}.", *modulus)
                        : std::string(" Participants chose their own scale of numbers.");
  track.begin = [list, modulus](std::uint64_t seed, const std::string& name) {
    return std::make_unique<MagnitudeEstimation>(list, modulus, seed, name);
  };
}

}  // namespace haptrial::psychometric
