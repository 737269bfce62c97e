#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/deformable/touch/body_touch.h"
#include "core/record/table/table_description.h"
#include "protocols/interface/session_file.h"
#include "protocols/psychophysics/objects/trial_object.h"
#include "protocols/psychophysics/presentation/trial_pass.h"

namespace haptrial::protocols {

/// How bodies that give way were touched in a session: rows of /touched_bodies, /moving_bodies and
/// /late_windows, and what was not felt as it should be as events and notices. The session's
/// thread.
class BodyReport {
 public:
  /// @param objects  of the definition; must outlive this
  explicit BodyReport(const std::vector<TrialObject>& objects) : objects_(objects) {}

  /// Adds the tables that the objects need.
  void add_tables(record::TableList& tables) const;
  /// Keeps the rows of a pass that has ended, all of its intervals together. @param row  of /trials
  void keep(const TrialPass& pass, std::int32_t row, SessionFile& file);
  /// Notices about all passes so far, a line for each kind of loss.
  std::vector<std::string> notices() const;

  static constexpr std::size_t kLosses = 5;

 private:
  struct TouchedObject {
    std::size_t device{}, object{};
    deformable::TouchCounts counts;
    int steps{};  // on a tick; 0: it does not move
  };
  /// Ticks of the session, and how often a body had some in a pass.
  struct Sum {
    std::uint64_t ticks{0};
    std::uint64_t bodies{0};
  };

  const deformable::BodyTouch* touch_of(const TrialPass& pass, std::size_t interval,
                                        std::size_t device, std::size_t object) const;
  TouchedObject touched(const TrialPass& pass, std::size_t device, std::size_t object) const;
  void add_late(const TrialPass& pass, const TouchedObject& body, std::int32_t row,
                SessionFile& file) const;
  void add_rows(const std::vector<TouchedObject>& all, std::int32_t row, SessionFile& file) const;

  const std::vector<TrialObject>& objects_;
  std::array<Sum, kLosses> sums_{};
};

}  // namespace haptrial::protocols
