#include "analysis/result_json_internal.h"

#include <nlohmann/json.hpp>

#include "analysis/descriptive.h"
#include "analysis/effect_size.h"
#include "analysis/t_test.h"

namespace haptrial::analysis {

using Json = nlohmann::ordered_json;

Json to_json(const MeanInterval& m) {
  return {{"count", m.count},
          {"mean", m.mean},
          {"standard_deviation", m.deviation},
          {"low_95", m.low},
          {"high_95", m.high}};
}

Json to_json(const EffectSize& e) {
  return {{"value", e.value}, {"low", e.low}, {"high", e.high}, {"level", e.level}};
}

Json to_json(const TTest& t) {
  return {{"t", t.t},
          {"df", t.df},
          {"p", t.p},
          {"difference", t.difference},
          {"difference_low_95", t.low},
          {"difference_high_95", t.high}};
}

}  // namespace haptrial::analysis
