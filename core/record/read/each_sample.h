#pragma once

#include <algorithm>
#include <cstdint>

#include "core/record/read/session_reader.h"

namespace haptrial::record {

/// Visits every row of /samples in order, a piece of the file in memory at a time.
template <class Visit>
void each_sample(const SessionReader& reader, Visit visit) {
  constexpr std::uint64_t kPiece = 65536;  // rows
  const std::uint64_t count = reader.sample_count();
  for (std::uint64_t first = 0; first < count; first += kPiece) {
    for (const Sample& sample : reader.samples(first, std::min(kPiece, count - first))) {
      visit(sample);
    }
  }
}

}  // namespace haptrial::record
