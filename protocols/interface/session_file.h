#pragma once

#include <span>
#include <string>
#include <vector>

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

}  // namespace haptrial::protocols
