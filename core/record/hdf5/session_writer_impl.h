#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/record/hdf5/disk.h"
#include "core/record/hdf5/file_lock.h"
#include "core/record/hdf5/hdf5_layer.h"
#include "core/record/hdf5/read_back.h"
#include "core/record/hdf5/session_writer.h"
#include "core/record/hdf5/table_writer.h"
#include "core/record/rows/session_types.h"

/// Declarations that session_writer.cpp and session_resume.cpp share; for those only.
namespace haptrial::record {

struct SessionWriter::Impl {
  /// Creates the file. @throws h5::Error, InputError, RunError; then nothing is left of it.
  Impl(const std::filesystem::path& file_path, const SessionInfo& info,
       const TableList& protocol_tables, std::span<const Rows> first_rows);
  /// Goes on with the file, which is locked. @param protocol_tables  that it has
  Impl(const std::filesystem::path& file_path, const SessionInfo& info, FileLock held,
       const TableList& protocol_tables);

  /// A table and its writer while the file is open.
  struct Part {
    std::optional<TableWriter>* writer;
    const TableSchema* schema;
    bool each_tick;  // it has a row for each tick
    bool dense{false};
  };
  std::vector<Part> tables();
  int level_of(const Part& part) const;  // of compression
  /// @throws std::invalid_argument if the session does not have the table
  TableWriter& protocol_table(const TableDescription& table);
  void put(const Rows& rows);

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
  void write_before_trials();
  void write_own();  // but what has a row for each tick
  TableWriter::EnsureSpace ensure_space();
  void divert_file() noexcept;
  bool closable() noexcept;
  void close_tables() noexcept;
  std::vector<WrittenTable> written_tables();
  /// @throws RunError if the closed file does not hold what was written
  void read_back(std::span<const WrittenTable> written);
  void go_on();  // opens the file and its tables
  void start_syncing();

  /// Takes over the result of the thread that syncs. @throws h5::Error when the disk refused
  void heed_disk();
  /// Puts back a file that was deleted, moved or replaced, or saves it under another name.
  /// @throws RunError that names the other name
  void put_back();
  void make_folder_again();
  void save_as(const std::filesystem::path& saved);
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
  struct ProtocolTable {
    const TableDescription* table;
    std::optional<TableWriter> writer;
  };
  std::vector<ProtocolTable> own;  // tables of the protocol
  TimingSummary earlier;           // what the runs before a resume counted
  RunRow run;                      // this one
  std::optional<RunRow> run_row;   // the last in the file or on its way there
  bool resumed{false};
  bool has_timing{false};
  bool finished{false};
  bool folder_synced{false};
  std::string failure;
  std::vector<std::string> notices;
  std::unique_ptr<DiskSync> syncing;  // live; ends before the descriptor that it uses
};

}  // namespace haptrial::record
