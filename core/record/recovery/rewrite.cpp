#include "core/record/recovery/rewrite.h"

#include <fstream>
#include <string>
#include <system_error>

#include "core/base/error.h"
#include "core/record/hdf5/session_info.h"
#include "core/record/read/isolated.h"

namespace haptrial::record {
namespace {

namespace fs = std::filesystem;
using Keeps = std::function<bool(std::uint64_t)>;

/// Packed rows for which `keeps` is true.
template <class Keeps>
void add(SessionWriter& writer, const RecoveredTable& table, const char* column, Keeps keeps) {
  const std::size_t bytes = table.table().schema().row_bytes();
  for (std::size_t piece = 0; piece < table.pieces(); ++piece) {
    const std::vector<std::uint8_t> rows = table.piece(piece);
    for (std::size_t at = 0; at < rows.size(); at += bytes) {
      if (column == nullptr || keeps(table.table().integer(rows.data() + at, column))) {
        writer.add_packed(table.table(), std::span(rows).subspan(at, bytes));
      }
    }
  }
}

bool is_of_ticks(const TableDescription& table) {
  return table.of() == RowsOf::kTick || table.of() == RowsOf::kEachTick;
}

bool is_of_passes(const TableDescription& table) {
  return table.of() == RowsOf::kEndedPass || table.of() == RowsOf::kPass;
}

void write_own(SessionWriter& writer, const RecoveredRows& rows, const Keeps& keeps) {
  for (const RecoveredTable& table : rows.own) {
    if (!is_of_passes(table.table()) && table.count() > 0) {
      add(writer, table, is_of_ticks(table.table()) ? "sequence" : nullptr,
          [&](std::int64_t sequence) { return keeps(static_cast<std::uint64_t>(sequence)); });
    }
  }
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
  if (!in) {
    throw InputError(file.string() + ": cannot be read; choose a session file");
  }
  return bytes;
}

RecoveredRows rows_in(const fs::path& file, std::span<const std::uint8_t> contents,
                      const TableList& tables) {
  try {
    return RecoveredRows(contents, tables);
  } catch (const UnknownWord& error) {
    throw InputError(file.string() + ": " + error.what());
  }
}

std::optional<SessionInfo> find_info(const fs::path& file, const RecoveredRows& rows) {
  if (!rows.attributes.empty()) {
    return info_of(rows.attributes);
  }
  return isolated_info(file);
}

void write_rows(SessionWriter& writer, const RecoveredRows& rows, const Keeps& keeps,
                const std::function<void(std::span<const Sample>)>& told) {
  write_own(writer, rows, keeps);
  for (std::size_t piece = 0; piece < rows.sample_pieces(); ++piece) {
    std::vector<Sample> samples = rows.samples(piece);
    std::erase_if(samples, [&](const Sample& sample) { return !keeps(sample.sequence); });
    told(samples);
    writer.append(samples);
  }
  for (const EventRow& event : rows.events) {
    writer.add_event(event);
  }
  for (const BegunRow& pass : rows.begun) {
    writer.begin_pass(pass);
  }
  writer.add_stimulus(rows.stimuli);
  writer.add_frames(rows.frames);
  writer.keep_runs(rows.runs);
}

void write_rows_of_passes(SessionWriter& writer, const RecoveredRows& rows, std::size_t passes,
                          std::size_t begun) {
  for (const RecoveredTable& table : rows.own) {
    if (is_of_passes(table.table()) && table.count() > 0) {
      const std::size_t known = table.table().of() == RowsOf::kPass ? begun : passes;
      add(writer, table, "pass",
          [&](std::int64_t pass) { return pass < 0 || static_cast<std::uint64_t>(pass) < known; });
    }
  }
}

std::optional<SessionInfo> isolated_info(const std::filesystem::path& file) {
  // Every field as name, NUL, value, NUL.
  const auto text = in_a_process_of_its_own(0, [&] {
    std::string all;
    for (const EventRow& row : info_rows(get_info(h5::open_file(file)))) {
      all += row.kind + '\0' + row.text + '\0';
    }
    return all;
  });
  if (!text) {
    return std::nullopt;
  }
  std::vector<std::string> words;
  for (std::size_t at = 0; at < text->size(); at = text->find('\0', at) + 1) {
    words.emplace_back(text->c_str() + at);
  }
  std::vector<EventRow> rows;
  for (std::size_t i = 0; i + 1 < words.size(); i += 2) {
    rows.push_back({0, words[i], words[i + 1]});
  }
  return info_of(rows);
}

}  // namespace haptrial::record
