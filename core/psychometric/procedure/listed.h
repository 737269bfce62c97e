#pragma once

#include "core/psychometric/procedure/procedure.h"
#include "core/psychometric/procedure/shuffled.h"

namespace haptrial::psychometric {

/// A procedure whose levels are settled before the first trial; one outcome a level.
class ListedLevels : public Procedure {
 public:
  const Level& next() const override;
  void report(double answer, const Level& applied) override;
  /// Moves the level to the end of the list.
  void postpone() override;
  bool finished() const override { return outcomes_.size() == order_.size(); }

  const std::vector<Outcome>& outcomes() const noexcept { return outcomes_; }
  std::size_t trials() const noexcept { return order_.size(); }

 protected:
  ListedLevels(const std::vector<double>& order, const char* who);
  /// @throws std::invalid_argument when this procedure has no such answer.
  virtual void check(double answer) const = 0;
  const char* who() const noexcept { return who_; }

 private:
  std::vector<Level> order_;
  std::vector<Outcome> outcomes_;
  const char* who_;
};

/// Constant stimuli: each level so many times. There is no estimate but a fit of the outcomes.
class ConstantStimuli final : public ListedLevels {
 public:
  /// @param outcomes  how many there are, at least 2
  /// @throws std::invalid_argument naming the parameter that breaks its bound.
  ConstantStimuli(const ListParameters& list, std::uint64_t seed, std::string_view name,
                  std::size_t outcomes = 2);
  std::vector<Estimate> estimates() const override { return {}; }

 private:
  void check(double answer) const override;
  std::size_t number_of_outcomes_;
};

/// Magnitude estimation: an answer is a positive number in proportion to what was felt. Estimate:
/// the exponent of Stevens' power law, the slope of log answer over log level, and its standard
/// error by least squares. A modulus is the number that the participant was told to give to a
/// standard level; answers scale with it, so that the exponent does not depend on it.
class MagnitudeEstimation final : public ListedLevels {
 public:
  /// @param list  levels above 0
  /// @throws std::invalid_argument naming the parameter that breaks its bound.
  MagnitudeEstimation(const ListParameters& list, std::optional<double> modulus, std::uint64_t seed,
                      std::string_view name);
  std::vector<Estimate> estimates() const override;
  std::optional<double> modulus() const noexcept { return modulus_; }

 private:
  void check(double answer) const override;
  std::optional<double> modulus_;
};

}  // namespace haptrial::psychometric
