#include "analysis/statistics/design/result_json_internal.h"

#include <nlohmann/json.hpp>

#include "analysis/statistics/base/descriptive.h"
#include "analysis/statistics/tests/t_tests.h"
#include "analysis/statistics/variance/effect_size.h"

namespace haptrial::analysis {

using Json = nlohmann::ordered_json;

Json to_json(const MeanInterval& m) {
  return {{"count", m.count},
          {"mean", m.mean},
          {"standard_deviation", m.deviation},
          {"low_95", m.low},
          {"high_95", m.high}};
}

Json to_json(const Mean& m) {
  if (m.interval) {
    return to_json(*m.interval);
  }
  Json json;
  if (m.value) {
    json["mean"] = *m.value;
  }
  json["not_defined"] = m.interval.because();
  return json;
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
