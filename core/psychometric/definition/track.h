#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/psychometric/function/psychometric_function.h"
#include "core/psychometric/procedure/procedure.h"

namespace haptrial::psychometric {

/// A further dimension of a level.
struct TrackDimension {
  std::string variable;  // that it sets
  double low{0.0}, high{0.0};
  double resolution{0.0};  // 0: not rounded
};

/// Form of the outcomes that a track learns from.
enum class OutcomeForm {
  kAnswer,      // 0, 1, ...: which answer it was; of two, 1 is "correct" or "yes"
  kMagnitude,   // a number above 0
  kAdjustment,  // 1, -1 or 0: the level is to rise, to fall, or is left as it is
};

/// Result to expect of a track.
struct TrackPrediction {
  double mean{0.0};       // of the estimate, on the axis of the track
  double deviation{0.0};  // standard deviation of the estimate, likewise
  double trials{0.0};     // expected number
};

/// Whether a multiple of the resolution is from low to high. @param resolution  0: every number is
bool has_multiple(double low, double high, double resolution) noexcept;

/// One track of a procedure: it sets a variable of the definition, trial by trial, and learns from
/// what came of it.
struct Track {
  std::string name;
  std::size_t procedure{0};     // that it belongs to, in the definition's order
  std::string kind;             // word of its kind (procedure_kinds.h)
  std::string rule;             // its rule, steps, end and estimate, in sentences for reports
  std::string variable;         // that it sets
  std::string unit;             // of the variable, as a text
  std::vector<std::string> by;  // factors: each combination has a track of its own
  std::string counts;  // formula of what it learns; empty: whether the first answer was right
  double low{0.0}, high{0.0};           // the level is kept between them [unit]
  bool range_known{true};               // else a mistake in the range is noted
  double resolution{0.0};               // the level is rounded to a multiple of it; 0: not [unit]
  std::vector<TrackDimension> further;  // of a level with several dimensions
  int most_trials{0};                   // of one track
  bool listed{false};                   // its trials are known from the beginning
  bool finds_level{false};              // its first estimate is a level of the variable
  OutcomeForm learns_from{OutcomeForm::kAnswer};
  std::size_t outcomes{2};        // that a track of answers tells apart
  std::optional<bool> falls;      // whether answers 1 get rarer as the level rises; none: not known
  Axis axis;                      // of its steps
  std::vector<double> steps;      // their sizes, on the axis; none: levels follow another rule
  std::optional<double> balance;  // share of answers 1 about which its levels settle, if known
  std::optional<PsychometricParameters> expected;  // that the study counts on
  std::function<std::unique_ptr<Procedure>(std::uint64_t seed, const std::string& name)> begin;
  /// Computes the result to expect of people with this function; without it tracks are simulated.
  /// @throws std::invalid_argument if it cannot be said
  std::function<TrackPrediction(const PsychometricFunction& people)> predict;
  /// Sentences on a track that can be presented and yet tells nothing; without it there are none.
  std::function<std::vector<std::string>(const Track& track)> warnings;

  /// Names the outcomes that it can learn: "a number above 0", or "0 or 1".
  std::string lesson() const;
  /// Whether an outcome is one of these.
  bool learns(double outcome) const noexcept;
  /// Level that is presented if a level is asked for: rounded, within the range.
  double applied(double asked) const noexcept;
  Level applied(const Level& asked) const;
  /// The smallest change of the level by one of its steps, at either end of the range [unit].
  /// @returns nothing where it has no steps
  std::optional<double> smallest_change() const noexcept;
  /// Variables that the track sets, in the order of a level's dimensions.
  std::vector<std::string> variables() const;
  bool sets(const std::string& one) const;
  /// The lowest level of each dimension, or the highest.
  Level corner(bool high) const;
};

}  // namespace haptrial::psychometric
