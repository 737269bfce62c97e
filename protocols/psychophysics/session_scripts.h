#pragma once

#include <memory>
#include <string>
#include <vector>

#include "protocols/interface/trials.h"
#include "protocols/psychophysics/sequence/scripted_decisions.h"
#include "protocols/psychophysics/sequence/scripted_levels.h"
#include "protocols/psychophysics/sequence/trial_sequence.h"
#include "protocols/psychophysics/studied_definition.h"

namespace haptrial::protocols {

/// The programs of a lab that take part in a session: one chooses levels, one answers for virtual
/// participants. Their texts, and what they failed to do, go into the session's file. Session's
/// thread.
class SessionScripts {
 public:
  /// @param definition, place  outlive it
  /// @throws InputError where an earlier run of the session had another script
  SessionScripts(const StudiedDefinition& definition, const SessionPlace& place);

  /// Lets the script of levels, if there is one, choose those of the trials.
  void direct(TrialSequence& sequence);
  /// Null where virtual participants decide for themselves. Its process starts with the first
  /// decision.
  ScriptedDecisions* decisions() const { return decisions_.get(); }
  /// Whether what a trial was given depends on a program, which cannot take it back.
  bool any() const { return levels_ != nullptr || decisions_ != nullptr; }

  /// Writes the texts once a session, and what went wrong since the last call.
  /// @param simulated  a virtual participant answers
  void write(SessionFile& file, bool simulated);
  /// The first trouble, once; later ones are events, and counted by notices().
  std::vector<std::string> take_warnings();
  std::vector<std::string> notices() const;

 private:
  void start_levels(const ScriptPlan& plan);
  void start_decisions(const ScriptPlan& plan);
  std::function<void()> pulse(const char* text) const;

  const StudiedDefinition& d_;
  const SessionPlace& place_;
  std::unique_ptr<ScriptedLevels> levels_;  // null: the procedures choose
  bool levels_kept_{false};                 // its text is in the file
  std::string warning_;                     // not yet passed on; empty: none
  std::unique_ptr<ScriptedDecisions> decisions_;
  bool decisions_kept_{false};
};

}  // namespace haptrial::protocols
