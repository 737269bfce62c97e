#pragma once

#include <cstdint>

namespace haptrial::render {

/// How much of a picture is drawn, from the least to the most.
enum class Quality : std::uint8_t {
  kPlain,   // light alone, and a grain of dust a cell
  kShaded,  // and shadows, and all grains
  kFull,    // and smoothed edges
};

/// Chooses how well a screen is drawn by how long its frames take: less after 30 frames that came
/// slower than 30 a second in the mean, more after 90 that were faster than 45. What turned out to
/// be too much is tried again ever more rarely. One thread.
class QualitySteps {
 public:
  explicit QualitySteps(Quality most = Quality::kFull) noexcept : most_(most), now_(most) {}

  /// A frame. @param interval  since the one before [s]
  Quality next(double interval) noexcept;
  Quality now() const noexcept { return now_; }

 private:
  void step(int by) noexcept;

  Quality most_;
  Quality now_;
  int frames_{0};    // that the sum is of
  double sum_{0.0};  // of their intervals [s]
  int patience_{1};  // times 90 frames before more is tried
  bool tried_{false};
};

}  // namespace haptrial::render
