#pragma once

#include <string>
#include <vector>

namespace haptrial::psychometric {

struct Track;
class QuestTables;

/// Sentences on a psi or QUEST+ that can be presented and yet tells nothing: parameters that no
/// answer can change, thresholds that no level reaches, levels that tell no parameters apart.
std::vector<std::string> quest_warnings(const Track& track, const QuestTables& tables);

}  // namespace haptrial::psychometric
