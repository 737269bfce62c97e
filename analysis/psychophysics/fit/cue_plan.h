#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/definition/schema_forward.h"

namespace haptrial::analysis::trials {

/// Levels, as words, that tell some conditions from others, each by its factor.
using FactorLevels = std::map<std::string, std::string>;

/// Names that the comparison of cues may use. Empty lists: the definition could not be read, and
/// nothing is checked.
struct CueNames {
  std::map<std::string, std::vector<std::string>> levels;  // of factors whose levels are stated
  std::vector<std::string> intervals;
  std::vector<std::string> variables;
};

/// Two cues to one property: which conditions show one of them, which both, and how far they
/// disagree.
struct CuePlan {
  FactorLevels first, second;  // conditions with one cue alone
  FactorLevels both;
  std::string at;        // factor that changes how reliable the first cue is; empty: none
  std::string conflict;  // factor by which the cues of the standard disagree
  std::string standard;  // interval whose cues disagree
  std::string first_shows, second_shows;  // variables of that interval: what each cue shows
};

/// Reads [analysis.cue_combination] of the table [analysis], if it is there. Problems are noted.
/// @param by     factors whose levels are told apart; each must be named by one of the keys
/// @param guess  guess rate of the functions; above 0 they have no level of equality
std::optional<CuePlan> read_cue_plan(Table& analysis, const CueNames& names,
                                     const std::vector<std::string>& by, double guess);

/// Name of a cue in tables: the levels of its conditions, "eye".
std::string name_of_cue(const FactorLevels& levels);

}  // namespace haptrial::analysis::trials
