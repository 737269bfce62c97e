#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "core/realtime/block_log.h"
#include "core/record/rows/common_tables.h"
#include "protocols/interface/session_file.h"

namespace haptrial::protocols {

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
    for (const Kept& log : logs_) {
      tables.push_back(log.table);
    }
    return tables;
  }
  /// Writes what the logs hold, in the order in which they were named.
  void empty(SessionFile& file) const {
    for (const Kept& log : logs_) {
      log.empty(file);
    }
  }
  /// Entries lost for want of room, of all logs. Any thread.
  std::uint64_t dropped() const {
    std::uint64_t all = 0;
    for (const Kept& log : logs_) {
      all += log.dropped();
    }
    return all;
  }

 private:
  struct Kept {
    const record::TableDescription* table;
    std::function<void(SessionFile&)> empty;
    std::function<std::uint64_t()> dropped;
  };
  std::vector<Kept> logs_;
};

}  // namespace haptrial::protocols
