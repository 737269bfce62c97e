#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace haptrial::protocols {

struct StudiedDefinition;

/// Trials of one kind in a session, over the participants of a study.
struct PlannedCount {
  int session{1};     // of the participant, from 1
  std::string group;  // empty: the study has none
  std::string block;
  std::string condition;  // factors, or the track of a procedure
  std::string probe;      // empty: none
  bool practice{false};
  bool open{false};        // a procedure decides: the counts are the most that it asks for
  int participants{0};     // that have such trials
  int fewest{0}, most{0};  // trials of one participant; 0: some have none
  int all{0};              // of all participants
};

/// Participants that meet blocks, or the intervals of trials, in the same order.
struct PlannedOrder {
  std::string order;  // "A, B"
  int count{0};
};

/// Distribution of the trials of a study over its sessions and participants, by the sequence that
/// sessions follow.
struct PlannedTrials {
  std::vector<PlannedCount> counts;           // in the order in which they come first
  std::vector<PlannedOrder> block_orders;     // participants and sessions with each
  std::vector<PlannedOrder> interval_orders;  // trials with each; none of trials with one interval
  std::vector<PlannedOrder> groups;           // participants of each; none without groups
  int participants{0};                        // that were looked at
};

/// @param seed  of the study  @param most  participants that are looked at; the others are not
/// counted
PlannedTrials planned_trials(const StudiedDefinition& definition, std::uint64_t seed, int most);

}  // namespace haptrial::protocols
