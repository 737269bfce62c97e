#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "core/psychometric/definition/track.h"
#include "protocols/psychophysics/definition/block.h"

namespace haptrial::protocols {

class Names;
struct Interval;
struct TrialsDefinition;
using psychometric::Track;

/// Values of one trial for the names of a definition.
struct TrialValues {
  int trial{1};
  std::size_t block{0};  // of the definition
  int participant{1};
  int session{1};
  std::string group;
  std::string probe;               // empty: none
  std::vector<GivenValue> values;  // of block, factors and probe; a later one stands before
  std::vector<std::pair<std::string, double>> levels;      // that procedures set
  std::vector<std::pair<std::string, double>> thresholds;  // by the name of a track: what it found
  std::vector<std::size_t> intervals;  // of the definition, in the order of their presentation
};

/// The lowest levels of all tracks, or the highest; none where the block of the values asks no
/// procedure. So of the thresholds that tracks of other blocks find.
void give_corners(const TrialsDefinition& definition, bool high, TrialValues& values);

/// The name under which formulas know what a track found: "NAME.threshold".
std::string threshold_name(const std::string& track);
/// Whether formulas can name it: the track seeks a level, and its own name is a word.
bool has_threshold_name(const Track& track);

/// Everything that a trial may give a value: "trial", "block", "interval" (its place in the trial,
/// from 1), "participant", "session", "group", "probe" (a word; 'no' of a trial without), what
/// blocks, factors and intervals name, the variables of tracks, "NAME.threshold" of those that seek
/// one, "interval.NAME" (the place of the interval NAME), and each question's name (its answer).
void declare_names(Names& names, const TrialsDefinition& definition);

/// Gives the values that hold throughout the trial; all others are forgotten.
/// @throws InputError saying what is wrong with a formula
void give(Names& names, const TrialsDefinition& definition, const TrialValues& values);
/// Gives the values of one interval as well. @param place  from 0
void give_interval(Names& names, const Interval& interval, std::size_t place);

}  // namespace haptrial::protocols
