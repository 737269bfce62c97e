#pragma once

#include <string>
#include <vector>

namespace haptrial::psychometric {

struct Track;

/// Sentences on a track that can be presented and yet tells nothing: an estimate that can never
/// exist, steps that are never made, parameters that no answer can change, thresholds that no level
/// reaches.
std::vector<std::string> procedure_warnings(const Track& track);

}  // namespace haptrial::psychometric
