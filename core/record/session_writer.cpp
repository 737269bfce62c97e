#include "core/record/session_writer.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "core/base/error.h"
#include "core/record/row_codec.h"
#include "core/record/run_codec.h"
#include "core/record/schema.h"
#include "core/record/session_info.h"
#include "core/record/session_target.h"
#include "core/record/session_writer_impl.h"

namespace haptrial::record {
namespace {

namespace fs = std::filesystem;

// Dry runs write twelve sessions in seconds; a session with a person has time, and short chunks.
constexpr int kFastLevel = 1;
constexpr int kLiveLevel = 3;

bool is_live(const SessionInfo& info) { return info.clock == "real"; }

void put_attributes(TableWriter& table, const std::vector<EventRow>& rows) {
  for (const EventRow& row : rows) {
    for (const EventPart& part : event_parts(row)) {
      put_attribute(table.planes(), table.used(), part);
      table.added(1);
    }
  }
}

}  // namespace

SessionWriter::Impl::Impl(const fs::path& file_path, const SessionInfo& info,
                          const TableList& own_tables, std::span<const Rows> first_rows)
    : final_path(file_path),
      partial(partial_path(file_path)),
      live(is_live(info)),
      lock(FileLock::take(new_path(file_path), true)) {
  for (const TableDescription* table : own_tables) {
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
          live ? kLiveLevel : kFastLevel, ensure_space());
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
    if (live) sync_data(h5::descriptor(file));  // what the session is survives whatever follows
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
                          const TableList& own_tables)
    : final_path(file_path),
      partial(partial_path(file_path)),
      live(is_live(info)),
      lock(std::move(held)),
      resumed(true) {
  for (const TableDescription* table : own_tables) {
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
    part.writer->emplace(
        TableWriter::go_on(file, *part.schema, live ? kLiveLevel : kFastLevel, ensure_space()));
  }
  h5::flush(file);
  start_syncing();
}

void SessionWriter::Impl::start_syncing() {
  constexpr std::chrono::milliseconds kEvery{500};
  if (live) syncing = std::make_unique<DiskSync>(lock.descriptor(), partial, kEvery);
}

std::vector<SessionWriter::Impl::Part> SessionWriter::Impl::tables() {
  std::vector<Part> all{{&samples, &samples_schema(), true},
                        {&frames, &frames_schema(), false},
                        {&trials, &trials_schema(), false},
                        {&events, &events_schema(), false},
                        {&stimuli, &stimuli_schema(), false},
                        {&timing, &timing_schema(), false},
                        {&attributes, &attributes_schema(), false},
                        {&runs, &runs_schema(), false},
                        {&begun, &begun_schema(), false}};
  for (Own& each : own) {
    all.push_back({&each.writer, &each.table->schema(), each.table->of() == RowsOf::kEachTick});
  }
  return all;
}

TableWriter& SessionWriter::Impl::own_table(const TableDescription& table) {
  for (Own& each : own) {
    if (each.table->name() == table.name()) {
      return *each.writer;
    }
  }
  throw std::invalid_argument(final_path.string() + ": the session has no table /" + table.name());
}

void SessionWriter::Impl::put(const Rows& rows) {
  TableWriter& to = own_table(*rows.table);
  const auto* from = static_cast<const std::uint8_t*>(rows.data);
  for (std::size_t done = 0; done < rows.count;) {
    const std::size_t count = std::min(to.room(), rows.count - done);
    rows.table->put(to.planes(), to.used(), from + done * rows.table->row_size(), count);
    to.added(count);
    done += count;
  }
}

TableWriter::EnsureSpace SessionWriter::Impl::ensure_space() {
  return [this](std::uint64_t bytes) { space.ensure(h5::descriptor(file), bytes); };
}

void SessionWriter::Impl::check_open() const {
  if (!failure.empty()) throw RunError(failure);
  if (!file) throw std::invalid_argument(final_path.string() + ": the session was closed before");
}

void SessionWriter::Impl::give_up(const std::string& why) {
  failure = final_path.string() + ": the session cannot be written (" + why +
            "); what came before is in " + final_path.filename().string() + ".partial";
  throw RunError(failure);
}

/// Before a row of /trials that refers to them, whenever the process is killed.
void SessionWriter::Impl::write_samples() {
  samples->write_unfinished();
  for (Own& each : own) {
    if (each.table->of() == RowsOf::kEachTick) {
      each.writer->write_unfinished();
    }
  }
  h5::flush(file);
}

void SessionWriter::Impl::write_own() {
  for (Own& each : own) {
    if (each.table->of() != RowsOf::kEachTick) {
      each.writer->write_unfinished();
    }
  }
}

void SessionWriter::Impl::write(bool all) {
  if (all || trials->has_unwritten()) write_samples();
  if (all) frames->write_unfinished();
  for (auto* table : {&begun, &trials, &events, &stimuli, &timing, &runs, &attributes}) {
    (*table)->write_unfinished();
  }
  write_own();
  h5::flush(file);
}

void SessionWriter::Impl::add_run(RunState state) {
  if (run_row && run_row->state == RunState::kEnded) return;  // of a file that is written anew
  run.state = state;
  put_run(runs->planes(), runs->used(), run);
  runs->added(1);
  run_row = run;
}

void SessionWriter::Impl::divert_file() noexcept {
  try {
    if (file) divert(h5::descriptor(file));
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

SessionWriter::SessionWriter(const fs::path& final_path, const SessionInfo& info)
    : SessionWriter(final_path, info, TableList{}) {}

SessionWriter::SessionWriter(const fs::path& final_path, const SessionInfo& info,
                             const TableList& tables, std::span<const Rows> first_rows) {
  check_target(final_path);
  if (const auto name = text_with_nul(info)) {
    throw InputError(final_path.string() + ": " + *name + " holds a NUL byte; remove it");
  }
  try {
    impl_ = std::make_unique<Impl>(final_path, info, tables, first_rows);
  } catch (const h5::Error& error) {
    throw RunError(final_path.string() + ": the session file cannot be created (" + error.what() +
                   ")");
  }
}

SessionWriter::SessionWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SessionWriter::SessionWriter(SessionWriter&&) noexcept = default;

SessionWriter::~SessionWriter() {
  if (!impl_ || !impl_->file) return;
  try {
    if (impl_->failure.empty()) {
      impl_->guarded([&] {
        impl_->put_back();
        impl_->write(true);
      });
    }
  } catch (const std::exception&) {
    // The destructor has no one to tell; close() is for those who want to know.
  }
  if (!impl_->closable()) impl_->divert_file();
  impl_->close_tables();
  impl_->file.reset();
  trim(impl_->partial);
}

void SessionWriter::append(std::span<const Sample> rows) {
  impl_->guarded([&] {
    TableWriter& table = *impl_->samples;
    bool finished_chunk = false;
    // What the ticks did is there before they are, whenever the process is killed.
    if (impl_->live && rows.size() >= table.room()) {
      impl_->write_own();
    }
    while (!rows.empty()) {
      const std::size_t count = std::min(table.room(), rows.size());
      put_samples(table.planes(), table.used(), rows.first(count));
      table.added(count);
      finished_chunk = finished_chunk || table.used() == 0;
      rows = rows.subspan(count);
    }
    if (finished_chunk && impl_->live) {
      h5::flush(impl_->file);
      impl_->syncing->soon();
    }
  });
}

void SessionWriter::add_pass(const PassRow& pass) {
  impl_->guarded([&] {
    put_pass(impl_->trials->planes(), impl_->trials->used(), pass);
    if (impl_->trials->room() == 1) impl_->write_samples();
    impl_->trials->added(1);
  });
}

void SessionWriter::add_event(const EventRow& event) {
  impl_->guarded([&] {
    for (const EventPart& part : event_parts(event)) {
      put_event(impl_->events->planes(), impl_->events->used(), part);
      impl_->events->added(1);
    }
  });
}

void SessionWriter::begin_pass(const BegunRow& pass) {
  impl_->guarded([&] {
    put_begun(impl_->begun->planes(), impl_->begun->used(), pass);
    impl_->begun->added(1);
    if (impl_->live) impl_->write(false);
  });
}

void SessionWriter::add_stimulus(std::span<const StimulusRow> rows) {
  impl_->guarded([&] {
    for (const StimulusRow& row : rows) {
      put_stimulus(impl_->stimuli->planes(), impl_->stimuli->used(), row);
      impl_->stimuli->added(1);
    }
    if (impl_->live) impl_->write(false);  // a block is there whole or not at all
  });
}

void SessionWriter::add_frames(std::span<const FrameRow> rows) {
  impl_->guarded([&] {
    for (const FrameRow& row : rows) {
      put_frame(impl_->frames->planes(), impl_->frames->used(), row);
      impl_->frames->added(1);
    }
  });
}

void SessionWriter::add(const Rows& rows) {
  impl_->guarded([&] { impl_->put(rows); });
}

void SessionWriter::add_at_once(const Rows& rows) {
  impl_->guarded([&] {
    impl_->put(rows);
    if (!impl_->live) {
      impl_->own_table(*rows.table).write_unfinished();
      h5::flush(impl_->file);
      return;
    }
    impl_->write(false);
    impl_->syncing->soon();
  });
}

void SessionWriter::add_packed(const TableDescription& table, std::span<const std::uint8_t> rows) {
  impl_->guarded([&] {
    TableWriter& to = impl_->own_table(table);
    const std::size_t bytes = table.schema().row_bytes();
    for (std::size_t at = 0; at < rows.size(); at += bytes) {
      to.planes().put_row(to.used(), rows.subspan(at, bytes));
      to.added(1);
    }
  });
}

void SessionWriter::set_planned(std::int32_t trials) { impl_->run.planned = trials; }

void SessionWriter::note_counts(const TimingSummary& so_far) {
  impl_->guarded([&] {
    impl_->run.counts = so_far;
    const auto& told = impl_->run_row;
    if (!told || told->run != impl_->run.run || told->counts.overruns != so_far.overruns ||
        told->counts.dropped != so_far.dropped) {
      impl_->add_run(RunState::kRunning);
    }
  });
}

void SessionWriter::keep_runs(std::span<const RunRow> rows) {
  impl_->guarded([&] {
    for (const RunRow& row : rows) {
      impl_->run = row;
      impl_->add_run(row.state);
    }
  });
}

void SessionWriter::keep_timing(std::span<const TimingRow> rows) {
  impl_->guarded([&] {
    for (const TimingRow& row : rows) {
      put_timing(impl_->timing->planes(), impl_->timing->used(), row);
      impl_->timing->added(1);
    }
  });
}

void SessionWriter::set_timing(std::span<const TimingRow> histogram, const TimingSummary& summary,
                               RunState state) {
  if (impl_->has_timing) throw std::invalid_argument("the timing of a run is set once");
  keep_timing(histogram);
  impl_->guarded([&] {
    impl_->run.counts = summary;
    impl_->add_run(state);
    impl_->write(true);  // the counts of the session say that it ended: last of all
    if (state == RunState::kEnded) impl_->put_counts();
    impl_->has_timing = true;
  });
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

void SessionWriter::flush() {
  impl_->guarded([&] {
    impl_->heed_disk();
    impl_->write(!impl_->live);
  });
}

void SessionWriter::sync_soon() {
  impl_->guarded([&] {
    impl_->heed_disk();
    impl_->write(true);
    if (impl_->syncing) impl_->syncing->soon();
  });
}

std::vector<std::string> SessionWriter::take_notices() { return std::exchange(impl_->notices, {}); }

void SessionWriter::sync() {
  impl_->guarded([&] {
    impl_->heed_disk();
    impl_->write(true);
    sync_data(h5::descriptor(impl_->file));
    if (!impl_->folder_synced) sync_folder_of(impl_->partial);
    impl_->folder_synced = true;
  });
}

bool SessionWriter::can_go_on() const noexcept { return impl_->file && impl_->failure.empty(); }

void SessionWriter::close() {
  impl_->guarded([&] {
    impl_->put_back();
    impl_->write(true);
    probe(h5::descriptor(impl_->file));
    impl_->close_tables();
    h5::close(impl_->file);
    impl_->syncing.reset();
    trim(impl_->partial);
    sync_file(impl_->partial);
    give_name(impl_->partial, impl_->final_path);
    impl_->finished = true;
    impl_->lock = FileLock();
    sync_folder_of(impl_->final_path);
  });
}

void SessionWriter::discard() {
  if (impl_->finished) {
    throw std::invalid_argument(impl_->final_path.string() + ": the session was closed before");
  }
  // What HDF5 still holds of a new session need not reach the disk.
  if (!impl_->resumed) impl_->divert_file();
  impl_->close_tables();
  impl_->file.reset();
  impl_->syncing.reset();
  if (!impl_->resumed) std::remove(impl_->partial.c_str());
  impl_->lock = FileLock();
}

}  // namespace haptrial::record
