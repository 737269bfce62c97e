#include "core/record/hdf5/session_writer_impl.h"

#include <algorithm>
#include <cstdio>
#include <type_traits>
#include <utility>

#include "core/base/error.h"
#include "core/record/hdf5/session_info.h"
#include "core/record/hdf5/session_target.h"
#include "core/record/rows/session_tables.h"
#include "core/record/table/schema.h"

namespace haptrial::record {
namespace {

namespace fs = std::filesystem;

// Dry runs write twelve sessions in seconds; a session with a person has time, and short chunks.
constexpr int kFastLevel = 1;
constexpr int kLiveLevel = 3;
constexpr int kDenseLevel = 6;

bool is_live(const SessionInfo& info) { return info.clock == "real"; }

void put_attributes(TableWriter& table, const std::vector<EventRow>& rows) {
  for (const EventRow& row : rows) {
    table.add(attributes_table(), event_parts(row));
  }
}

}  // namespace

SessionWriter::Impl::Impl(const fs::path& file_path, const SessionInfo& info,
                          const TableList& protocol_tables, std::span<const Rows> first_rows)
    : final_path(file_path),
      partial(partial_path(file_path)),
      live(is_live(info)),
      lock(FileLock::take(new_path(file_path), true)) {
  for (const TableDescription* table : protocol_tables) {
    own.push_back({table, std::nullopt});
  }
  const fs::path created = new_path(file_path);
  try {
    file = h5::create_file(created, true);
    space.ensure(h5::descriptor(file), 0);
    put_info(file, info);
    for (const Part& part : tables()) {
      const TableSchema& schema = *part.schema;
      part.writer->emplace(
          file, live && part.each_tick ? schema.with_chunks(live_chunk_rows(info.rate)) : schema,
          level_of(part), ensure_space());
    }
    for (const char* count : {"ticks", "overruns", "dropped"}) {
      h5::put(timing->dataset(), count, std::int64_t{-1});
    }
    put_attributes(*attributes, info_rows(info));
    h5::start_swmr(file);
    for (const Rows& rows : first_rows) {
      put(rows);
    }
    write(true);
    if (live) {
      sync_data(h5::descriptor(file));
    }  // what the session is survives whatever follows
    give_name(created, partial);
    start_syncing();
  } catch (...) {
    divert_file();
    close_tables();
    file.reset();
    std::remove(created.c_str());
    throw;
  }
}

SessionWriter::Impl::Impl(const fs::path& file_path, const SessionInfo& info, FileLock held,
                          const TableList& protocol_tables)
    : final_path(file_path),
      partial(partial_path(file_path)),
      live(is_live(info)),
      lock(std::move(held)),
      resumed(true) {
  for (const TableDescription* table : protocol_tables) {
    own.push_back({table, std::nullopt});
  }
  try {
    go_on();
  } catch (...) {
    close_tables();
    file.reset();
    throw;
  }
}

void SessionWriter::Impl::go_on() {
  file = h5::open_to_go_on(partial);
  space = {};
  space.ensure(h5::descriptor(file), 0);
  for (const Part& part : tables()) {
    part.writer->emplace(TableWriter::go_on(file, *part.schema, level_of(part), ensure_space()));
  }
  h5::flush(file);
  start_syncing();
}

void SessionWriter::Impl::start_syncing() {
  constexpr std::chrono::milliseconds kEvery{500};
  if (live) {
    syncing = std::make_unique<DiskSync>(lock.descriptor(), partial, kEvery);
  }
}

std::vector<SessionWriter::Impl::Part> SessionWriter::Impl::tables() {
  std::vector<Part> all{{&samples, &samples_table().schema(), true},
                        {&frames, &frames_table().schema(), false},
                        {&trials, &trials_table().schema(), false},
                        {&events, &events_table().schema(), false},
                        {&stimuli, &stimuli_table().schema(), false},
                        {&timing, &timing_table().schema(), false},
                        {&attributes, &attributes_table().schema(), false},
                        {&runs, &runs_table().schema(), false},
                        {&begun, &begun_table().schema(), false}};
  for (ProtocolTable& each : own) {
    all.push_back({&each.writer, &each.table->schema(), each.table->of() == RowsOf::kEachTick,
                   each.table->dense()});
  }
  return all;
}

int SessionWriter::Impl::level_of(const Part& part) const {
  return part.dense ? kDenseLevel : live ? kLiveLevel : kFastLevel;
}

TableWriter& SessionWriter::Impl::protocol_table(const TableDescription& table) {
  for (ProtocolTable& each : own) {
    if (each.table->name() == table.name()) {
      return *each.writer;
    }
  }
  throw std::invalid_argument(final_path.string() + ": the session has no table /" + table.name());
}

void SessionWriter::Impl::put(const Rows& rows) {
  protocol_table(*rows.table).add(*rows.table, rows.data, rows.count);
}

TableWriter::EnsureSpace SessionWriter::Impl::ensure_space() {
  return [this](std::uint64_t bytes) { space.ensure(h5::descriptor(file), bytes); };
}

void SessionWriter::Impl::check_open() const {
  if (!failure.empty()) {
    throw RunError(failure);
  }
  if (!file) {
    throw std::invalid_argument(final_path.string() + ": the session was closed before");
  }
}

void SessionWriter::Impl::give_up(const std::string& why) {
  failure = final_path.string() + ": the session cannot be written (" + why +
            "); what came before is in " + final_path.filename().string() + ".partial";
  throw RunError(failure);
}

/// Rows that a row of /trials refers to are on their way to the disk before that row is, whenever
/// the process is killed.
void SessionWriter::Impl::write_before_trials() {
  samples->write_unfinished();
  for (ProtocolTable& each : own) {
    each.writer->write_unfinished();
  }
  h5::flush(file);
}

void SessionWriter::Impl::write_own() {
  for (ProtocolTable& each : own) {
    if (each.table->of() != RowsOf::kEachTick) {
      each.writer->write_unfinished();
    }
  }
}

void SessionWriter::Impl::write(bool all) {
  if (all || trials->has_unwritten()) {
    write_before_trials();
  } else {
    write_own();
  }
  if (all) {
    frames->write_unfinished();
  }
  for (auto* table : {&begun, &trials, &events, &stimuli, &timing, &runs, &attributes}) {
    (*table)->write_unfinished();
  }
  h5::flush(file);
}

void SessionWriter::Impl::add_run(RunState state) {
  if (run_row && run_row->state == RunState::kEnded) {
    return;
  }  // of a file that is written anew
  run.state = state;
  runs->add(runs_table(), std::span(&run, 1));
  run_row = run;
}

void SessionWriter::Impl::divert_file() noexcept {
  try {
    if (file) {
      divert(h5::descriptor(file));
    }
  } catch (const h5::Error&) {
    // Without a descriptor there is nothing to divert.
  }
}

bool SessionWriter::Impl::closable() noexcept {
  try {
    probe(h5::descriptor(file));
    return true;
  } catch (const h5::Error&) {
    return false;
  }
}

void SessionWriter::Impl::close_tables() noexcept {
  for (const Part& part : tables()) {
    if (*part.writer) {
      (*part.writer)->close();
    }
  }
}

std::vector<WrittenTable> SessionWriter::Impl::written_tables() {
  std::vector<WrittenTable> written;
  for (const Part& part : tables()) {
    written.push_back({part.schema, (*part.writer)->rows()});
  }
  return written;
}

void SessionWriter::Impl::read_back(std::span<const WrittenTable> written) {
  if (const std::string what = find_unreadable(partial, written, live); !what.empty()) {
    failure = partial.string() + ": the session does not read back (" + what +
              "), as if another program had changed its file; it keeps this name, and haptrial " +
              "recover " + partial.string() + " saves what it still holds";
    throw RunError(failure);
  }
}

void SessionWriter::Impl::put_counts() {
  const std::array<std::pair<const char*, std::uint64_t>, 3> counts{
      {{"dropped", run.counts.dropped + earlier.dropped},
       {"overruns", run.counts.overruns + earlier.overruns},
       {"ticks", run.counts.ticks + earlier.ticks}}};
  for (const auto& [name, count] : counts) {
    h5::put(timing->dataset(), name, static_cast<std::int64_t>(count));
    put_attributes(*attributes, {{0, name, std::to_string(count)}});
  }
}

}  // namespace haptrial::record
