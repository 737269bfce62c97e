#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "core/base/definition/schema_forward.h"
#include "core/record/read/session_reader.h"

namespace haptrial::record {

/// The rule of a definition for trials that the experimenter marks as bad, stated beforehand: keys
/// of [analysis], in every protocol.
struct MarkRule {
  bool exclude{false};
  std::vector<std::string> words;  // only marks whose reason has one of them; empty: all

  /// Whether a trial with this reason is left out. Upper and lower case are alike.
  bool leaves_out(const std::string& reason) const;
};

/// The keys of [analysis] about marked trials.
const Schema<MarkRule>& mark_rule_schema();

/// A mark on a trial of the study, or on practice.
struct MarkedTrial {
  int trial{0};  // from 1
  bool practice{false};
  std::string reason;
  std::int64_t time_ns{0};      // of the session
  bool presented_again{false};  // the marked attempt was given up: a later one is analysed
  bool left_out{false};         // of the analysis, by the rule of the session's definition
};

/// The marks of a session in the order of their times.
/// @throws InputError if the file is damaged
std::vector<MarkedTrial> marked_trials(const SessionReader& reader);

/// The trials of the study that the session's definition leaves out of the analysis.
std::set<int> trials_left_out(const SessionReader& reader);

}  // namespace haptrial::record
