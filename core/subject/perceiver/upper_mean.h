#pragma once

#include <array>

namespace haptrial::subject {

/// Mean of the greater values of a signal: of those that it had during the greater half of the
/// time. The rise of a push and a short impact do not count. Values are gathered in bins of at most
/// 1/16 of their size, each with its own mean, so that a steady signal comes out exactly.
/// Servo thread.
class UpperMean {
 public:
  void clear() noexcept { *this = UpperMean{}; }
  /// @param value  0 to 1,000; beyond counts as the next of them
  void add(double value, double duration) noexcept;
  double mean() const noexcept;  // 0 if nothing was added

 private:
  static constexpr int kPerOctave = 16;
  static constexpr int kLowest = -10;  // below 2^kLowest is one bin
  static constexpr int kOctaves = 20;
  struct Bin {
    double time{0.0};
    double sum{0.0};
  };
  std::array<Bin, 1 + kPerOctave * kOctaves> bins_;
};

}  // namespace haptrial::subject
