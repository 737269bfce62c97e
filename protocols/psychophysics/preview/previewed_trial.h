#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "protocols/interface/trials.h"
#include "protocols/psychophysics/definition/presented.h"
#include "protocols/psychophysics/presentation/trial_pass.h"
#include "protocols/psychophysics/preview/stage_words.h"
#include "protocols/psychophysics/sequence/trial_sequence.h"
#include "protocols/psychophysics/studied_definition.h"

namespace haptrial::protocols {

/// A name and its value in words.
using ShownValue = std::pair<std::string, std::string>;

/// One interval of a trial with the values that it gives the names.
struct PreviewedInterval {
  std::string name;
  std::vector<ShownValue> values;  // those that differ from the trial's
  Presented presented;
  std::vector<PreviewedStage> stages;
  std::vector<StageSight> sights;                  // (stages)
  Eigen::Vector3d start{Eigen::Vector3d::Zero()};  // of the first device's tip, in W [m]
};

/// A question after the intervals.
struct PreviewedQuestion {
  const TrialQuestion* question{nullptr};  // outlives the preview
  int right{-1};                           // choice from 0; -1: none is known to be right
  bool feedback{false};                    // the participant is told whether it was right
  StageSight sight{};                      // the places that can be touched
};

/// A trial of a session before anybody runs it: what a session with the same seed presents, as far
/// as it does not depend on answers. Procedures have learned nothing: their levels are those before
/// the first answer.
struct PreviewedTrial {
  int number{1};  // in the session, practice included, from 1
  int most{1};    // trials of the session at most, practice included
  NextTrial next;
  std::string track;               // of a procedure; empty: none is asked
  std::vector<ShownValue> values;  // of every name that has one throughout the trial
  std::vector<PreviewedInterval> intervals;
  std::vector<PreviewedQuestion> questions;
};

/// @param definition  loaded; outlives the preview
/// @param place   of the session, with its seeds
/// @param number  of the trial in the session, practice included, from 1
/// @throws InputError for a number beyond the session, or a formula without a value
PreviewedTrial previewed_trial(const StudiedDefinition& definition, const SessionPlace& place,
                               int number);

}  // namespace haptrial::protocols
