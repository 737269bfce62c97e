#include "analysis/force_training/study/identity_json_internal.h"

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

namespace haptrial::analysis {

using Json = nlohmann::ordered_json;

Json to_json(const std::vector<Identity>& identities) {
  Json all = Json::array();
  for (const Identity& identity : identities) {
    Json one{{"subject", identity.subject}, {"simulated", identity.simulated}};
    if (identity.seed) {
      one["seed"] = *identity.seed;
      one["population"] = identity.population;
    }
    all.push_back(std::move(one));
  }
  return all;
}

std::vector<Identity> identities_from(const Json& json) {
  std::vector<Identity> all;
  for (const Json& one : json) {
    Identity identity{one.at("subject").get<std::string>(), one.at("simulated").get<bool>()};
    if (one.contains("seed")) {
      identity.seed = one["seed"].get<std::uint64_t>();
      identity.population = one.at("population").get<std::map<std::string, std::string>>();
    }
    all.push_back(std::move(identity));
  }
  return all;
}

}  // namespace haptrial::analysis
