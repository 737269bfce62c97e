#include "core/record/rewrite.h"

#include <fstream>
#include <system_error>

#include "core/base/error.h"
#include "core/record/isolated_info.h"
#include "core/record/session_info.h"

namespace haptrial::record {
namespace {

namespace fs = std::filesystem;
using Keeps = std::function<bool(std::uint64_t)>;

template <class Row>
void add(SessionWriter& writer, const std::vector<Row>& rows) {
  writer.add(std::span(rows));
}

template <class Row>
void add_ticks(SessionWriter& writer, std::vector<Row> rows, const Keeps& keeps) {
  std::erase_if(rows, [&](const Row& row) { return !keeps(row.sequence); });
  add(writer, rows);
}

void write_drillings(SessionWriter& writer, const RecoveredRows& rows, const Keeps& keeps) {
  add(writer, rows.bones);
  add(writer, rows.structures);
  add(writer, rows.bone_runs);
  add(writer, rows.bone_densities);
  for (std::size_t piece = 0; piece < rows.tool_pieces(); ++piece) {
    add_ticks(writer, rows.tool(piece), keeps);
  }
  add_ticks(writer, rows.removals, keeps);
  add_ticks(writer, rows.camera, keeps);
  add_ticks(writer, rows.splits, keeps);
}

}  // namespace

std::vector<std::uint8_t> contents_of(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    throw InputError(file.string() + ": is not a file that can be read; choose a session file");
  }
  std::ifstream in(file, std::ios::binary);
  std::vector<std::uint8_t> bytes(fs::file_size(file, error));
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!in) throw InputError(file.string() + ": cannot be read; choose a session file");
  return bytes;
}

std::optional<SessionInfo> find_info(const fs::path& file, const RecoveredRows& rows) {
  if (!rows.attributes.empty()) return info_of(rows.attributes);
  return isolated_info(file);
}

SessionWriter open_for(const fs::path& out, const SessionInfo& info, const RecoveredRows& rows) {
  return rows.drills() ? SessionWriter(out, info, std::span<const BoneRecord>{})
                       : SessionWriter(out, info);
}

void write_rows(SessionWriter& writer, const RecoveredRows& rows, const Keeps& keeps,
                const std::function<void(std::span<const Sample>)>& told) {
  if (rows.drills()) write_drillings(writer, rows, keeps);
  for (std::size_t piece = 0; piece < rows.sample_pieces(); ++piece) {
    std::vector<Sample> samples = rows.samples(piece);
    std::erase_if(samples, [&](const Sample& sample) { return !keeps(sample.sequence); });
    told(samples);
    writer.append(samples);
  }
  for (const EventRow& event : rows.events) writer.add_event(event);
  for (const BegunRow& pass : rows.begun) writer.begin_pass(pass);
  writer.add_stimulus(rows.stimuli);
  writer.add_frames(rows.frames);
  writer.keep_runs(rows.runs);
}

}  // namespace haptrial::record
