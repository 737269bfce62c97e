#pragma once

#include <algorithm>
#include <memory>

#include "core/base/definition/schema.h"
#include "core/psychometric/definition/procedure_kinds.h"

/// One kind of procedure more: stochastic approximation. After trial n the level moves by
///
///     x_n+1 = x_n - gain / n (answer - target)
///
/// on the axis of the scale, so that it comes to where the share `target` of answers is 1.
/// Source: Robbins and Monro 1951, Annals of Mathematical Statistics 22.
namespace robbins_monro {

using namespace haptrial::psychometric;

struct Parameters {
  Axis axis;                               // of the steps
  double start{0.0}, low{0.0}, high{1.0};  // low <= start <= high [level]
  double target{0.5};                      // share of answers 1 that is sought, 0 < target < 1
  double gain{1.0};                        // > 0 [unit of the axis]
  int trials{1};
};

class RobbinsMonro final : public Procedure {
 public:
  explicit RobbinsMonro(const Parameters& parameters) : p_(parameters), next_{p_.start} {}

  const Level& next() const override {
    checks::require_running(!finished(), "RobbinsMonro");
    return next_;
  }
  void report(double answer, const Level& applied) override {
    checks::require_running(!finished(), "RobbinsMonro");
    const auto outcome = static_cast<double>(checks::outcome_of(answer, 2, "RobbinsMonro"));
    const double x = p_.axis.at(checks::single_level(applied, "RobbinsMonro"));
    const double step = p_.gain / ++trials_ * (outcome - p_.target);
    next_.front() = std::clamp(p_.axis.level(x - step), p_.low, p_.high);
  }
  bool finished() const override { return trials_ == p_.trials; }
  std::vector<Estimate> estimates() const override {
    if (!finished()) {
      return {};
    }
    return {{"threshold, level after the last trial", next_.front(), std::nullopt}};
  }
  std::optional<double> target() const override { return p_.target; }
  std::optional<LevelRange> range() const override { return LevelRange{p_.low, p_.high}; }

 private:
  Parameters p_;
  Level next_;
  int trials_{0};
};

inline const haptrial::Schema<Parameters>& schema() {
  static const auto schema =
      haptrial::Schema<Parameters>()
          .number("target", &Parameters::target, {0.01, 0.99}, "1",
                  "Share of answers 1 that the levels come to")
          .number("gain", &Parameters::gain, haptrial::kPositive, "",
                  "Greatest step after the first trial, on the axis of the scale; later ones are "
                  "divided by the number of trials")
          .required()
          .otherwise(kProceduresOwn);
  return schema;
}

/// Reads [procedure] kind = "robbins_monro": range, [scale], [origin], start, gain, [target], stop.
inline void read(const TrackKeys& keys, Track& track) {
  read_range_and_axis(keys, track);
  Parameters p;
  p.axis = track.axis;
  p.low = track.low;
  p.high = track.high;
  p.start = read_start(keys, track);
  schema().read(keys.track, keys.procedure, p);
  p.trials = read_stop(keys, track).trials;
  track.balance = p.target;  // is compared with guessing
  track.falls = false;       // answers 1 come more often as the level rises
  track.begin = [p](std::uint64_t, const std::string&) {
    return std::make_unique<RobbinsMonro>(p);
  };
}

/// Adds the kind, once.
inline void add() { add_kind_of_procedure({"robbins_monro", read}); }

}  // namespace robbins_monro
