#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/definition/table.h"
#include "core/psychometric/function/axis.h"

namespace haptrial::psychometric {

struct Track;

/// Tables with the keys of a track: its own, or else that of its procedure.
struct TrackKeys {
  Table& track;
  Table& procedure;

  bool has(std::string_view key) const { return track.has(key) || procedure.has(key); }
  Table& of(std::string_view key) const {
    const bool here = track.has(key);
    if (here) {
      procedure.pass_over(key);
    }
    return here ? track : procedure;
  }
};

/// Absence of a key that every track needs, in words for lists of keys.
inline constexpr const char* kProceduresOwn = "needed; a track takes its procedure's";

// Keys that several kinds of procedures have. Problems are noted.

/// Description of `steps`, the sizes of steps.
inline constexpr const char* kStepsText =
    "Sizes of the steps, on the axis of the scale, the next one after each reversal; of a "
    "staircase also pairs [down, up]";
/// Description of `right_raises`, which sets Track::falls.
inline constexpr const char* kRightRaisesText =
    "Whether right answers raise the level; then they get rarer as it rises, and the function of "
    "[analysis] falls (neg_norm)";

/// Reads `range`, `scale` and `origin` of a track whose levels are not listed.
void read_range_and_axis(const TrackKeys& keys, Track& track);

/// Reads `scale` and `origin` of the steps or the function of a track whose range is known.
/// @returns the track's axis
const Axis& read_axis(const TrackKeys& keys, Track& track);

/// Reads `start`, a level within the track's range [unit of the level].
double read_start(const TrackKeys& keys, const Track& track);

/// Events at which a track stops; 0: not by these.
struct TrackStop {
  int reversals{0};
  int trials{0};
  double entropy{0.0};  // [nat]
};

/// Reads `stop`, which sets the most trials of the track.
TrackStop read_stop(const TrackKeys& keys, Track& track);

/// "It ended after 10 reversals or 60 trials."
std::string words_of(const TrackStop& stop);
/// "0.2, 0.1", the shortest decimals.
std::string words_of(const std::vector<double>& numbers);

}  // namespace haptrial::psychometric
