#pragma once

namespace haptrial::psychometric {

struct Track;
struct TrackKeys;

/// Reads a staircase. Keys in brackets are optional; problems are noted.
///
///     range, [scale], [origin], start   of the track (track_keys.h)
///     steps        sizes, or [[step down, step up], …]; [schedule]
///     [down], [up], [first_down], [first_up], [right_raises], [at_bound]
///     stop         { trials, [reversals] }
///     [estimate]   { of, skip, last }
void read_staircase(const TrackKeys& keys, Track& track);

}  // namespace haptrial::psychometric
