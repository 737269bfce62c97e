#pragma once

#include <nlohmann/json_fwd.hpp>

namespace haptrial::analysis {

struct DesignTests;
struct EffectSize;
struct Mean;
struct MeanInterval;
struct TTest;

// How results that every kind of study has stand in its statistics.json.
nlohmann::ordered_json to_json(const MeanInterval& mean);
/// Without an interval: the mean, and why it has none.
nlohmann::ordered_json to_json(const Mean& mean);
nlohmann::ordered_json to_json(const EffectSize& size);
nlohmann::ordered_json to_json(const TTest& test);
nlohmann::ordered_json to_json(const DesignTests& tests);

}  // namespace haptrial::analysis
