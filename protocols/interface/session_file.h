#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/realtime/block_log.h"
#include "core/record/rows/common_tables.h"
#include "core/record/rows/rows.h"
#include "core/record/rows/session_types.h"
#include "protocols/definition/schedule.h"

namespace haptrial::protocols {

/// Access of a protocol to the file of its session. Session's thread; functions that write throw
/// RunError if the file cannot be written.
class SessionFile {
 public:
  virtual ~SessionFile() = default;

  /// Rows of a table of the protocol's, in ascending order of their sequence numbers.
  template <class Row>
  void add(std::span<const Row> rows) {
    put(record::Rows(rows));
  }
  /// The ideal curves of a block; once a block, also over several runs.
  virtual void keep_stimulus(std::int32_t block, std::span<const record::StimulusRow> rows) = 0;
  virtual bool holds_stimulus(std::int32_t block) const = 0;
  virtual void event(const std::string& kind, const std::string& text) = 0;

  /// Passes of earlier runs of the session.
  virtual const std::vector<record::PassRow>& earlier_passes() const = 0;
  /// Whether an earlier run ended during the trial without time to write what it held.
  virtual bool was_cut_short(const PlannedTrial& trial) const = 0;

 protected:
  virtual void put(const record::Rows& batch) = 0;
};

/// The logs of the servo thread that a session has: each is named once, and has a table, is emptied
/// and counts what it dropped from there on. Session's thread.
class KeptLogs {
 public:
  template <class Entry>
  using Write = std::function<void(SessionFile&, std::span<const Entry>)>;

  /// The log's rows are those of their table. @param log  outlives this
  template <class Row>
  void keep(realtime::BlockLog<Row>& log) {
    keep<Row>(log, record::table_of<Row>(),
              [](SessionFile& file, std::span<const Row> rows) { file.add(rows); });
  }
  /// Somebody else writes what comes of the entries. @param log  outlives this
  template <class Entry>
  void keep(realtime::BlockLog<Entry>& log, const record::TableDescription& table,
            Write<Entry> write) {
    logs_.push_back({&table,
                     [&log, write = std::move(write)](SessionFile& file) {
                       log.flush([&](std::span<const Entry> entries) { write(file, entries); });
                     },
                     [&log] { return log.dropped(); }});
  }

  record::TableList tables() const {
    record::TableList tables;
    for (const KeptLog& log : logs_) {
      tables.push_back(log.table);
    }
    return tables;
  }
  /// Writes what the logs hold, in the order in which they were named.
  void empty(SessionFile& file) const {
    for (const KeptLog& log : logs_) {
      log.empty(file);
    }
  }
  /// Entries lost for want of room, of all logs. Any thread.
  std::uint64_t dropped() const {
    std::uint64_t all = 0;
    for (const KeptLog& log : logs_) {
      all += log.dropped();
    }
    return all;
  }

 private:
  struct KeptLog {
    const record::TableDescription* table;
    std::function<void(SessionFile&)> empty;
    std::function<std::uint64_t()> dropped;
  };
  std::vector<KeptLog> logs_;
};

}  // namespace haptrial::protocols
