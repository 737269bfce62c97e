#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>

#include "core/record/drilling_types.h"
#include "core/record/session_types.h"

namespace haptrial::record {

struct Resumed;

/// Writes one session file (docs/session-file.md). It is called FILE.partial until close() gives it
/// its name, and is readable as it stands whatever kills the process; other processes may follow
/// it, and are kept from writing it.
///
/// A session on the real clock loses at most the last 0.8 s of what it appended: a chunk of
/// samples is that long, and is in the file as soon as it is full. A session on a simulated clock
/// has longer chunks and is in the file as of the last flush() or sync().
///
/// One thread at a time for each writer, never the servo thread; several writers may work in
/// several threads. Every member throws RunError, in one sentence, when the file cannot be written
/// (a full disk); from then on nothing more is written and FILE.partial keeps what came before.
class SessionWriter {
 public:
  /// Creates FILE.partial with all groups, datasets and attributes.
  /// @throws InputError when FILE or FILE.partial exists, or their folder is missing or may not be
  /// written, or another process creates the same file, or a text of `info` holds a NUL byte.
  SessionWriter(const std::filesystem::path& final_path, const SessionInfo& info);
  /// The same with the tables of drillings, in which the bones are from the beginning.
  SessionWriter(const std::filesystem::path& final_path, const SessionInfo& info,
                std::span<const BoneRecord> bones);

  /// Whether FILE.partial exists. It has that name from the moment on in which it can take samples:
  /// where this is false no sample of the session was ever recorded, and it starts anew.
  /// @throws InputError when FILE exists: the session is complete.
  static bool can_resume(const std::filesystem::path& final_path);
  /// Goes on with FILE.partial after its writer ended in whatever way. What was begun and did not
  /// reach the file whole is dropped; `found` says what is there.
  /// @throws InputError when another process writes it, when it is of an older schema version, or
  /// when it is damaged (recover_session() then saves what it holds); the file is left as it was.
  static SessionWriter resume(const std::filesystem::path& final_path, Resumed& found);

  /// Without close(): FILE.partial stays, closed and readable, with everything that came.
  ~SessionWriter();
  SessionWriter(SessionWriter&&) noexcept;
  SessionWriter& operator=(SessionWriter&&) = delete;

  /// Real values are rounded to the grids of schema.h.
  void append(std::span<const Sample> samples);
  /// After its samples. @throws std::invalid_argument for a condition above 64 bytes or with a NUL
  /// byte.
  void add_pass(const PassRow& pass);
  /// A text above 256 bytes takes several rows, which the reader joins again.
  /// @throws std::invalid_argument for a kind above 32 bytes, or a NUL byte in kind or text.
  void add_event(const EventRow& event);
  void add_stimulus(std::span<const StimulusRow> rows);
  void add_frames(std::span<const FrameRow> rows);
  /// Rows of the tables of drillings, in ascending order of their sequence numbers. Rows of /tool
  /// go with those of /samples: as many, with the same numbers, before append() is given the next
  /// ones. Reals are rounded to the grids of the schema.
  /// @tparam Row  a type of drilling_types.h
  /// @throws std::invalid_argument in a session without drillings.
  template <class Row>
  void add(std::span<const Row> rows);
  /// Once, when the loop has ended. @param summary  of this run: the ticks recorded before a
  /// resume() are added. @throws std::invalid_argument for a second call.
  void set_timing(std::span<const TimingRow> histogram, const TimingSummary& summary);

  /// Passes, events, stimuli and full chunks of samples and frames are in the file for any reader,
  /// and survive kill -9. Cheap enough for every second: no unfinished chunk of samples is cut,
  /// but where a pass was added since.
  void flush();
  /// Everything given so far is in the file and on the disk, and survives a power cut. Costs the
  /// space of half a chunk of samples: for the end of a pass.
  void sync();
  /// Whether more can be written: false after the first RunError, and after close() or discard().
  bool can_go_on() const noexcept;

  /// Flushes, closes, syncs to the disk and renames FILE.partial to FILE. Once.
  /// @throws RunError also when FILE has come to exist meanwhile.
  void close();

  /// Closes and removes FILE.partial; of a resumed session it keeps what is in the file. Nothing
  /// may follow.
  void discard();

 private:
  struct Impl;
  explicit SessionWriter(std::unique_ptr<Impl> impl);
  SessionWriter(std::optional<std::span<const BoneRecord>> bones,
                const std::filesystem::path& final_path, const SessionInfo& info);
  std::unique_ptr<Impl> impl_;
};

}  // namespace haptrial::record
