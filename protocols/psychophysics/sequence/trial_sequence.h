#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/psychometric/procedure/procedure.h"
#include "protocols/definition/schedule.h"
#include "protocols/interface/trials.h"
#include "protocols/psychophysics/definition/trial_values.h"
#include "protocols/psychophysics/definition/trials_definition.h"
#include "protocols/psychophysics/sequence/level_chooser.h"

namespace haptrial::protocols {

/// Added to the number of a trial of practice, which is no other's.
inline constexpr int kPracticeNumbers = 1'000'000;

/// The participant and session, as far as an order depends on them.
struct SessionIdentity {
  int participant{0};  // from 0
  std::string group;
  std::uint64_t study_seed{0};
  std::uint64_t session_seed{0};
  int session{1};  // from 1
};

/// Identity of a session of a definition. @param place  with its seeds
SessionIdentity identity_of(const TrialsDefinition& definition, const SessionPlace& place);

/// One track in one combination of its factors.
struct RunningTrack {
  const Track* track{nullptr};
  std::string name;                // with its combination
  std::vector<GivenValue> values;  // of its factors
  std::unique_ptr<psychometric::Procedure> procedure;
  int trials{0};  // begun
};

/// What a track of an earlier block found in one combination of its factors.
struct FoundThreshold {
  std::string track;
  std::vector<GivenValue> values;  // of its factors
  double level{0.0};
};

/// A trial that is to come.
struct NextTrial {
  PlannedTrial plan;
  TrialValues values;
  int track{-1};  // of running(); -1: no procedure is asked
  psychometric::Level asked;
  psychometric::Level applied;
};

/// Which trial follows from the outcomes so far: blocks in their order, procedures interleaved,
/// factors in cycles, probes. A function of definition, taker and outcomes and of nothing else.
/// Session's thread.
class TrialSequence {
 public:
  /// @param definition  outlives the sequence
  TrialSequence(const TrialsDefinition& definition, const SessionIdentity& taker);

  /// The next trial; nothing at the end. The same until conclude() is called.
  std::optional<NextTrial> next();
  /// @param presented  whether the trial was completed; else its level is asked for again
  /// @param outcome    for the procedure of its track; NaN: it learns nothing
  /// @param right      whether the first answer was right, for practice
  /// @throws std::logic_error without a next() before
  void conclude(bool presented, double outcome, bool right);

  /// Postpones the trial, in place of conclude(): its presentation does not count and comes again
  /// at the end of its block; a procedure that follows the answers asks for the same level in its
  /// next trial.
  /// @throws std::logic_error without a next() before
  void postpone();

  /// Sets the chooser of levels from the next trial on. @param chooser  outlives the sequence
  void choose_by(LevelChooser& chooser) { chooser_ = &chooser; }

  const std::vector<RunningTrack>& running() const { return running_; }
  /// A sentence for each block that ended with trials left, since too many were never completed,
  /// or that was left out, since an earlier one did not find the threshold that it needs.
  const std::vector<std::string>& ended_early() const { return ended_early_; }
  /// The block that a trial belongs to, in the order of this participant.
  const std::vector<std::size_t>& blocks() const { return blocks_; }

 private:
  struct Fixed {  // a trial of a block without procedures
    std::vector<GivenValue> values;
    std::string probe;
  };
  const Block& block() const { return d_.order.blocks[blocks_[at_]]; }
  void begin_block();
  void end_block();
  std::string missing_threshold() const;
  void give_thresholds(TrialValues& values) const;
  std::vector<int> order_under_rules(const std::vector<std::vector<GivenValue>>& combinations,
                                     const std::vector<int>& which) const;
  bool breaks_rule(const std::vector<GivenValue>& values) const;
  bool fails_for_ever() const;
  bool block_is_over() const;
  NextTrial make_next();
  void add_factors(NextTrial& next, const std::vector<std::string>& settled, std::size_t stream,
                   int count) const;
  void choose_track(NextTrial& next);
  std::size_t pick(const std::vector<std::size_t>& open) const;
  void make_fixed();
  bool probe_comes(const Block& block) const;

  const TrialsDefinition& d_;
  SessionIdentity taker_;
  LevelChooser* chooser_{nullptr};   // null: the procedures
  std::vector<std::size_t> blocks_;  // of the definition, in this participant's order
  std::size_t at_{0};                // of blocks_
  std::vector<RunningTrack> running_;
  std::vector<Fixed> fixed_;
  std::size_t fixed_at_{0};
  std::optional<NextTrial> next_;
  int begun_{0};     // trials of the session, all of them
  int in_block_{0};  // trials of the block
  int failed_{0};    // of them not completed
  int right_in_a_row_{0};
  int numbers_[2]{0, 0};  // trials so far: of the study, of practice
  int practice_blocks_{0}, study_blocks_{0};
  bool probe_before_{false};
  std::vector<std::string> ended_early_;
  std::vector<FoundThreshold> found_;
  std::vector<std::vector<GivenValue>> combinations_;  // of the block's trials, for most_in_a_row
};

}  // namespace haptrial::protocols
