#pragma once

namespace haptrial::nerve {

inline constexpr double kLeastStimulus = 0.05e-3;  // that a probe gives [A]
inline constexpr double kMostStimulus = 3e-3;      // [A]

/// Finds the least current that a nerve answers to, as a surgeon's monitor does: halves the bracket
/// between a current that was answered and one that was not.
class ThresholdSearch {
 public:
  /// Currents [A]; the ends of what a probe gives.
  explicit ThresholdSearch(double least = kLeastStimulus, double most = kMostStimulus) noexcept
      : low_(least), high_(most), next_(most) {}
  double current() const noexcept { return next_; }  // of the next pulse [A]
  void tell(bool answered) noexcept;
  bool done() const noexcept { return done_; }
  /// Whether even the strongest pulse was not answered, or the weakest one was.
  bool out_of_range() const noexcept { return out_of_range_; }
  double threshold() const noexcept { return high_; }  // [A], within 5 % once done

 private:
  double low_;
  double high_;
  double next_;
  int told_{0};
  bool done_{false};
  bool out_of_range_{false};
};

}  // namespace haptrial::nerve
