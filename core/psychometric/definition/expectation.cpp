#include "core/psychometric/definition/expectation.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "core/base/definition/schema.h"
#include "core/psychometric/definition/track.h"
#include "core/psychometric/function/response_observer.h"

namespace haptrial::psychometric {
namespace {

std::optional<TrackPrediction> simulated(const Track& track) {
  constexpr int kTracks = 500;
  double sum = 0.0, square = 0.0, trials = 0.0;
  int count = 0;
  for (int i = 0; i < kTracks; ++i) {
    const std::string name = fmt::format("expected {}", i);
    ResponseObserver observer({*track.expected}, 1, name);
    const auto procedure = track.begin(1, name);
    while (!procedure->finished()) {
      const double level = track.applied(procedure->next().front());
      procedure->report(observer.answer(level), {level});
      ++trials;
    }
    const auto estimates = procedure->estimates();
    if (!estimates.empty()) {
      const double x = track.axis.at(estimates.front().value);
      sum += x;
      square += x * x;
      ++count;
    }
  }
  if (count < kTracks / 2) {
    return std::nullopt;
  }
  const double mean = sum / count;
  return TrackPrediction{mean, std::sqrt(std::max(0.0, square / count - mean * mean)),
                         trials / kTracks};
}

/// @throws std::invalid_argument if the function has no level at which the track is in balance
std::string sentence(const Track& track, const PsychometricFunction& people,
                     const TrackPrediction& found) {
  const Axis& axis = track.axis;
  std::string text = fmt::format(
      "{}: for a participant as expected, the estimate is {:.4g} {} on average (standard deviation "
      "from {:.4g} to {:.4g}) after {:.0f} trials{}",
      track.name, axis.level(found.mean), track.unit, axis.level(found.mean - found.deviation),
      axis.level(found.mean + found.deviation), found.trials, track.predict ? "" : " (simulated)");
  if (track.balance) {
    const double target = people.level_for(*track.balance);
    text += fmt::format("; the level with {:.1f} % correct is {:.4g}, so that the bias is {:+.2g}",
                        100.0 * *track.balance, target, axis.level(found.mean) - target);
  }
  return text;
}

/// @throws std::invalid_argument naming the sigmoids, from its read(), if there is none of the name
const Schema<PsychometricParameters>& expectation_schema() {
  using P = PsychometricParameters;
  static const auto schema =
      Schema<P>()
          .number("threshold", &P::threshold, {}, "",
                  "Threshold that participants are expected to have, from which validate predicts "
                  "the estimate")
          .required()
          .number("width", &P::width, kPositive, "",
                  "Expected width of the psychometric function, from 5 to 95 % of its rise, on the "
                  "axis of the scale")
          .required()
          .number("guess", &P::guess, {0.0, 0.99}, "1", "Expected guess rate")
          .number("lapse", &P::lapse, {0.0, 0.5}, "1", "Expected lapse rate")
          .number("share", &P::share, {0.01, 0.99}, "1",
                  "Share of answers 1 at the expected threshold, guesses and lapses aside")
          .custom("function", "Sigmoid of the expected psychometric function, by its name",
                  [](Table& table, const std::string& key, P& p) {
                    set_sigmoid(p, table.text(key), p.axis.scale);
                  })
          .otherwise("logistic");
  return schema;
}

}  // namespace

std::optional<PsychometricParameters> read_expectation(Table& procedure, const Axis& axis) {
  Table table = procedure.table("expect");
  PsychometricParameters p;
  p.axis = axis;
  p.guess = 0.5;
  try {
    expectation_schema().read(table, p);
    static_cast<void>(PsychometricFunction(p));
  } catch (const std::invalid_argument& error) {
    procedure.reject("expect", fmt::format("is refused: {}", error.what()));
    return std::nullopt;
  }
  return p;
}

std::optional<std::string> predicted(const Track& track) {
  if (!track.expected || track.listed) {
    return std::nullopt;
  }
  try {
    const PsychometricFunction people(*track.expected);
    const auto found = track.predict ? std::optional(track.predict(people)) : simulated(track);
    return found ? std::optional(sentence(track, people, *found)) : std::nullopt;
  } catch (const std::invalid_argument&) {  // more states than can be followed, no such level
    return std::nullopt;
  }
}

}  // namespace haptrial::psychometric
