#include "core/record/recovery/recover.h"

#include <fmt/format.h>
#include <limits>

#include <set>
#include <span>
#include <vector>

#include "core/base/error.h"
#include "core/record/hdf5/file_lock.h"
#include "core/record/hdf5/session_target.h"
#include "core/record/hdf5/session_writer.h"
#include "core/record/recovery/recovered_rows.h"
#include "core/record/recovery/rewrite.h"

namespace haptrial::record {
namespace {

constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

namespace fs = std::filesystem;

std::uint64_t blocks_of(const std::vector<StimulusRow>& rows) {
  std::set<std::int32_t> blocks;
  for (const StimulusRow& row : rows) {
    blocks.insert(row.block);
  }
  return blocks.size();
}

/// Counts the samples, piece by piece, and which passes have all of theirs.
class Count {
 public:
  Count(const std::vector<PassRow>& passes, Recovery& found) : found_(found) {
    for (const PassRow& pass : passes) {
      if (pass.first_sample <= pass.last_sample) {
        wanted_.push_back({pass.first_sample, pass.last_sample, 0});
      }
    }
  }
  void add(std::span<const Sample> rows) {
    for (const Sample& row : rows) {
      if (found_.samples == 0) {
        found_.first_sequence = row.sequence;
      }
      if (found_.samples > 0) {
        found_.missing += row.sequence - found_.last_sequence - 1;
      }
      found_.last_sequence = row.sequence;
      ++found_.samples;
      while (at_ < wanted_.size() && wanted_[at_].last < row.sequence) {
        ++at_;
      }
      if (at_ < wanted_.size() && wanted_[at_].first <= row.sequence) {
        ++wanted_[at_].there;
      }
    }
  }
  void finish() {
    for (const Range& range : wanted_) {
      found_.passes_cut += range.there < range.last - range.first + 1 ? 1 : 0;
    }
  }

 private:
  struct Range {
    std::uint64_t first, last, there;
  };
  Recovery& found_;
  std::vector<Range> wanted_;
  std::size_t at_{0};
};

std::string sentence(const fs::path& file, const Recovery& found) {
  return fmt::format(
      "from the damaged {} ({} bytes): {} samples, {} missing between them, {} passes, {} "
      "incomplete{}",
      file.filename().string(), found.file_bytes, found.samples, found.missing, found.passes,
      found.passes_cut, found.info ? "" : "; the description of the session is lost");
}

void write(const fs::path& file, const fs::path& out, const RecoveredRows& rows,
           const SessionInfo& info, Recovery& found) {
  SessionWriter writer = SessionWriter(out, info, rows.tables());
  Count count(rows.passes, found);
  write_rows(
      writer, rows, [](std::uint64_t) { return true; },
      [&](std::span<const Sample> samples) { count.add(samples); });
  count.finish();
  for (const PassRow& pass : rows.passes) {
    writer.add_pass(pass);
  }
  write_rows_of_passes(writer, rows, rows.passes.size(), kAll);
  const std::int64_t last = rows.events.empty() ? 0 : rows.events.back().time_ns;
  writer.add_event({last, "recovered", sentence(file, found)});
  if (rows.summary) {
    writer.set_timing(rows.timing, *rows.summary);
  } else {
    writer.keep_timing(rows.timing);
  }
  writer.close();
}

}  // namespace

Recovery recover_session(const fs::path& file, const fs::path& out, const TableList& tables,
                         const std::function<TableList(const SessionInfo&)>& more) {
  const std::vector<std::uint8_t> bytes = contents_of(file);
  if (FileLock::taken(file)) {
    throw InputError(file.string() +
                     ": another haptrial records into it; wait until its session ends");
  }
  check_target(out);
  RecoveredRows rows = rows_in(file, bytes, tables);
  const std::optional<SessionInfo> info = find_info(file, rows);
  if (const TableList own = info && more ? more(*info) : TableList{}; !own.empty()) {
    rows = rows_in(file, bytes, own);
  }
  Recovery found;
  found.file_bytes = bytes.size();
  found.passes = rows.passes.size();
  found.events = rows.events.size();
  found.stimulus_blocks = blocks_of(rows.stimuli);
  found.frames = rows.frames.size();
  found.info = info.has_value();
  found.ended = rows.summary.has_value();
  found.subject = info ? info->subject : "";
  found.samples = rows.sample_pieces();  // until they are counted
  if (!found.anything()) {
    return found;
  }
  found.samples = 0;
  write(file, out, rows, info.value_or(SessionInfo{}), found);
  return found;
}

}  // namespace haptrial::record
