#pragma once

#include <array>
#include <cstdint>

#include "core/base/random.h"
#include "core/bone/hint/hint_setup.h"

namespace haptrial::subject {

/// Reaction of a virtual surgeon to hints. Each that appears is heeded or not, by chance; one that
/// is heeded acts after the reaction time, once, and its effect wears off again:
///
///     force   lightness * 0.6, at least 0.3
///     speed   pace      * 0.7, at least 0.4
///     hidden  looks before it drills on, and does not drill under an edge
///
/// The figures are assumed. Servo thread: no allocation.
class HintHeeding {
 public:
  /// @param share     of hints that are heeded, 0 to 1
  /// @param reaction  > 0 [s]
  HintHeeding(double share, double reaction, RandomStream random)
      : share_(share), reaction_(reaction), random_(random) {}

  /// A tick. @param hints  hint::bit() of those that are seen
  /// @returns whether what is being done has to end now
  bool notice(std::uint8_t hints, double dt) noexcept;

  double lightness() const noexcept { return lightness_; }  // of its force, 0 to 1
  double pace() const noexcept { return pace_; }            // of its strokes, 0 to 1
  bool looks() const noexcept { return looks_ > 0.0; }

 private:
  struct Seen {
    bool on{false};
    bool heeded{false};
    double since{0.0};  // [s]
  };
  bool act(hint::HintKind kind) noexcept;

  double share_;
  double reaction_;
  RandomStream random_;
  std::array<Seen, hint::kHintKinds> seen_;
  double lightness_{1.0};
  double pace_{1.0};
  double looks_{0.0};  // for so long [s]
};

}  // namespace haptrial::subject
