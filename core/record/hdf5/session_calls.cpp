// The public members of SessionWriter; what they share is in session_writer_impl.cpp.
#include <cstdio>
#include <utility>

#include "core/base/error.h"
#include "core/record/hdf5/session_info.h"
#include "core/record/hdf5/session_target.h"
#include "core/record/hdf5/session_writer_impl.h"
#include "core/record/rows/session_tables.h"

namespace haptrial::record {

namespace fs = std::filesystem;

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
  if (!impl_ || !impl_->file) {
    return;
  }
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
  if (!impl_->closable()) {
    impl_->divert_file();
  }
  impl_->close_tables();
  impl_->file.reset();
  trim(impl_->partial);
}

void SessionWriter::append(std::span<const Sample> rows) {
  impl_->guarded([&] {
    TableWriter& table = *impl_->samples;
    bool finished_chunk = false;
    // Rows of the ticks are in the file before the ticks are, whenever the process is killed.
    if (impl_->live && rows.size() >= table.room()) {
      impl_->write_own();
    }
    while (!rows.empty()) {
      const std::size_t count = std::min(table.room(), rows.size());
      table.add(samples_table(), rows.first(count));
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
    // The row fills its chunk, which goes out at once: what it refers to goes before it.
    if (impl_->trials->room() == 1) {
      impl_->write_before_trials();
    }
    impl_->trials->add(trials_table(), std::span(&pass, 1));
  });
}

void SessionWriter::add_event(const EventRow& event) {
  impl_->guarded([&] { impl_->events->add(events_table(), event_parts(event)); });
}

void SessionWriter::begin_pass(const BegunRow& pass) {
  impl_->guarded([&] {
    impl_->begun->add(begun_table(), std::span(&pass, 1));
    if (impl_->live) {
      impl_->write(false);
    }
  });
}

void SessionWriter::add_stimulus(std::span<const StimulusRow> rows) {
  impl_->guarded([&] {
    impl_->stimuli->add(stimuli_table(), rows);
    if (impl_->live) {
      impl_->write(false);
    }  // a block is there whole or not at all
  });
}

void SessionWriter::add_frames(std::span<const FrameRow> rows) {
  impl_->guarded([&] { impl_->frames->add(frames_table(), rows); });
}

void SessionWriter::add(const Rows& rows) {
  impl_->guarded([&] { impl_->put(rows); });
}

void SessionWriter::add_at_once(const Rows& rows) {
  impl_->guarded([&] {
    impl_->put(rows);
    if (!impl_->live) {
      return;
    }
    impl_->write(false);
    impl_->syncing->soon();
  });
}

void SessionWriter::add_packed(const TableDescription& table, std::span<const std::uint8_t> rows) {
  impl_->guarded([&] {
    TableWriter& to = impl_->protocol_table(table);
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
  impl_->guarded([&] { impl_->timing->add(timing_table(), rows); });
}

void SessionWriter::set_timing(std::span<const TimingRow> histogram, const TimingSummary& summary,
                               RunState state) {
  if (impl_->has_timing) {
    throw std::invalid_argument("the timing of a run is set once");
  }
  keep_timing(histogram);
  impl_->guarded([&] {
    impl_->run.counts = summary;
    impl_->add_run(state);
    impl_->write(true);  // the counts of the session say that it ended: last of all
    if (state == RunState::kEnded) {
      impl_->put_counts();
    }
    impl_->has_timing = true;
  });
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
    if (impl_->syncing) {
      impl_->syncing->soon();
    }
  });
}

std::vector<std::string> SessionWriter::take_notices() { return std::exchange(impl_->notices, {}); }

void SessionWriter::sync() {
  impl_->guarded([&] {
    impl_->heed_disk();
    impl_->write(true);
    sync_data(h5::descriptor(impl_->file));
    if (!impl_->folder_synced) {
      sync_folder_of(impl_->partial);
    }
    impl_->folder_synced = true;
  });
}

bool SessionWriter::can_go_on() const noexcept { return impl_->file && impl_->failure.empty(); }

void SessionWriter::close() {
  impl_->guarded([&] {
    impl_->put_back();
    impl_->write(true);
    probe(h5::descriptor(impl_->file));
    const std::vector<WrittenTable> written = impl_->written_tables();
    impl_->close_tables();
    h5::close(impl_->file);
    impl_->syncing.reset();
    trim(impl_->partial);
    sync_file(impl_->partial);
    impl_->read_back(written);
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
  // Data of a new session that HDF5 still holds need not reach the disk.
  if (!impl_->resumed) {
    impl_->divert_file();
  }
  impl_->close_tables();
  impl_->file.reset();
  impl_->syncing.reset();
  if (!impl_->resumed) {
    std::remove(impl_->partial.c_str());
  }
  impl_->lock = FileLock();
}

}  // namespace haptrial::record
