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

/// Reads `scale` and `origin` of the steps or the function of a track whose range is known.
/// @returns the track's axis
const Axis& read_axis(const TrackKeys& keys, Track& track);

/// A list of numbers, one number, or { from, to, count, [spacing] }. Problems are noted.
std::vector<double> read_grid(Table& table, const std::string& key);

/// The last of these. @param grid  the table itself
std::vector<double> read_spaced_grid(Table& grid);

/// Reads `levels`, a grid of what a track may present.
std::vector<double> read_levels(const TrackKeys& keys);

}  // namespace haptrial::psychometric
