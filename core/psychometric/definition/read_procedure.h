#pragma once

#include <string>
#include <vector>

namespace haptrial::psychometric {

struct Track;
struct TrackKeys;

/// The words of `kind`.
const std::vector<std::string>& procedure_kinds();

/// Reads what the kind of a track asks for, and how it begins (track.h). Problems are noted.
void read_procedure(const TrackKeys& keys, Track& track);

}  // namespace haptrial::psychometric
