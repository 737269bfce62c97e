#include "protocols/bone_drilling/replayed_signals.h"

#include <algorithm>

#include "protocols/bone_drilling/definition/bone_definition.h"

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

namespace {

constexpr std::uint64_t kRowsAtOnce = 65536;  // rows read at once

bool before(const record::EmgRow& row, std::uint64_t sequence) { return row.sequence < sequence; }

bool was_heard(const record::SessionReader& reader, int trial) {
  const std::vector<record::PassRow> passes = reader.passes();
  return std::ranges::any_of(passes, [trial](const record::PassRow& pass) {
    return pass.trial == trial && !says_off(pass.condition, kMonitor);
  });
}

}  // namespace

ReplayedNerves::ReplayedNerves(const std::filesystem::path& session,
                               const nerve::MonitorParameters& monitor, int trial, double card)
    : reader_(session),
      heard_(was_heard(reader_, trial)),
      count_(reader_.count(record::table_of<record::EmgRow>())),
      voice_({reader_.rows<record::NerveEventRow>(), reader_.rows<record::NerveThresholdRow>()},
             monitor, reader_.rows<record::NerveChannelRow>().size(), card) {}

/// The piece in which the tick begins.
void ReplayedNerves::load(std::uint64_t sequence) {
  std::uint64_t low = 0;
  std::uint64_t high = count_;
  while (low < high) {
    const std::uint64_t middle = low + (high - low) / 2;
    if (before(reader_.rows<record::EmgRow>(middle, 1).front(), sequence)) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  const std::uint64_t count = std::min(kRowsAtOnce, count_ - low);
  rows_ = reader_.rows<record::EmgRow>(low, count);
  next_ = low + count;
}

std::span<const record::EmgRow> ReplayedNerves::samples_of(std::uint64_t sequence) {
  // A tick may lie across the end of a piece, unless the file ends there.
  const bool here = !rows_.empty() && rows_.front().sequence <= sequence &&
                    (sequence < rows_.back().sequence || next_ == count_);
  if (!here) {
    load(sequence);
  }
  const auto first = std::lower_bound(rows_.begin(), rows_.end(), sequence, before);
  const auto end = std::lower_bound(first, rows_.end(), sequence + 1, before);
  return {first, end};
}

void ReplayedNerves::tick(std::uint64_t sequence) {
  voice_.tick(sequence, samples_of(sequence), heard_);
}

}  // namespace haptrial::protocols
