#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/record/rows/answer_rows.h"
#include "core/record/rows/common_tables.h"
#include "core/record/rows/rows.h"
#include "core/record/rows/session_types.h"
#include "core/record/table/table.h"

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
/// A live session's file is brought to the disk by a thread of its own, every half second and
/// whenever a chunk or a pass has come to its end; the same thread sees when the file is deleted,
/// moved or replaced, and the next flush() then puts it back.
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
  /// The same with tables of the protocol. @param first_rows  are in the file as soon as it has the
  /// name FILE.partial
  SessionWriter(const std::filesystem::path& final_path, const SessionInfo& info,
                const TableList& tables, std::span<const Rows> first_rows = {});

  /// Whether FILE.partial exists. It has that name from the moment on in which it can take samples:
  /// where this is false no sample of the session was ever recorded, and it starts anew.
  /// @throws InputError when FILE exists: the session is complete.
  static bool can_resume(const std::filesystem::path& final_path);
  /// Goes on with FILE.partial after its writer ended in whatever way; `found` says what is there.
  /// Where the file is not whole, or is of an older schema version, every row that it still holds
  /// is written to a new FILE.partial first, and the old one kept as FILE.partial.damaged
  /// (core/record/recovery/repair.h).
  /// @throws InputError when another process writes it, or when it does not say what the session
  /// was; the file is left as it was.
  /// @param tables  beside those of every session, some of which the file may have
  /// @param needed  of them, what the session goes on to write: a file that is written anew has
  /// them
  static SessionWriter resume(const std::filesystem::path& final_path, Resumed& found,
                              const TableList& tables = common_tables(),
                              const TableList& needed = {});

  /// A writer that goes without close() leaves FILE.partial, closed and readable, with everything
  /// that came.
  ~SessionWriter();
  SessionWriter(SessionWriter&&) noexcept;
  SessionWriter& operator=(SessionWriter&&) = delete;

  /// Real values are rounded to the grids of schema.h.
  void append(std::span<const Sample> samples);
  /// Adds a pass; call after its samples. @throws std::invalid_argument for a condition above 64
  /// bytes or with a NUL byte.
  void add_pass(const PassRow& pass);
  /// A text above 256 bytes takes several rows, which the reader joins again.
  /// @throws std::invalid_argument for a kind above 32 bytes, or a NUL byte in kind or text.
  void add_event(const EventRow& event);
  /// Notes a pass that begins: facts that a kill in mid-pass would lose. On the real clock it is in
  /// the file when this returns. @throws std::invalid_argument as add_pass() does
  void begin_pass(const BegunRow& pass);
  void add_stimulus(std::span<const StimulusRow> rows);
  void add_frames(std::span<const FrameRow> rows);
  /// Rows of a table of the protocol; of RowsOf::kTick in ascending order of their ticks. A table
  /// of RowsOf::kEachTick goes with /samples: as many rows, with the same sequence numbers, before
  /// append() is given the next ones. Reals are rounded to the grids of the table.
  /// @throws std::invalid_argument in a session without the table, and as TableDescription::put()
  void add(const Rows& rows);
  template <class Row>
  void add(std::span<const Row> rows) {
    add(Rows(rows));
  }
  /// The same, and on the real clock the rows are in the file when this returns: they survive
  /// kill -9, and reach the disk soon after. On a simulated clock they come with the next flush(),
  /// as their passes do.
  void add_at_once(const Rows& rows);
  /// Rows that are packed in the present layout of the table, one after the other.
  void add_packed(const TableDescription& table, std::span<const std::uint8_t> rows);
  /// An answer, at once. The tables of the session include responses_table().
  void add_response(const ResponseRow& row) { add_at_once(Rows(std::span(&row, 1))); }
  /// Trials of the study that this run has planned, earlier runs' included.
  void set_planned(std::int32_t trials);
  /// Notes the loop's counts so far in this run: a row of /runs if something new is to be told.
  void note_counts(const TimingSummary& so_far);
  /// Writes the timing; call once, when the loop has ended. @param summary  of this run: what was
  /// counted before a resume() is added in the counts of the session.
  /// @param state  kStopped: the session goes on in another run, and FILE.partial is left
  /// @throws std::invalid_argument for a second call.
  void set_timing(std::span<const TimingRow> histogram, const TimingSummary& summary,
                  RunState state = RunState::kEnded);
  /// Rows of earlier runs, for a file that is written anew.
  void keep_runs(std::span<const RunRow> rows);
  void keep_timing(std::span<const TimingRow> rows);

  /// Passes, events, stimuli and full chunks of samples and frames are in the file for any reader,
  /// and survive kill -9. Cheap enough for every second: no unfinished chunk of samples is cut,
  /// but where a pass was added since.
  void flush();
  /// Everything given so far is in the file and on the disk, and survives a power cut. Waits for
  /// the disk. Costs the space of half a chunk of samples.
  void sync();
  /// The same without waiting: everything is in the file when this returns, and on the disk soon
  /// after. On a simulated clock it is flush(). For the end of a pass.
  void sync_soon();
  /// Sentences about what befell the file since the last call.
  std::vector<std::string> take_notices();
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
  std::unique_ptr<Impl> impl_;
};

}  // namespace haptrial::record
