#include "core/record/read/integrity.h"

#include <algorithm>
#include <optional>

#include "core/record/read/session_facts.h"
#include "core/record/read/tick_rows.h"

namespace haptrial::record {
namespace {

constexpr std::uint64_t kPiece = 65536;  // rows read at once

std::string number(std::uint64_t value) { return std::to_string(value); }
std::string number(std::int32_t value) { return std::to_string(value); }

/// Counts rows that break a rule and words the first of them.
class Fault {
 public:
  void note(const std::string& sentence) {
    if (count_++ == 0) {
      first_ = sentence;
    }
  }
  std::uint64_t count() const { return count_; }
  void report(std::vector<std::string>& problems) const {
    if (count_ == 0) {
      return;
    }
    problems.push_back(count_ == 1 ? first_
                                   : first_ + " (and " + number(count_ - 1) + " more like it)");
  }

 private:
  std::uint64_t count_{0};
  std::string first_;
};

/// Walks the samples in order beside the passes.
class SampleCheck {
 public:
  /// @param under_way  whether a pass had begun behind these when the program died
  SampleCheck(const std::vector<PassRow>& passes, bool under_way)
      : passes_(passes), under_way_(under_way) {}

  void add(const Sample& sample) {
    if (last_) {
      if (sample.sequence != last_->sequence + 1) {
        gaps.note("sequence number " + number(sample.sequence) + " follows " +
                  number(last_->sequence));
      }
      if (sample.time_ns <= last_->time_ns) {
        clock.note("the time does not advance at sequence number " + number(sample.sequence));
      }
    }
    while (at_ < passes_.size() && passes_[at_].last_sample < sample.sequence) {
      ++at_;
    }
    const bool inside = at_ < passes_.size() && passes_[at_].first_sample <= sample.sequence;
    const std::int32_t expected = inside ? static_cast<std::int32_t>(at_) : -1;
    const bool unfinished = under_way_ && at_ == passes_.size() &&
                            sample.pass == static_cast<std::int32_t>(passes_.size());
    if (sample.pass != expected && !unfinished) {
      labels.note("sequence number " + number(sample.sequence) + " is marked as pass " +
                  number(sample.pass) + ", and /trials puts it in pass " + number(expected));
    }
    last_ = sample;
  }

  Fault gaps, clock, labels;

 private:
  const std::vector<PassRow>& passes_;
  bool under_way_;
  std::size_t at_{0};
  std::optional<Sample> last_;
};

void check_ranges(const std::vector<PassRow>& passes, bool imported, Integrity& result) {
  for (std::size_t i = 0; i < passes.size(); ++i) {
    const PassRow& pass = passes[i];
    const std::string range = "pass " + number(std::uint64_t{i}) + " has samples " +
                              number(pass.first_sample) + " to " + number(pass.last_sample);
    result.aborted += pass.status == PassStatus::kAborted ? 1 : 0;
    result.damaged += pass.status == PassStatus::kDamaged ? 1 : 0;
    if (pass.practice) {
      ++result.practice;
    }
    if (pass.attempt < 1) {
      result.problems.push_back("pass " + number(std::uint64_t{i}) + " is attempt " +
                                number(pass.attempt) + ", and attempts count from 1");
    }
    if (imported) {
      continue;  // its passes have no samples
    }
    if (pass.first_sample > pass.last_sample) {
      result.problems.push_back(range + ", in reverse");
    } else if (result.rows == 0 || pass.first_sample < result.first_sequence ||
               pass.last_sample > result.last_sequence) {
      result.problems.push_back(range + ", some of which are missing");
    }
    if (i > 0 && pass.first_sample <= passes[i - 1].last_sample) {
      result.problems.push_back(range + ", but the pass before ends at " +
                                number(passes[i - 1].last_sample));
    }
  }
}

/// The counts of the whole session, or so far if it was stopped to be resumed.
std::optional<TimingSummary> counts_of(const SessionReader& reader, Integrity& result) {
  std::optional<TimingSummary> summary = reader.timing_summary();
  if (summary) {
    result.state = RunState::kEnded;
  }
  const std::vector<RunRow> runs = reader.runs();
  if (summary || runs.empty() || runs.back().state != RunState::kStopped) {
    return summary;
  }
  result.state = RunState::kStopped;
  summary.emplace();
  summary->ticks = runs.back().first_sample + runs.back().counts.ticks;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (i + 1 < runs.size() && runs[i + 1].run == runs[i].run) {
      continue;
    }
    summary->overruns += runs[i].counts.overruns;
    summary->dropped += runs[i].counts.dropped;
  }
  return summary;
}

void check_counts(const SessionReader& reader, Integrity& result) {
  const std::optional<TimingSummary> summary = counts_of(reader, result);
  if (!summary) {
    result.problems.push_back("the counts of the loop are missing: the session is unfinished");
    return;
  }
  result.overruns = summary->overruns;
  result.dropped = summary->dropped;
  if (summary->dropped > 0) {
    result.problems.push_back(number(summary->dropped) +
                              (summary->dropped == 1 ? " lost record" : " lost records"));
  }
  if (summary->ticks != result.rows) {
    result.problems.push_back("the loop ran " + number(summary->ticks) + " ticks, but " +
                              number(result.rows) + " rows were recorded");
  }
}

/// One row for each of /samples, in the same order.
void check_each_tick(const SessionReader& reader, const TableDescription& table, Fault& order,
                     Integrity& result) {
  const std::uint64_t count = reader.count(table);
  if (count != result.rows) {
    result.problems.push_back("/" + table.name() + " has " + number(count) +
                              " rows, and /samples " + number(result.rows));
  }
  std::uint64_t next = result.first_sequence;
  for (std::uint64_t first = 0; first < count; first += kPiece) {
    for (const std::int64_t value :
         reader.integers(table, "sequence", first, std::min(kPiece, count - first))) {
      const auto sequence = static_cast<std::uint64_t>(value);
      if (sequence < next) {
        order.note("sequence number " + number(sequence) + " of /" + table.name() + " follows " +
                   number(next - 1));
      }
      next = sequence + 1;
    }
  }
}

/// Rows belong to ticks and passes that are there.
void check_own(const SessionReader& reader, const TableDescription& table, Integrity& result) {
  Fault order;
  if (table.of() == RowsOf::kEachTick) {
    check_each_tick(reader, table, order, result);
  } else if (table.of() == RowsOf::kTick) {
    std::uint64_t before = 0;
    for (const std::int64_t value : reader.integers(table, "sequence", 0, reader.count(table))) {
      const auto sequence = static_cast<std::uint64_t>(value);
      if (sequence < before) {
        order.note("sequence number " + number(sequence) + " of /" + table.name() + " follows " +
                   number(before));
      }
      before = sequence;
      if (sequence < result.first_sequence || sequence > result.last_sequence) {
        order.note("/" + table.name() + " has a row for tick " + number(sequence) +
                   ", which is missing");
      }
    }
  }
  order.report(result.problems);
}

}  // namespace

Integrity check_session(const SessionReader& reader, const TableList& tables) {
  Integrity result;
  const std::vector<PassRow> passes = reader.passes();
  result.rows = reader.sample_count();
  result.passes = passes.size();
  const std::vector<BegunRow> begun = reader.begun();
  const auto next = static_cast<std::int32_t>(passes.size());
  const bool under_way = std::any_of(begun.begin(), begun.end(),
                                     [next](const BegunRow& row) { return row.row == next; });
  SampleCheck check(passes, under_way);
  bool first = true;
  each_sample(reader, [&](const Sample& sample) {
    result.first_sequence = first ? sample.sequence : result.first_sequence;
    result.last_sequence = sample.sequence;
    first = false;
    check.add(sample);
  });
  result.gaps = check.gaps.count();
  if (result.first_sequence != 0) {
    result.problems.push_back("the first sequence number is " + number(result.first_sequence) +
                              " instead of 0");
  }
  check.gaps.report(result.problems);
  check.clock.report(result.problems);
  check_counts(reader, result);
  for (const TableDescription* table : tables) {
    if (reader.has(*table)) {
      check_own(reader, *table, result);
    }
  }
  check_ranges(passes, !imported_from(reader).empty(), result);
  check.labels.report(result.problems);
  result.ok = result.problems.empty();
  return result;
}

}  // namespace haptrial::record
