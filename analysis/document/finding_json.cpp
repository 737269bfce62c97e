#include <cmath>
#include <nlohmann/json.hpp>

#include "analysis/document/finding_json_internal.h"

namespace haptrial::analysis {
namespace {

using Json = nlohmann::ordered_json;

bool has_number(const Finding& f) {
  return f.why_not.empty() && (f.value.number() != nullptr || f.value.count() != nullptr);
}

Json value_of(const Finding& f) {
  if (!f.json.empty()) {
    return Json::parse(f.json);
  }
  const double* number = f.value.number();
  const std::int64_t* count = f.value.count();
  return number != nullptr           ? Json(*number)
         : count != nullptr          ? Json(*count)
         : f.value.word() != nullptr ? Json(*f.value.word())
                                     : Json();
}

Json described(const Finding& f) {
  Json made{{"title", f.title}, {"estimate", value_of(f)}};
  if (!std::isnan(f.low) && !std::isnan(f.high)) {
    made["low_95"] = f.low;
    made["high_95"] = f.high;
  }
  if (!f.unit.empty()) {
    made["unit"] = f.unit;
  }
  if (f.n > 0) {
    made["n"] = f.n;
  }
  return made;
}

}  // namespace

nlohmann::ordered_json json_of(const FindingRow& row) {
  Json made = Json::object();
  for (const Finding& f : row) {
    if (f.form == JsonForm::kAbsent) {
      continue;
    }
    const std::string place = "/" + f.name;
    Json& at = made[Json::json_pointer(place)];
    if (!f.why_not.empty()) {
      at = {{"not_defined", f.why_not}};
    } else if (f.form == JsonForm::kDescribed && has_number(f)) {
      at = described(f);
    } else if (f.form == JsonForm::kEstimate) {
      at = {{"estimate", value_of(f)}, {"low_95", f.low}, {"high_95", f.high}};
    } else {
      at = value_of(f);
    }
    if (f.form == JsonForm::kBeside && f.why_not.empty()) {
      made[Json::json_pointer(place + "_low_95")] = f.low;
      made[Json::json_pointer(place + "_high_95")] = f.high;
    }
  }
  return made;
}

nlohmann::ordered_json json_of(const std::vector<FindingRow>& rows) {
  Json made = Json::array();
  for (const FindingRow& row : rows) {
    made.push_back(json_of(row));
  }
  return made;
}

nlohmann::ordered_json json_of(const std::vector<FindingList>& lists) {
  Json all = Json::object();
  for (const FindingList& list : lists) {
    if (!list.has_values()) {
      continue;
    }
    Json& made = all[list.name];
    made = {{"heading", list.heading}, {"findings", json_of(list.findings)}};
    for (const FindingTable& table : list.tables) {
      made["tables"][table.name] = json_of(table.rows);
    }
    for (const Figure& figure : list.figures) {
      made["figures"].push_back(figure.name);
    }
  }
  return all;
}

}  // namespace haptrial::analysis
