#include "protocols/bone_drilling/tuning_page.h"

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/base/error.h"

namespace haptrial::protocols {
namespace {

using nlohmann::json;

/// A bound as JSON has it; null where there is none.
json bound_json(double bound) { return std::isfinite(bound) ? json(bound) : json(nullptr); }

json key_json(const TunableKey& now, double first) {
  return {{"key", now.key},
          {"text", now.text},
          {"low", now.bounds.open_low ? json(nullptr) : bound_json(now.bounds.low)},
          {"high", bound_json(now.bounds.high)},
          {"unit", now.unit},
          {"value", now.value},
          {"first", first}};
}

/// The value that a key has at first; one that is only there now has had no other.
double first_value(const LiveTuning::View& view, const TunableKey& now) {
  for (const TunableKey& each : view.at_first) {
    if (each.key == now.key) {
      return each.value;
    }
  }
  return now.value;
}

std::string tuning_json(const LiveTuning::View& view, bool whole) {
  json out{{"changes", view.changes}, {"taken", view.taken}};
  if (whole) {
    json keys = json::array();
    for (const TunableKey& key : view.now) {
      keys.push_back(key_json(key, first_value(view, key)));
    }
    out["keys"] = keys;
    out["contact"] = view.contact;
    out["file"] = std::filesystem::path(view.file_name).filename().string();
    out["definition"] = view.text;
  }
  return out.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

AuxiliaryPage::Events TuningPage::events() {
  return [tuning = tuning_, shown = std::optional<std::uint64_t>{}]() mutable {
    const LiveTuning::View view = tuning->view();
    const bool whole = shown != view.changes;
    shown = view.changes;
    return tuning_json(view, whole);
  };
}

void TuningPage::ask(const std::string& text) {
  const json body = json::parse(text, nullptr, false);
  const bool good = body.is_object() && body.size() == 2 && body.contains("key") &&
                    body["key"].is_string() && body.contains("value") && body["value"].is_number();
  if (!good) {
    throw InputError(
        "the body must be an object with the text \"key\", the path of a tunable key, and the "
        "number \"value\"");
  }
  tuning_->change(body["key"].get<std::string>(), body["value"].get<double>());
}

}  // namespace haptrial::protocols
