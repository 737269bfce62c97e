#pragma once

#include <cstdint>

#include "core/base/definition/schema_forward.h"

namespace haptrial::protocols {

/// What moves the mark of a scale in a trial.
enum class MarkedBy : std::uint8_t { kKeys, kHand, kMouse };

/// How the mark of a scale is moved and given in a trial. The hand and the mouse move it along a
/// line in W that runs along x, from -length / 2 at the low end to length / 2 at the high end; the
/// screen draws the line there. Functions are pure; any thread.
struct MarkMeans {
  MarkedBy by{MarkedBy::kKeys};
  double length{0.1};        // of the line > 0 [m]
  std::uint32_t buttons{1};  // of the device that give the answer, a bit each; Enter does, too

  /// Movement from where the question came after which the mark appears, so that no place is
  /// suggested [m].
  double least_movement() const noexcept { return 0.02 * length; }
  /// Share of the way from the low end to the high end, 0 to 1. @param x  [m], beyond the ends also
  double share_at(double x) const noexcept;
  /// The place of a share along x [m].
  double place_of(double share) const noexcept { return (share - 0.5) * length; }
};

/// The keys of a question with a mark: by, length and buttons. Mistakes of one key without another
/// are noted.
const Schema<MarkMeans>& mark_schema();

}  // namespace haptrial::protocols
