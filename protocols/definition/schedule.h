#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/definition/schema_forward.h"

namespace haptrial::protocols {

/// The plan of a study. Source: Morris 2006, §4.2.5.
struct Design {
  int participants{12};
  int sessions{1};               // of each participant
  int trials{72};                // per participant; a trial is a training pass and a test pass
  int repetitions{3};            // trials of a block: same stimulus, same condition
  int break_after{36};           // trials; 0 for no break
  double break_duration{600.0};  // [s]
  int practice{0};               // trials of each condition before the first
  std::vector<std::string> conditions;  // of training
  bool break_until_ready{false};        // a break lasts break_duration, then until somebody goes on

  int blocks() const { return trials / repetitions; }
};

/// The keys of a [design] table; a design that does not divide is noted as a problem.
const Schema<Design>& design_schema();

/// Notes a number of trials that does not divide into blocks of each condition.
/// @param whose  the conditions are, " of the group trained", for a sentence
void check_trials(Table& table, int trials, int repetitions, std::size_t conditions,
                  std::string_view whose = "");

/// Reads the key `break_until` of a [design] table, "time" (as if left out) or "ready".
/// @param break_after  that the design has; 0: no breaks
bool read_break_until_ready(Table& table, int break_after);

/// One trial of a participant.
struct PlannedTrial {
  std::int32_t trial{0};       // from 1
  std::int32_t block{0};       // from 1; of practice -1, -2, ..., one for each stimulus
  std::int32_t repetition{0};  // from 1
  std::string condition;
  std::uint64_t stimulus_seed{0};  // the same within a block
  bool practice{false};            // before the study: not scored
  std::string block_name{};        // the definition's; empty: it has none
};

/// The rows of a Williams design for n >= 1 conditions: every condition at every place equally
/// often and after every other equally often. n rows where n is even, 2 n where it is odd.
/// // (rows x n), values 0 .. n - 1. Source: Williams 1949.
std::vector<std::vector<int>> williams_rows(int conditions);

/// The trials of one participant in their order, practice first. Blocks come in groups that hold
/// each condition once; the order within group g is a Williams row, and over as many consecutive
/// participants as there are rows each row is used once in every group. Which row comes to whom is
/// drawn from the study's seed.
/// @param participant   from 0
/// @param study_seed   the same for all participants
/// @param person_seed  of this participant; stimuli derive from it, so that those of a block are
/// the
///                     same in every session
std::vector<PlannedTrial> plan_trials(const Design& design, int participant,
                                      std::uint64_t study_seed, std::uint64_t person_seed);

}  // namespace haptrial::protocols
