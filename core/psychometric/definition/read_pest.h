#pragma once

namespace haptrial::psychometric {

struct Track;
struct TrackKeys;

/// Reads a PEST. Keys in brackets are optional; problems are noted.
///
///     range, [scale], [origin], start   of the track (track_keys.h)
///     first_step, smallest_step, largest_step
///     [target], [deviation], [right_raises]
///     stop         { trials }
void read_pest(const TrackKeys& keys, Track& track);

}  // namespace haptrial::psychometric
