#pragma once

namespace haptrial::psychometric {

struct Track;
struct TrackKeys;

/// Reads a threshold surface (threshold_surface.h). Keys in brackets are optional:
///
///     stimulus   VARIABLE = grid, [resolution], as of QUEST+; thresholds are of the first one
///     stop       { trials }
///     [rising]   further variables with which answers 1 get no rarer
///     [target], [guess], [lapse]   probabilities
///     [present]  formula of the variables: levels at which it is 0 are not presented
///
/// Problems are noted.
void read_surface(const TrackKeys& keys, Track& track);

}  // namespace haptrial::psychometric
