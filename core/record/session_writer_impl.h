#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/record/disk_space.h"
#include "core/record/file_lock.h"
#include "core/record/hdf5_layer.h"
#include "core/record/session_writer.h"
#include "core/record/table_writer.h"

/// What session_writer.cpp and session_resume.cpp share; for those only.
namespace haptrial::record {

/// Rows of each table of a file to go on with.
struct KeptRows {
  std::uint64_t samples{0}, frames{0}, trials{0}, events{0}, stimuli{0}, timing{0}, attributes{0};
  bool drills{false};  // the tables of drillings are there
  std::array<std::uint64_t, kDrillingTables> drilling{};
};

struct SessionWriter::Impl {
  /// Creates the file. @throws h5::Error, InputError, RunError; then nothing is left of it.
  Impl(const std::filesystem::path& file_path, const SessionInfo& info,
       std::optional<std::span<const BoneRecord>> bones);
  /// Goes on with the file, which is locked.
  Impl(const std::filesystem::path& file_path, const SessionInfo& info, FileLock held,
       const KeptRows& rows);

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

  std::filesystem::path final_path;
  std::filesystem::path partial;
  bool live;  // on the real clock
  FileLock lock;
  h5::Id file;
  DiskSpace space;
  std::optional<TableWriter> samples, frames, trials, events, stimuli, timing, attributes;
  bool drills{false};
  std::array<std::optional<TableWriter>, kDrillingTables> drilling;
  std::uint64_t earlier_ticks{0};  // before a resume
  bool resumed{false};
  bool has_timing{false};
  bool finished{false};
  bool folder_synced{false};
  std::string failure;
};

}  // namespace haptrial::record
