#pragma once

#include <array>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/record/disk_space.h"
#include "core/record/disk_sync.h"
#include "core/record/file_lock.h"
#include "core/record/hdf5_layer.h"
#include "core/record/run_types.h"
#include "core/record/session_writer.h"
#include "core/record/table_writer.h"

/// What session_writer.cpp and session_resume.cpp share; for those only.
namespace haptrial::record {

struct SessionWriter::Impl {
  /// Creates the file. @throws h5::Error, InputError, RunError; then nothing is left of it.
  Impl(const std::filesystem::path& file_path, const SessionInfo& info,
       std::optional<std::span<const BoneRecord>> bones);
  /// Goes on with the file, which is locked. @param drilled  it has the tables of drillings
  Impl(const std::filesystem::path& file_path, const SessionInfo& info, FileLock held,
       bool drilled);

  using Tables = std::vector<std::pair<std::optional<TableWriter>*, const TableSchema*>>;
  Tables tables();
  TableWriter& table(DrillingTable which);
  template <class Row>
  void put(std::span<const Row> rows);

  /// Runs one step of writing; its first failure ends all writing.
  template <typename Step>
  void guarded(Step step) {
    check_open();
    try {
      step();
    } catch (const NoSpace& error) {
      give_up(error.what());  // met before HDF5 wrote anything: the file can still be closed
    } catch (const h5::Error& error) {
      divert_file();
      give_up(error.what());
    }
  }
  void check_open() const;
  [[noreturn]] void give_up(const std::string& why);

  /// Chunks of samples that are not full stay out, unless `all` or a pass refers to them.
  void write(bool all);
  void write_samples();
  void write_drilling();
  TableWriter::EnsureSpace ensure_space();
  void divert_file() noexcept;
  bool closable() noexcept;
  void close_tables() noexcept;
  void go_on();  // opens the file and its tables
  void start_syncing();

  /// What the thread that syncs found. @throws h5::Error when the disk refused
  void heed_disk();
  /// Where the file was deleted, moved or replaced, it is put back, or saved under another name.
  /// @throws RunError that names the other name
  void put_back();
  void copy_back();
  void take_up(const Resumed& found);
  void add_run(RunState state);
  void put_counts();  // of the whole session, as attributes

  std::filesystem::path final_path;
  std::filesystem::path partial;
  bool live;  // on the real clock
  FileLock lock;
  h5::Id file;
  DiskSpace space;
  std::optional<TableWriter> samples, frames, trials, events, stimuli, timing, attributes;
  std::optional<TableWriter> runs, begun;
  bool drills{false};
  std::array<std::optional<TableWriter>, kDrillingTables> drilling;
  TimingSummary earlier;          // what the runs before a resume counted
  RunRow run;                     // this one
  std::optional<RunRow> run_row;  // the last in the file or on its way there
  bool resumed{false};
  bool has_timing{false};
  bool finished{false};
  bool folder_synced{false};
  std::string failure;
  std::vector<std::string> notices;
  std::unique_ptr<DiskSync> syncing;  // live; ends before the descriptor that it uses
};

}  // namespace haptrial::record
