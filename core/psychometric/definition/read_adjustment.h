#pragma once

namespace haptrial::psychometric {

struct Track;
struct TrackKeys;

/// Reads an adjustment by steps that get finer, from starts of either side. Keys in brackets are
/// optional; problems are noted.
///
///     range, [scale], [origin]   of the track (track_keys.h)
///     starts, [repetitions], [in_rounds]
///     steps        sizes; [most_presentations]
void read_adjustment(const TrackKeys& keys, Track& track);

}  // namespace haptrial::psychometric
