#pragma once

#include <filesystem>
#include <memory>
#include <span>

#include "core/record/session_types.h"

namespace haptrial::record {

/// Writes one session file (docs/session-file.md). It is called FILE.partial until close() gives it
/// its name, and is readable as it stands at the last flush() whatever kills the process.
///
/// One thread at a time for each writer, never the servo thread; several writers may work in
/// several threads. Every member throws RunError, in one sentence, when the file cannot be written
/// (a full disk); from then on nothing more is written and FILE.partial keeps what came before.
class SessionWriter {
 public:
  /// Creates FILE.partial with all groups, datasets and attributes.
  /// @throws InputError when FILE or FILE.partial exists, or their folder is missing or may not be
  /// written, or a text of `info` holds a NUL byte.
  SessionWriter(const std::filesystem::path& final_path, const SessionInfo& info);

  /// Without close(): FILE.partial stays, closed and readable, with everything that came.
  ~SessionWriter();
  SessionWriter(const SessionWriter&) = delete;
  SessionWriter& operator=(const SessionWriter&) = delete;

  /// Real values are rounded to the grids of schema.h.
  void append(std::span<const Sample> samples);
  /// @throws std::invalid_argument for a condition above 64 bytes or with a NUL byte.
  void add_pass(const PassRow& pass);
  /// A text above 256 bytes takes several rows, which the reader joins again.
  /// @throws std::invalid_argument for a kind above 32 bytes, or a NUL byte in kind or text.
  void add_event(const EventRow& event);
  void add_stimulus(std::span<const StimulusRow> rows);
  /// Once, when the loop has ended. @throws std::invalid_argument for a second call.
  void set_timing(std::span<const TimingRow> histogram, const TimingSummary& summary);

  /// Everything given so far is in the file for any reader, and survives kill -9. Costs the space
  /// of one chunk of /samples when it cuts one: meant for the end of a pass, not for every tick.
  void flush();

  /// Flushes, closes, syncs to the disk and renames FILE.partial to FILE. Once.
  /// @throws RunError also when FILE has come to exist meanwhile.
  void close();

  /// Closes and removes FILE.partial. Nothing may follow.
  void discard();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace haptrial::record
