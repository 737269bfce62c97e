#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/record/rows/answer_rows.h"
#include "core/record/rows/trial_rows.h"
#include "protocols/psychophysics/definition/names.h"
#include "protocols/psychophysics/sequence/trial_sequence.h"
#include "protocols/psychophysics/studied_definition.h"

namespace haptrial::protocols {

/// A trial that a virtual participant answered without a hand.
struct AnsweredTrial {
  PlannedTrial plan;
  std::string probe;                           // empty: none
  std::vector<record::LevelRow> levels;        // none: no procedure was asked
  std::vector<record::ResponseRow> answers;    // question, value, text and correct
  std::vector<record::VariableRow> variables;  // those that were asked for
};

/// Sessions at the level of responses: the trials, orders, levels and questions of the sessions of
/// a definition, and the senses, decisions and random numbers of their virtual participants, but no
/// servo loop. In place of what the hand meets stands a formula. A participant draws the same noise
/// as in a full session with the same seed.
class ResponseSession {
 public:
  /// @param definition  outlives it
  /// @param met     formula of what an interval presents to the sense, in the quantity's unit
  /// @param wanted  variables that are kept of each trial
  /// @throws InputError for a definition whose participants need a hand
  ResponseSession(const StudiedDefinition& definition, std::string met,
                  std::vector<std::string> wanted);

  /// @throws InputError saying what is wrong with the formula, such as an unknown name
  void check_met() const;

  /// The trials of one session in their order. Any thread. @param place  with its seeds
  /// @throws InputError where a formula has no finite value
  std::vector<AnsweredTrial> answered(const SessionPlace& place) const;

 private:
  class SimulatedSession;

  const StudiedDefinition& d_;
  std::string met_;
  std::vector<std::string> wanted_;
  std::unique_ptr<NamesPool> names_;  // as they are before a trial
  double press_{3.0};                 // with which a spring is pressed [N]
};

}  // namespace haptrial::protocols
