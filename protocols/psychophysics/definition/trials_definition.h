#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/psychometric/definition/track.h"
#include "core/sound/cue.h"
#include "protocols/definition/definition.h"
#include "protocols/psychophysics/definition/block.h"
#include "protocols/psychophysics/definition/measure.h"
#include "protocols/psychophysics/definition/question.h"
#include "protocols/psychophysics/definition/script_plan.h"
#include "protocols/psychophysics/definition/trial_devices.h"
#include "protocols/psychophysics/objects/look.h"
#include "protocols/psychophysics/objects/trial_object.h"

namespace haptrial::protocols {

using psychometric::Track;

inline constexpr const char* kTrials = "trials";  // its name in [experiment]

/// One presentation within a trial, and what it gives the names.
struct Interval {
  std::string name;
  std::vector<GivenValue> values;
};

/// How trials look.
struct TrialsView {
  bool from_above{true};      // x to the right and z down the screen; else x to the right and y up
  double width{0.16};         // of the part of W that fills the screen's width [m]
  double hand_radius{0.003};  // [m]
  bool stereo{false};         // the pictures of the left and of the right eye, side by side
  TwoEyes eyes;               // of them
};

/// An experiment that a definition file states whole: what can be felt, what a trial is made of,
/// what is asked, and what follows from the answers (docs/guide-own-experiment.md).
struct TrialsDefinition : Definition {
  TrialDesign order;
  std::vector<Interval> intervals;  // at least one
  bool random_intervals{false};     // their order, within each trial
  std::vector<TrialQuestion> questions;
  std::vector<Measure> measures;  // as the first trial has them
  KeyBits keys;
  std::vector<Track> tracks;
  std::optional<ScriptPlan> script;          // may choose the levels of the tracks
  std::vector<std::string> stages;           // names, in their order
  std::vector<int> stage_markers;            // the code of each; 0: the one of its place
  std::vector<std::uint32_t> stage_buttons;  // that each waits for, a bit each
  std::vector<TrialDevice> hands;  // in the order of the session's devices; empty: one, unnamed
  std::vector<TrialObject> objects;
  TrialsView view;
  std::string feedback_right, feedback_wrong;
  double feedback_time{0.5};  // [s]
  sound::CueSet cues;
  int sound_right{-1}, sound_wrong{-1};  // of the cues, with the feedback; -1: none
  double stage_time{0.0};                // of one interval at most, roughly [s]
  // Known once every value was checked (check_every_value).
  std::vector<std::string> felt;  // what bodies cost and which hands fields need, a line each
  std::vector<std::string>
      underdamped;      // sentences on fields that the hand of [hand] does not carry
  int most_repeats{5};  // of an interval whose stage asks for it; then the trial is aborted

  PedalUse pedal_use() const override;
  std::vector<ButtonUse> button_uses() const override;
  std::vector<DeviceArm> arms() const override { return arms_of(hands, envelope); }
  bool has_target() const override { return false; }
  bool hears_pointer() const override;
  std::vector<std::string> description() const override;
  std::vector<std::string> block_names() const override;
  void check_new_session(Table& root) const override;
  std::vector<std::string> warnings() const override;
  double longest(int trials) const override;
  /// Intervals if there are several, stages, and the answers to all questions in their order.
  std::vector<markers::MarkerMeaning> marker_meanings() const override;
  const sound::CueSet* sounds() const override { return cues.empty() ? nullptr : &cues; }
  /// Combinations of levels in the order in which [factors] is written; sessions record them in the
  /// alphabetical order of the factors.
  std::map<std::string, std::string> shown_conditions() const override;
  std::uint32_t functions_of(const std::vector<int>& held) const override {
    return keys.bits_of(held);
  }
  int sessions() const override { return order.sessions; }
  /// Ticks from a command to the force of a virtual device. @param arm  of arms(): a part has the
  /// delay of its tip
  int force_delay(std::size_t arm) const;
  /// Trials of a session at most, without practice; and those of practice.
  /// @param session  from 1; 0: the longest
  int most_trials(int session = 0) const;
  int practice_trials(int session = 0) const;
  /// The factors that vary in a block: those that it gives no value of its own.
  std::vector<const Factor*> varied_in(const Block& block) const;
  /// The tracks that choose its levels: those that it names, or else all, unless it gives one of
  /// their variables a value of its own.
  std::vector<const Track*> tracks_in(const Block& block) const;
  /// The factors among them that a track goes by.
  std::vector<const Factor*> varied_by(const Track& track, const Block& block) const;
  /// How many combinations of its factors a track has in a block.
  int combinations(const Track& track, const Block& block) const;
};

/// A sentence on what a first stage presents while the force of a pass grows (envelope.ramp_in).
/// @param what  "fields.pull is ..."  @param ramp  [s]
std::string ramped_in(const std::string& what, double ramp);

}  // namespace haptrial::protocols
