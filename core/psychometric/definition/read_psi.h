#pragma once

namespace haptrial::psychometric {

struct Track;
struct TrackKeys;

/// Reads a psi. Keys in brackets are optional; grids are lists or { from, to, count, [spacing] }.
///
///     levels       grid: what may be presented
///     [scale], [origin], [function], [guess]   of the psychometric function
///     [threshold], [width], [lapse]            grids: what is considered
///     [marginal]   whether levels tell of the threshold alone
///     stop         { trials, [entropy] }
///
/// Problems are noted.
void read_psi(const TrackKeys& keys, Track& track);

}  // namespace haptrial::psychometric
