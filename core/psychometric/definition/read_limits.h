#pragma once

namespace haptrial::psychometric {

struct Track;
struct TrackKeys;

/// kind = "limits": range, step, and optional keys of LimitsParameters.
void read_limits(const TrackKeys& keys, Track& track);

}  // namespace haptrial::psychometric
