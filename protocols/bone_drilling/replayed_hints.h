#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/bone/hint/chime.h"
#include "core/bone/hint/hint_rows.h"
#include "core/bone/simulator/drilling_view.h"

namespace haptrial::record {
class SessionReader;
}

namespace haptrial::protocols {

/// The hints that a session's participant saw, from the session's file.
class ReplayedHints {
 public:
  explicit ReplayedHints(const record::SessionReader& session);

  /// Adds the hints of a tick to its view. The ticks of a trial in their order.
  /// @param vital  names of the bone's structures, as DrillingView::hint_structure counts them
  bone::DrillingView with(bone::DrillingView seen, std::uint64_t sequence,
                          std::span<const std::string> vital);
  /// Adds the next samples of the chimes to what is there.
  void mix(std::span<float> part) noexcept { chime_.mix(part); }

 private:
  std::vector<record::HintRow> shown_;  // by their beginnings
  std::uint8_t before_{0};              // kinds on the tick before
  hint::Chime chime_;
};

}  // namespace haptrial::protocols
