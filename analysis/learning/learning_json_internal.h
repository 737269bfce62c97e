#pragma once

#include <nlohmann/json_fwd.hpp>

namespace haptrial::analysis {

struct LearnedStudy;

/// The changes that a study found, as they stand in its statistics.json.
nlohmann::ordered_json learning_json(const LearnedStudy& study);

}  // namespace haptrial::analysis
