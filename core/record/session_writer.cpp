#include "core/record/session_writer.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "core/record/disk_space.h"
#include "core/record/hdf5_layer.h"
#include "core/record/row_codec.h"
#include "core/record/schema.h"
#include "core/record/table_writer.h"

namespace haptrial::record {
namespace {

namespace fs = std::filesystem;

fs::path partial_path(const fs::path& final_path) {
  fs::path path = final_path;
  path += ".partial";
  return path;
}

void check_target(const fs::path& final_path, const fs::path& partial) {
  const std::string name = final_path.string();
  std::error_code ignored;
  const fs::path folder = final_path.has_parent_path() ? final_path.parent_path() : fs::path(".");
  if (!final_path.has_filename()) {
    throw InputError(name + ": no file name; allowed: a file in an existing folder");
  }
  if (!fs::is_directory(folder, ignored)) {
    throw InputError(name + ": the folder " + folder.string() +
                     " does not exist; allowed: a file in an existing folder");
  }
  if (fs::symlink_status(final_path, ignored).type() != fs::file_type::not_found) {
    throw InputError(name + ": exists already; allowed: a new file");
  }
  if (fs::symlink_status(partial, ignored).type() != fs::file_type::not_found) {
    throw InputError(partial.string() + ": exists already, from a session that did not end or " +
                     "still runs; allowed: a new file");
  }
  if (access(folder.c_str(), W_OK | X_OK) != 0) {
    throw InputError(name + ": the folder " + folder.string() +
                     " may not be written; allowed: a folder with write permission");
  }
}

void check_texts(const fs::path& final_path, const SessionInfo& info) {
  const std::array<std::pair<const char*, const std::string*>, 8> texts{{
      {"program_version", &info.program_version},
      {"program_commit", &info.program_commit},
      {"definition", &info.definition},
      {"definition_name", &info.definition_name},
      {"subject", &info.subject},
      {"device", &info.device},
      {"clock", &info.clock},
      {"start_utc", &info.start_utc},
  }};
  for (const auto& [name, text] : texts) {
    if (text->find('\0') != std::string::npos) {
      throw InputError(final_path.string() + ": " + name + " holds a NUL byte; allowed: text");
    }
  }
}

void put_info(const h5::Id& file, const SessionInfo& info) {
  h5::put(file, "schema_version", kSchemaVersion);
  h5::put(file, "program_version", info.program_version);
  h5::put(file, "program_commit", info.program_commit);
  h5::put(file, "definition", info.definition);
  h5::put(file, "definition_name", info.definition_name);
  h5::put(file, "subject", info.subject);
  h5::put(file, "seed", info.seed);
  h5::put(file, "device", info.device);
  h5::put(file, "device_max_force", info.device_max_force);
  h5::put(file, "device_workspace_radius", info.device_workspace_radius);
  h5::put(file, "clock", info.clock);
  h5::put(file, "rate", info.rate);
  h5::put(file, "start_utc", info.start_utc);
  h5::put(file, "simulated", std::uint64_t{info.simulated ? 1u : 0u});
}

void sync(const fs::path& path, int flags) {
  const int descriptor = open(path.c_str(), flags | O_CLOEXEC);
  if (descriptor < 0) throw h5::Error(std::generic_category().message(errno));
  const int status = fsync(descriptor);
  const int code = errno;
  ::close(descriptor);
  if (status != 0) throw h5::Error(std::generic_category().message(code));
}

/// Gives back the blocks that were reserved behind the end. Best effort: they hold nothing.
void trim(const fs::path& path) noexcept {
  struct stat file {};
  if (stat(path.c_str(), &file) == 0 && truncate(path.c_str(), file.st_size) != 0) errno = 0;
}

void rename_to_new(const fs::path& from, const fs::path& to) {
  if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return;
  // A file system without the flag: look first, and take the small race.
  if (errno == EINVAL || errno == ENOSYS) {
    errno = fs::exists(to) ? EEXIST : 0;
    if (errno == 0 && rename(from.c_str(), to.c_str()) == 0) return;
  }
  throw h5::Error("cannot rename to " + to.string() + ": " +
                  std::generic_category().message(errno));
}

}  // namespace

struct SessionWriter::Impl {
  Impl(const fs::path& file_path, const SessionInfo& info)
      : final_path(file_path), partial(partial_path(file_path)), file(h5::create_file(partial)) {
    try {
      space.ensure(h5::descriptor(file), 0);
      put_info(file, info);
      for (auto [table, schema] : tables()) {
        *table = std::make_unique<TableWriter>(file, *schema, [this](std::uint64_t bytes) {
          space.ensure(h5::descriptor(file), bytes);
        });
      }
      for (const char* count : {"ticks", "overruns", "dropped"}) {
        h5::put(timing->dataset(), count, std::int64_t{-1});
      }
      h5::start_swmr(file);
      h5::flush(file);
    } catch (...) {
      divert_file();
      close_tables();
      file.reset();
      std::remove(partial.c_str());
      throw;
    }
  }

  std::array<std::pair<std::unique_ptr<TableWriter>*, const TableSchema*>, 5> tables() {
    return {{{&samples, &samples_schema()},
             {&trials, &trials_schema()},
             {&events, &events_schema()},
             {&stimuli, &stimuli_schema()},
             {&timing, &timing_schema()}}};
  }

  /// Runs one step of writing; its first failure ends all writing.
  template <typename Step>
  void guarded(Step step) {
    if (!failure.empty()) throw RunError(failure);
    if (!file) throw std::invalid_argument(final_path.string() + ": the session was closed before");
    try {
      step();
    } catch (const NoSpace& error) {
      give_up(error.what());  // met before HDF5 wrote anything: the file can still be closed
    } catch (const h5::Error& error) {
      divert_file();
      give_up(error.what());
    }
  }

  [[noreturn]] void give_up(const std::string& why) {
    failure = final_path.string() + ": the session cannot be written (" + why + ")";
    throw RunError(failure);
  }

  void write_all() {
    for (auto [table, schema] : tables()) (*table)->write_unfinished();
    h5::flush(file);
  }

  void divert_file() noexcept {
    try {
      if (file) divert(h5::descriptor(file));
    } catch (const h5::Error&) {
      // Without a descriptor there is nothing to divert.
    }
  }

  bool closable() noexcept {
    try {
      probe(h5::descriptor(file));
      return true;
    } catch (const h5::Error&) {
      return false;
    }
  }

  void close_tables() noexcept {
    for (auto [table, schema] : tables()) {
      if (*table) (*table)->close();
    }
  }

  fs::path final_path;
  fs::path partial;
  h5::Id file;
  DiskSpace space;
  std::unique_ptr<TableWriter> samples, trials, events, stimuli, timing;
  bool has_timing{false};
  bool finished{false};
  std::string failure;
};

SessionWriter::SessionWriter(const fs::path& final_path, const SessionInfo& info) {
  check_target(final_path, partial_path(final_path));
  check_texts(final_path, info);
  try {
    impl_ = std::make_unique<Impl>(final_path, info);
  } catch (const h5::Error& error) {
    throw RunError(final_path.string() + ": the session file cannot be created (" + error.what() +
                   ")");
  }
}

SessionWriter::~SessionWriter() {
  if (!impl_->file) return;
  try {
    if (impl_->failure.empty()) impl_->guarded([&] { impl_->write_all(); });
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
    while (!rows.empty()) {
      const std::size_t count = std::min(table.room(), rows.size());
      put_samples(table.planes(), table.used(), rows.first(count));
      table.added(count);
      rows = rows.subspan(count);
    }
  });
}

void SessionWriter::add_pass(const PassRow& pass) {
  impl_->guarded([&] {
    put_pass(impl_->trials->planes(), impl_->trials->used(), pass);
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

void SessionWriter::add_stimulus(std::span<const StimulusRow> rows) {
  impl_->guarded([&] {
    for (const StimulusRow& row : rows) {
      put_stimulus(impl_->stimuli->planes(), impl_->stimuli->used(), row);
      impl_->stimuli->added(1);
    }
  });
}

void SessionWriter::set_timing(std::span<const TimingRow> histogram, const TimingSummary& summary) {
  if (impl_->has_timing) throw std::invalid_argument("the timing of a session is set once");
  impl_->guarded([&] {
    for (const TimingRow& row : histogram) {
      put_timing(impl_->timing->planes(), impl_->timing->used(), row);
      impl_->timing->added(1);
    }
    impl_->space.ensure(h5::descriptor(impl_->file), 0);
    const h5::Id& dataset = impl_->timing->dataset();
    h5::put(dataset, "ticks", static_cast<std::int64_t>(summary.ticks));
    h5::put(dataset, "overruns", static_cast<std::int64_t>(summary.overruns));
    h5::put(dataset, "dropped", static_cast<std::int64_t>(summary.dropped));
    impl_->has_timing = true;
  });
}

void SessionWriter::flush() {
  impl_->guarded([&] { impl_->write_all(); });
}

void SessionWriter::close() {
  impl_->guarded([&] {
    impl_->write_all();
    probe(h5::descriptor(impl_->file));
    impl_->close_tables();
    h5::close(impl_->file);
    trim(impl_->partial);
    sync(impl_->partial, O_RDWR);
    rename_to_new(impl_->partial, impl_->final_path);
    impl_->finished = true;
    const fs::path folder = impl_->final_path.parent_path();
    sync(folder.empty() ? fs::path(".") : folder, O_RDONLY | O_DIRECTORY);
  });
}

void SessionWriter::discard() {
  if (impl_->finished) {
    throw std::invalid_argument(impl_->final_path.string() + ": the session was closed before");
  }
  impl_->divert_file();  // what HDF5 still holds need not reach the disk
  impl_->close_tables();
  impl_->file.reset();
  std::remove(impl_->partial.c_str());
}

}  // namespace haptrial::record
