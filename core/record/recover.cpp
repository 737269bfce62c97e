#include "core/record/recover.h"

#include <fmt/format.h>

#include <fstream>
#include <set>
#include <system_error>
#include <vector>

#include "core/base/error.h"
#include "core/record/file_lock.h"
#include "core/record/isolated_info.h"
#include "core/record/recovered_rows.h"
#include "core/record/session_info.h"
#include "core/record/session_target.h"
#include "core/record/session_writer.h"

namespace haptrial::record {
namespace {

namespace fs = std::filesystem;

std::vector<std::uint8_t> contents(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    throw InputError(file.string() + ": is not a file that can be read; allowed: a session file");
  }
  std::ifstream in(file, std::ios::binary);
  std::vector<std::uint8_t> bytes(fs::file_size(file, error));
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!in) throw InputError(file.string() + ": cannot be read; allowed: a session file");
  return bytes;
}

/// From /attributes; from the root attributes where that is lost, or in a file of version 1.
std::optional<SessionInfo> find_info(const fs::path& file, const RecoveredRows& rows) {
  if (!rows.attributes.empty()) return info_of(rows.attributes);
  return isolated_info(file);
}

std::uint64_t blocks_of(const std::vector<StimulusRow>& rows) {
  std::set<std::int32_t> blocks;
  for (const StimulusRow& row : rows) blocks.insert(row.block);
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
  void add(const std::vector<Sample>& rows) {
    for (const Sample& row : rows) {
      if (found_.samples == 0) found_.first_sequence = row.sequence;
      if (found_.samples > 0) found_.missing += row.sequence - found_.last_sequence - 1;
      found_.last_sequence = row.sequence;
      ++found_.samples;
      while (at_ < wanted_.size() && wanted_[at_].last < row.sequence) ++at_;
      if (at_ < wanted_.size() && wanted_[at_].first <= row.sequence) ++wanted_[at_].there;
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
      "from the damaged {} ({} bytes): {} samples, {} missing between them, {} passes, {} of them "
      "without all of their samples{}",
      file.filename().string(), found.file_bytes, found.samples, found.missing, found.passes,
      found.passes_cut, found.info ? "" : "; what the session was is not known");
}

template <class Row>
void add(SessionWriter& writer, const std::vector<Row>& rows) {
  writer.add(std::span(rows));
}

void write_drillings(SessionWriter& writer, const RecoveredRows& rows) {
  add(writer, rows.bones);
  add(writer, rows.structures);
  add(writer, rows.bone_runs);
  add(writer, rows.bone_densities);
  for (std::size_t piece = 0; piece < rows.tool_pieces(); ++piece) {
    add(writer, rows.tool(piece));
  }
  add(writer, rows.removals);
  add(writer, rows.camera);
  add(writer, rows.splits);
  add(writer, rows.procedures);
}

void write(const fs::path& file, const fs::path& out, const RecoveredRows& rows,
           const SessionInfo& info, Recovery& found) {
  std::optional<SessionWriter> opened;
  if (rows.drills()) {
    opened.emplace(out, info, std::span<const BoneRecord>{});
    write_drillings(*opened, rows);
  } else {
    opened.emplace(out, info);
  }
  SessionWriter& writer = *opened;
  Count count(rows.passes, found);
  for (std::size_t piece = 0; piece < rows.sample_pieces(); ++piece) {
    const std::vector<Sample> samples = rows.samples(piece);
    count.add(samples);
    writer.append(samples);
  }
  count.finish();
  for (const PassRow& pass : rows.passes) writer.add_pass(pass);
  for (const EventRow& event : rows.events) writer.add_event(event);
  const std::int64_t last = rows.events.empty() ? 0 : rows.events.back().time_ns;
  writer.add_event({last, "recovered", sentence(file, found)});
  writer.add_stimulus(rows.stimuli);
  writer.add_frames(rows.frames);
  if (rows.summary) writer.set_timing(rows.timing, *rows.summary);
  writer.close();
}

}  // namespace

Recovery recover_session(const fs::path& file, const fs::path& out) {
  const std::vector<std::uint8_t> bytes = contents(file);
  if (FileLock::taken(file)) {
    throw InputError(file.string() +
                     ": another haptrial records into it; allowed: a file that no "
                     "one writes");
  }
  check_target(out);
  const RecoveredRows rows(bytes);
  const std::optional<SessionInfo> info = find_info(file, rows);
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
  if (!found.anything()) return found;
  found.samples = 0;
  write(file, out, rows, info.value_or(SessionInfo{}), found);
  return found;
}

}  // namespace haptrial::record
