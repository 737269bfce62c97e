#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/definition/schema_forward.h"
#include "protocols/definition/session_plan.h"
#include "protocols/psychophysics/definition/counterbalance.h"

namespace haptrial::protocols {

/// Value of a name during a block, a trial or an interval.
struct GivenValue {
  std::string name;
  std::string formula;  // 0.5, 'curl', $level + 1
};

/// Something that is varied within a block.
struct Factor {
  std::string name;
  std::vector<std::string> levels;  // formulas, at least two
};

/// Trials in which something else is given, unannounced: catch trials, error clamps.
struct Probe {
  std::string name{"probe"};
  double share{0.0};  // of the block's trials, above 0 and at most 1/2
  std::vector<GivenValue> values;
};

/// Trials that belong together.
struct Block {
  std::string name;
  int trials{0};          // 0: until its procedures are finished
  bool practice{false};   // not scored
  int right_in_a_row{0};  // practice ends with so many right answers in a row; 0: not before
  std::vector<GivenValue> values;
  std::optional<Probe> probe;
  std::vector<std::string> procedures{};  // names of the tracks that it asks; empty: all, unless it
                                          // gives one of their variables a value
  std::vector<std::string> needs{};       // tracks whose threshold its trials use (every_value.h)
};

/// How the combinations of factors of a block without procedures follow each other.
enum class TrialOrder : std::uint8_t {
  kCycles,    // each once before any comes again
  kShuffled,  // each equally often, in one random order
  kRandom,    // each drawn anew, so that nothing tells which one comes
};

/// The most trials with the same level of a factor that may follow each other.
struct RunLimit {
  std::string factor;  // empty: with the same levels of all
  int most{1};
};

/// Trials of a study, and their order.
struct TrialDesign {
  int participants{1};
  int sessions{1};                                   // of each participant
  int break_after{0};                                // trials; 0: no breaks
  double break_duration{60.0};                       // [s]
  bool break_until_ready{false};                     // and then until somebody goes on
  Counterbalancing order{Counterbalancing::kFixed};  // of the blocks that are not practice
  TrialOrder trial_order{TrialOrder::kCycles};
  std::vector<RunLimit> most_in_a_row;
  std::vector<Factor> factors;
  std::vector<Block> blocks;                         // at least one; practice first
  std::vector<SessionPlan> session_plans;            // of each; empty: nothing is said of them
  std::vector<std::vector<std::size_t>> by_session;  // blocks of each; empty: all in each

  /// The blocks of a session as the definition lists them. @param session  from 1
  std::vector<std::size_t> blocks_of(int session) const;
};

/// Reads [design], [factors], [practice] and [[blocks]]; only [design] must be there. Keys in
/// brackets are optional.
///
///     [design]    participants, [break_after], [break_duration], [break_until], [blocks],
///                 [most_in_a_row], [sessions], [trials]
///     [design.session.N]  blocks = ["practice", …]: those of session N, beside what every protocol
///                         has of it (session_plan.h); of all sessions or of none
///     [factors]   name = [level, level, …]: numbers, words, or formulas with $
///     [practice]  trials, [right_in_a_row], and values as of a block
///     [[blocks]]  name, [trials], [practice], [right_in_a_row], [procedures],
///                 [probe] = { name, share, … };
///                 every other key gives the name its value in this block
/// @param procedures  whether there are any: without them a block needs its number of trials
TrialDesign read_trial_design(Table& root, bool procedures);

/// The formula of a value: of a number itself, of a text that contains $ itself, else the word.
std::string formula_of_value(Table& table, const std::string& key);

/// A level as tables show it: a word without the quotation marks of its formula.
std::string shown_level(const std::string& formula);
std::vector<std::string> levels_of(const std::vector<GivenValue>& values);

/// All combinations of the factors' levels, the last factor fastest; one empty combination without
/// factors.
std::vector<std::vector<GivenValue>> crossed(const std::vector<const Factor*>& factors);

}  // namespace haptrial::protocols
