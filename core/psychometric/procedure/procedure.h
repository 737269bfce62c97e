#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace haptrial::psychometric {

/// Stimulus of a trial: one number for each dimension, most often one.
using Level = std::vector<double>;

/// Outcome of a trial.
struct Outcome {
  double answer;  // which outcome (0, 1, ...; of two, 1 is "correct" or "yes"), or a number given
  Level applied;  // the level that was really presented: quantised, limited by the device
};

/// Interval from low to high, 95 % [unit of the estimate].
struct EstimateInterval {
  double low, high;
};

/// Range from the lowest to the highest level that a procedure may present [unit of the level].
struct LevelRange {
  double low, high;
};

struct Estimate {
  std::string name;                 // "threshold, mean of 6 reversals"
  double value;                     // [unit of the level, or of the parameter]
  std::optional<double> deviation;  // its standard deviation as the procedure can tell [same]
  /// Degrees of freedom of Student's t for an interval from the deviation; nothing: there is none.
  std::optional<double> freedom{};
  std::optional<EstimateInterval> interval{};  // as the procedure itself can tell; infinite: open
  std::string remark{};                        // what is wrong with it; empty: nothing
};

/// Chooses the next level from the outcomes so far. Its state is a function of its parameters, its
/// seed and the outcomes in their order, and of nothing else: a session resumes by replay().
///
/// Between trials, on one thread; not for the servo thread.
class Procedure {
 public:
  virtual ~Procedure() = default;

  /// The level to present; the same until report() is called.
  /// @throws std::logic_error when finished.
  virtual const Level& next() const = 0;
  /// @throws std::logic_error when finished
  /// @throws std::invalid_argument when the answer or the size of `applied` is not one of this
  ///         procedure; its state is then unchanged.
  virtual void report(double answer, const Level& applied) = 0;
  /// The present level comes again later, if the procedure knows its levels before the first
  /// trial; another one asks for the same level next. @throws std::logic_error when finished
  virtual void postpone() {}
  virtual bool finished() const = 0;
  /// Empty while the outcomes do not suffice.
  virtual std::vector<Estimate> estimates() const = 0;
  /// The probability of an answer 1 at the level that the first estimate is meant for; nothing: the
  /// procedure seeks no level, or the probability depends on the observer.
  virtual std::optional<double> target() const { return std::nullopt; }
  /// The range of its (first) dimension, if answers move the level within one.
  virtual std::optional<LevelRange> range() const { return std::nullopt; }
  /// Whether levels go up and down by steps, so that a step against the last one is a reversal.
  virtual bool has_reversals() const { return false; }
  /// Reversals so far, if the procedure counts them itself.
  virtual std::optional<int> counted_reversals() const { return std::nullopt; }
};

/// Reports each outcome. @throws as report() does
void replay(Procedure& procedure, std::span<const Outcome> outcomes);

/// Checks for the procedures themselves.
namespace checks {
/// @throws std::invalid_argument "WHO: SENTENCE" unless `holds`.
void require(bool holds, const char* who, const std::string& sentence);
/// @throws std::logic_error when a finished procedure is asked or told something.
void require_running(bool running, const char* who);
/// @throws std::invalid_argument unless `answer` is 0, 1, ... outcomes - 1
std::size_t outcome_of(double answer, std::size_t outcomes, const char* who);
/// @throws std::invalid_argument unless `applied` is one finite number
double single_level(const Level& applied, const char* who);
}  // namespace checks

}  // namespace haptrial::psychometric
