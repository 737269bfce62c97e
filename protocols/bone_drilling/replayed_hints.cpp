#include "protocols/bone_drilling/replayed_hints.h"

#include <algorithm>

#include "core/record/read/session_reader.h"

namespace haptrial::protocols {

ReplayedHints::ReplayedHints(const record::SessionReader& session)
    : shown_(session.rows<record::HintRow>()) {
  std::erase_if(shown_, [](const record::HintRow& row) { return !row.shown; });
  std::ranges::stable_sort(shown_, {}, &record::HintRow::begin);
}

bone::DrillingView ReplayedHints::with(bone::DrillingView seen, std::uint64_t sequence,
                                       std::span<const std::string> vital) {
  seen.hints = 0;
  for (const record::HintRow& row : shown_) {
    if (row.begin > sequence) {
      break;
    }
    if (sequence < row.sequence) {
      seen.hints = static_cast<std::uint8_t>(seen.hints | hint::bit(row.kind));
      const auto at = std::ranges::find(vital, row.structure);
      if (row.kind != hint::HintKind::kHidden && at != vital.end()) {
        seen.hint_structure = static_cast<std::int8_t>(at - vital.begin());
      }
    }
  }
  if ((seen.hints & ~before_) != 0) {
    chime_.ring();
  }
  before_ = seen.hints;
  return seen;
}

}  // namespace haptrial::protocols
