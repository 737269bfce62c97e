#include "core/record/read/session_reader.h"

#include <map>
#include <mutex>
#include <set>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "core/record/hdf5/deflate.h"
#include "core/record/hdf5/hdf5_layer.h"
#include "core/record/hdf5/session_info.h"
#include "core/record/read/found_table.h"
#include "core/record/rows/session_tables.h"
#include "core/record/rows/trial_facts.h"
#include "core/record/table/byte_planes.h"
#include "core/record/table/schema.h"

namespace haptrial::record {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRecover = "; save what a damaged file still holds with haptrial recover";

/// The digits in `text` that follow `key`; none without key.
std::string digits_after(const std::string& text, std::string_view key) {
  const std::size_t at = text.find(key);
  if (at == std::string::npos) {
    return "";
  }
  const std::size_t first = at + key.size();
  const std::size_t end = text.find_first_not_of("0123456789", first);
  return text.substr(first, end == std::string::npos ? end : end - first);
}

/// The fault without HDF5's own words for a file that was cut short.
std::string plain(const std::string& fault) {
  const std::string is = digits_after(fault, "truncated file: eof = ");
  const std::string was = digits_after(fault, ", stored_eof = ");
  return !is.empty() && !was.empty() ? "it ends after " + is + " of " + was + " bytes"
         : fault.find("truncated") != std::string::npos ? "it is cut short"
                                                        : fault;
}

void check_regular(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) {
    throw InputError(path.string() + ": no such file; choose a session file (.h5)");
  }
  if (status.type() == fs::file_type::directory) {
    throw InputError(path.string() + ": is a directory; choose a session file (.h5)");
  }
  if (status.type() != fs::file_type::regular) {
    throw InputError(path.string() + ": is not a regular file; choose a session file (.h5)");
  }
}

/// One open dataset.
struct OpenTable {
  std::string name;  // empty: the file does not have it
  std::size_t row_bytes{0};
  std::size_t chunk_rows{0};
  h5::Id dataset;
  std::uint64_t rows{0};
};

OpenTable open_table(const h5::Id& file, const TableSchema& schema) {
  OpenTable table;
  table.name = schema.name;
  table.row_bytes = schema.row_bytes();
  table.dataset = h5::open_table(file, schema, table.chunk_rows);
  table.rows = h5::row_count(table.dataset);
  return table;
}

}  // namespace

struct SessionReader::Impl {
  explicit Impl(const fs::path& file_path) : path(file_path), file(h5::open_file(file_path)) {
    version = get_version(file);
    if (version == 1) {
      info = get_info(file);
    }
    samples = open_table(file, samples_table().schema());
    trials = open_table(file, trials_table().schema(version));
    events = open_table(file, events_table().schema());
    stimuli = open_table(file, stimuli_table().schema());
    timing = open_table(file, timing_table().schema());
    if (version > 3) {
      runs = open_table(file, runs_table().schema());
      begun = open_table(file, begun_table().schema());
    }
    if (version > 1) {
      frames = open_table(file, frames_table().schema());
      attributes = open_table(file, attributes_table().schema());
      if (attributes.rows == 0) {
        throw h5::Error("/attributes is empty");
      }
      info = info_of(joined_events(all(attributes, attributes_table())));
    }
  }

  [[noreturn]] void damaged(const OpenTable& table, std::uint64_t row,
                            const std::string& why) const {
    throw InputError(path.string() + ": rows of /" + table.name + " from " + std::to_string(row) +
                     " on cannot be read (" + why + ")" + std::string(kRecover));
  }

  /// Calls use(planes, row in planes, row in the result, rows) for each chunk that holds rows
  /// [first, first + count). Only fetching takes the lock of HDF5; inflating runs beside others.
  template <typename Use>
  void each_chunk(const OpenTable& table, std::uint64_t first, std::uint64_t count, Use use) const {
    if (first > table.rows || count > table.rows - first) {
      throw std::invalid_argument(path.string() + ": rows [" + std::to_string(first) + ", " +
                                  std::to_string(first + count) + ") of " +
                                  std::to_string(table.rows));
    }
    if (count == 0) {
      return;
    }  // a table that the file's version does not have
    BytePlanes planes(table.row_bytes, table.chunk_rows);
    Inflater inflater;
    for (std::uint64_t done = 0; done < count;) {
      const std::uint64_t row = first + done;
      const std::uint64_t chunk = row - row % table.chunk_rows;
      const std::uint64_t rows = std::min(chunk + table.chunk_rows - row, count - done);
      try {
        const std::vector<std::uint8_t> bytes = h5::read_chunk(table.dataset, chunk);
        if (!inflater.decompress(bytes, {planes.data(), planes.bytes().size()})) {
          damaged(table, chunk, "a chunk does not inflate");
        }
      } catch (const h5::Error& error) {
        damaged(table, chunk, error.what());
      }
      use(planes, row - chunk, done, rows);
      done += rows;
    }
  }

  /// Rows of a table into an array of them. @throws InputError for an unknown word
  void read(const OpenTable& from, const TableDescription& table, std::uint64_t first,
            std::uint64_t count, void* rows) const {
    auto* to = static_cast<std::uint8_t*>(rows);
    each_chunk(from, first, count,
               [&](const BytePlanes& planes, std::size_t at, std::size_t done, std::size_t part) {
                 try {
                   table.get(planes, at, to + done * table.row_size(), part, version);
                 } catch (const UnknownWord& error) {
                   throw InputError(path.string() + ": " + error.what());
                 }
               });
  }

  template <typename Row>
  std::vector<Row> all(const OpenTable& from, const Table<Row>& table) const {
    std::vector<Row> result(from.rows);
    read(from, table, 0, from.rows, result.data());
    return result;
  }

  /// Whether each chunk has the rows that the table says. An older copy of a chunk shows by the
  /// zeros at its end; a chunk that was written has a row, even if that is all zeros.
  TableState state_of(const OpenTable& table) const {
    TableState state{table.name, table.rows, ""};
    BytePlanes planes(table.row_bytes, table.chunk_rows);
    Inflater inflater;
    for (std::uint64_t row = 0; row < table.rows && state.fault.empty(); row += table.chunk_rows) {
      const std::uint64_t rows = std::min<std::uint64_t>(table.chunk_rows, table.rows - row);
      const std::string from = "rows from " + std::to_string(row) + " on ";
      try {
        const std::vector<std::uint8_t> bytes = h5::read_chunk(table.dataset, row);
        if (!inflater.decompress(bytes, {planes.data(), planes.bytes().size()})) {
          state.fault = from + "are damaged";
        } else if (std::max<std::size_t>(1, planes.rows_in_use()) < rows) {
          state.fault = from + "are missing";
        }
      } catch (const h5::Error&) {
        state.fault = from + "cannot be found";
      }
    }
    return state;
  }

  fs::path path;
  h5::Id file;
  std::int64_t version{0};
  SessionInfo info;
  OpenTable samples, trials, events, stimuli, timing, frames, attributes, runs, begun;

  /// A table of a protocol, opened when it is first asked for.
  const OpenTable& own(const TableDescription& table) const {
    const std::lock_guard hold(own_mutex);
    const auto at = protocol_tables.find(table.name());
    if (at != protocol_tables.end()) {
      return at->second;
    }
    OpenTable& opened = protocol_tables[table.name()];
    if (h5::has_table(file, table.name().c_str())) {
      try {
        opened = open_table(file, table.schema(version));
      } catch (const h5::Error& error) {
        protocol_tables.erase(table.name());
        throw InputError(path.string() + ": cannot be read (" + error.what() + ")" + kRecover);
      }
    }
    return opened;
  }

  mutable std::mutex own_mutex;
  mutable std::map<std::string, OpenTable> protocol_tables;  // by name; nodes stay in their place
};

SessionReader::SessionReader(const fs::path& path) {
  check_regular(path);
  try {
    impl_ = std::make_unique<Impl>(path);
  } catch (const h5::Error& error) {
    throw InputError(path.string() + ": cannot be read as a session file (" + plain(error.what()) +
                     "); allowed: an HDF5 file written by haptrial, schema version 1 to " +
                     std::to_string(kSchemaVersion) + kRecover);
  }
}

SessionReader::~SessionReader() = default;
SessionReader::SessionReader(SessionReader&&) noexcept = default;
SessionReader& SessionReader::operator=(SessionReader&&) noexcept = default;

const fs::path& SessionReader::path() const { return impl_->path; }
const SessionInfo& SessionReader::info() const { return impl_->info; }
std::int64_t SessionReader::version() const { return impl_->version; }
std::uint64_t SessionReader::sample_count() const { return impl_->samples.rows; }
std::size_t SessionReader::chunk_rows() const { return impl_->samples.chunk_rows; }

std::vector<Sample> SessionReader::samples(std::uint64_t first, std::uint64_t count) const {
  std::vector<Sample> result(std::min(count, sample_count()));
  impl_->read(impl_->samples, samples_table(), first, count, result.data());
  return result;
}

SampleColumns SessionReader::columns(std::uint64_t first, std::uint64_t count) const {
  const TableSchema& schema = samples_table().schema();
  const std::size_t time = schema.offset("time_ns");
  const std::size_t position = schema.offset("position_x");
  const std::size_t applied = schema.offset("applied_force");
  const std::size_t target = schema.offset("target_force");
  const auto size = static_cast<Eigen::Index>(std::min(count, sample_count()));
  SampleColumns result;
  result.time_ns.resize(static_cast<std::size_t>(size));
  result.position.resize(3, size);
  result.applied_force.resize(size);
  result.target_force.resize(size);
  impl_->each_chunk(
      impl_->samples, first, count,
      [&](const BytePlanes& planes, std::size_t at, std::size_t done, std::size_t rows) {
        get_column_i64(planes, time, at, std::span(result.time_ns).subspan(done, rows));
        for (std::size_t axis = 0; axis < 3; ++axis) {
          get_column_f32(planes, position + 4 * axis, at, rows,
                         result.position.data() + 3 * done + axis, 3);
        }
        get_column_f32(planes, applied, at, rows, result.applied_force.data() + done, 1);
        get_column_f32(planes, target, at, rows, result.target_force.data() + done, 1);
      });
  return result;
}

std::vector<PassRow> SessionReader::passes() const {
  std::vector<PassRow> passes = impl_->all(impl_->trials, trials_table());
  for (const TakenBackRow& row : rows<TakenBackRow>()) {
    if (row.pass >= 0 && std::cmp_less(row.pass, passes.size())) {
      passes[static_cast<std::size_t>(row.pass)].status = PassStatus::kAborted;
    }
  }
  return passes;
}

std::vector<EventRow> SessionReader::events() const {
  return joined_events(impl_->all(impl_->events, events_table()));
}

std::vector<FrameRow> SessionReader::frames() const {
  return impl_->all(impl_->frames, frames_table());
}

std::vector<StimulusRow> SessionReader::stimuli() const {
  return impl_->all(impl_->stimuli, stimuli_table());
}

bool SessionReader::has(const TableDescription& table) const {
  return !impl_->own(table).name.empty();
}

std::uint64_t SessionReader::count(const TableDescription& table) const {
  return impl_->own(table).rows;
}

void SessionReader::read(const TableDescription& table, std::uint64_t first, std::uint64_t count,
                         void* rows) const {
  impl_->read(impl_->own(table), table, first, count, rows);
}

std::vector<std::int64_t> SessionReader::integers(const TableDescription& table, const char* column,
                                                  std::uint64_t first, std::uint64_t count) const {
  std::vector<std::int64_t> values;
  impl_->each_chunk(impl_->own(table), first, count,
                    [&](const BytePlanes& planes, std::size_t at, std::size_t, std::size_t rows) {
                      std::vector<std::uint8_t> row(planes.row_bytes());
                      for (std::size_t i = 0; i < rows; ++i) {
                        planes.get_row(at + i, row);
                        values.push_back(table.integer(row.data(), column, impl_->version));
                      }
                    });
  return values;
}

void SessionReader::each_row(const TableDescription& table,
                             const std::function<void(const std::vector<Cell>&)>& take) const {
  const TableSchema& schema = table.schema();
  const std::size_t bytes = schema.row_bytes();
  impl_->each_chunk(impl_->own(table), 0, count(table),
                    [&](const BytePlanes& planes, std::size_t at, std::size_t, std::size_t rows) {
                      const auto packed = table.packed(planes, at + rows, impl_->version);
                      for (std::size_t i = at; i < at + rows; ++i) {
                        take(cells_of(schema, std::span(packed).subspan(i * bytes, bytes)));
                      }
                    });
}

void SessionReader::columns(const TableDescription& table, std::uint64_t first, std::uint64_t count,
                            std::span<const ColumnTarget> targets) const {
  const bool is_present = &table.schema(impl_->version) == &table.schema();
  impl_->each_chunk(
      impl_->own(table), first, count,
      [&](const BytePlanes& planes, std::size_t at, std::size_t done, std::size_t rows) {
        if (is_present) {
          get_columns(table, planes, at, {done, rows}, targets);
          return;
        }
        BytePlanes present(table.schema().row_bytes(), at + rows);
        const std::vector<std::uint8_t> packed = table.packed(planes, at + rows, impl_->version);
        for (std::size_t i = 0; i < at + rows; ++i) {
          present.put_row(i,
                          std::span(packed).subspan(i * present.row_bytes(), present.row_bytes()));
        }
        get_columns(table, present, at, {done, rows}, targets);
      });
}

std::vector<std::string> SessionReader::table_names() const {
  try {
    return h5::table_names(impl_->file);
  } catch (const h5::Error& error) {
    throw InputError(path().string() + ": cannot be read (" + error.what() + ")" + kRecover);
  }
}

std::unique_ptr<const TableDescription> SessionReader::description(const std::string& table) const {
  try {
    return std::make_unique<FoundTable>(h5::table_in_file(impl_->file, table));
  } catch (const h5::Error& error) {
    throw InputError(path().string() + ": cannot be read (" + error.what() + ")" + kRecover);
  }
}

std::vector<TimingRow> SessionReader::timing() const {
  std::vector<TimingRow> bins;
  for (const TimingRow& row : impl_->all(impl_->timing, timing_table())) {
    const auto same = std::find_if(bins.begin(), bins.end(), [&](const TimingRow& bin) {
      return bin.bin_low_ns == row.bin_low_ns && bin.bin_high_ns == row.bin_high_ns;
    });
    if (same == bins.end()) {
      bins.push_back(row);
    } else {
      same->period_count += row.period_count;
      same->lateness_count += row.lateness_count;
      same->compute_count += row.compute_count;
    }
  }
  std::stable_sort(bins.begin(), bins.end(), [](const TimingRow& a, const TimingRow& b) {
    return a.bin_low_ns < b.bin_low_ns;
  });
  return bins;
}

std::vector<RunRow> SessionReader::runs() const { return impl_->all(impl_->runs, runs_table()); }
std::vector<BegunRow> SessionReader::begun() const {
  return impl_->all(impl_->begun, begun_table());
}

std::vector<TableState> SessionReader::tables() const {
  std::vector<TableState> states;
  std::set<std::string> told;
  for (const OpenTable* table :
       {&impl_->samples, &impl_->trials, &impl_->events, &impl_->stimuli, &impl_->timing,
        &impl_->frames, &impl_->attributes, &impl_->runs, &impl_->begun}) {
    if (!table->name.empty()) {
      states.push_back(impl_->state_of(*table));
      told.insert(table->name);
    }
  }
  try {
    for (const std::string& name : h5::table_names(impl_->file)) {
      if (told.contains(name)) {
        continue;
      }
      OpenTable table;
      table.name = name;
      table.dataset = h5::open_table(impl_->file, name, table.row_bytes, table.chunk_rows);
      table.rows = h5::row_count(table.dataset);
      states.push_back(impl_->state_of(table));
    }
  } catch (const h5::Error& error) {
    throw InputError(path().string() + ": cannot be read (" + error.what() + ")" + kRecover);
  }
  return states;
}

std::optional<TimingSummary> SessionReader::timing_summary() const {
  try {
    const h5::Id& dataset = impl_->timing.dataset;
    const std::int64_t ticks = h5::get_i64(dataset, "ticks");
    if (ticks < 0) {
      return std::nullopt;
    }
    return TimingSummary{static_cast<std::uint64_t>(ticks),
                         static_cast<std::uint64_t>(h5::get_i64(dataset, "overruns")),
                         static_cast<std::uint64_t>(h5::get_i64(dataset, "dropped"))};
  } catch (const h5::Error& error) {
    throw InputError(path().string() + ": the counts of /timing cannot be read (" + error.what() +
                     ")" + std::string(kRecover));
  }
}

}  // namespace haptrial::record
