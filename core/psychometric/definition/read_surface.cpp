#include "core/psychometric/definition/read_procedures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "core/base/definition/expression.h"
#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/base/exception_words.h"
#include "core/psychometric/definition/track.h"
#include "core/psychometric/definition/track_keys.h"
#include "core/psychometric/procedure/threshold_surface.h"

namespace haptrial::psychometric {
namespace {

constexpr double kMostLevels = 20000.0;

struct SurfaceKeys {
  SurfaceParameters surface;
  std::vector<std::string> rising;
  std::string present;
};

const Schema<SurfaceParameters>& rates_schema() {
  using P = SurfaceParameters;
  static const auto schema =
      Schema<P>()
          .number("target", &P::target, {0.01, 0.99}, "1",
                  "Share of answers 1, such as right ones, that PEST or a surface seeks")
          .otherwise("0.5; of a surface halfway between guess and 1 - lapse")
          .number("guess", &P::guess, {0.0, 0.99}, "1",
                  "Share of answers 1 far below the threshold")
          .required()
          .otherwise(kProceduresOwn)
          .number("lapse", &P::lapse, {0.0, 1.0}, "",
                  "Probability of the answer 0 to the clearest stimulus, of a threshold surface");
  return schema;
}

/// A formula that says which levels may be presented. Evaluating it writes into it, and sessions
/// share a track.
class Presentable {
 public:
  Presentable(const std::string& text, const std::vector<SurfaceVariable>& variables)
      : formula_(text, labels_) {
    for (const std::string& name : formula_.names()) {
      const auto found = std::ranges::find(variables, name, &SurfaceVariable::name);
      if (found == variables.end()) {
        throw InputError(fmt::format("names {}, which is no variable of the stimulus", name));
      }
      sources_.push_back(static_cast<std::size_t>(found - variables.begin()));
    }
    values_.resize(sources_.size());
  }

  bool operator()(const Level& level) {
    const std::lock_guard hold(one_at_a_time_);
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      values_[i] = level[sources_[i]];
    }
    return formula_.value_at({values_.data(), values_.size()}) != 0.0;
  }

 private:
  std::mutex one_at_a_time_;
  Labels labels_;
  Expression formula_;
  std::vector<std::size_t> sources_;
  std::vector<double> values_;
};

void read_rising(const TrackKeys& keys, std::vector<SurfaceVariable>& variables) {
  if (!keys.has("rising")) {
    return;
  }
  Table& table = keys.of("rising");
  for (const std::string& name : table.texts("rising")) {
    const auto found = std::ranges::find(variables, name, &SurfaceVariable::name);
    if (found == variables.end()) {
      std::vector<std::string> known;
      std::ranges::transform(variables, std::back_inserter(known), &SurfaceVariable::name);
      table.reject("rising", fmt::format("\"{}\"", name),
                   fmt::format("{}", fmt::join(known, ", ")));
    } else {
      found->rises = true;
    }
  }
}

void read_present(const TrackKeys& keys, SurfaceParameters& surface) {
  if (!keys.has("present")) {
    return;
  }
  Table& table = keys.of("present");
  try {
    const auto formula = std::make_shared<Presentable>(table.text("present"), surface.variables);
    surface.allowed = [formula](const Level& level) { return (*formula)(level); };
  } catch (const std::exception& error) {
    table.reject("present", fmt::format("cannot be used as stated: {}", sentence_of(error)));
  }
}

void describe(const TrackKeys& keys) {
  keys.of("rising").describe({"rising",
                              "Variables of a threshold surface, beside the first, with which the "
                              "answer 1 gets no rarer",
                              "none", false});
  keys.of("present").describe({"present",
                               "Formula of a surface's variables: levels at which it is 0 are "
                               "not presented, as a device cannot",
                               "all", false});
}

}  // namespace

void read_surface(const TrackKeys& keys, Track& track) {
  SurfaceParameters surface;
  const TrackStop stop = read_stop(keys, track);
  surface.trials = stop.trials;
  track.rule =
      "The threshold was sought as a smooth function of the other variables, without a "
      "formula. " +
      words_of(stop);
  double levels = 1.0;
  for (QuestDimension& each : read_stimulus(keys, track)) {
    std::ranges::sort(each.values);
    levels *= static_cast<double>(each.values.size());
    surface.variables.push_back({each.name, std::move(each.values), false});
  }
  describe(keys);
  read_rising(keys, surface.variables);
  rates_schema().read(keys.track, keys.procedure, surface);
  if (surface.variables.empty()) {
    return;
  }
  try {
    if (levels > kMostLevels) {
      throw InputError(
          fmt::format("stimulus has {:.3g} levels; allowed: at most {:.0f}", levels, kMostLevels));
    }
    read_present(keys, surface);
    const auto begun = std::make_shared<const ThresholdSurface>(surface);
    track.falls = false;
    track.begin = [begun](std::uint64_t, const std::string&) {
      return std::make_unique<ThresholdSurface>(*begun);
    };
  } catch (const std::exception& error) {
    keys.of("stimulus")
        .reject("stimulus", fmt::format("cannot be used as stated: {}", sentence_of(error)));
  }
}

}  // namespace haptrial::psychometric
