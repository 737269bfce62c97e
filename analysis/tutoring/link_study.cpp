#include "analysis/tutoring/link_study.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "core/record/read/session_reader.h"

namespace haptrial::analysis::link {
namespace {

std::vector<std::string> networks_by_delay(const std::vector<LedPass>& passes) {
  std::map<std::string, double> delays;
  for (const LedPass& led : passes) {
    if (!led.network.empty()) {
      delays[led.network] = led.set_delay;
    }
  }
  std::vector<std::string> names;
  for (const auto& [name, delay] : delays) {
    names.push_back(name);
  }
  std::ranges::stable_sort(names, {}, [&](const std::string& name) { return delays.at(name); });
  return names;
}

void fill(LinkQuantity& quantity, const std::vector<LedPass>& passes,
          const std::vector<std::string>& networks, const Resampling& resampling) {
  std::vector<Observation> observations;
  for (const LedPass& led : passes) {
    const double value = led.*quantity.of;
    if (!led.network.empty() && value > 0.0) {
      observations.push_back({led.subject, {led.network}, std::log(value)});
    }
  }
  quantity.table = design_table(observations, {"network"}, networks);
  Resampling own = resampling;
  own.stream = "link " + quantity.title;
  quantity.tests = design_tests(quantity.table, {}, own);
}

}  // namespace

std::vector<LinkQuantity> link_quantities(const std::vector<LedPass>& passes,
                                          const std::vector<std::string>& networks,
                                          const Resampling& resampling) {
  if (networks.size() < 2) {
    return {};
  }
  std::vector<LinkQuantity> quantities(2);
  quantities[0] = {"distance between the hands", &LedPass::apart, {}, {}};
  quantities[1] = {"force of the link", &LedPass::coupling, {}, {}};
  for (LinkQuantity& quantity : quantities) {
    fill(quantity, passes, networks, resampling);
  }
  return quantities;
}

std::optional<LinkStudy> link_study(const std::vector<std::filesystem::path>& files,
                                    std::uint64_t seed, int threads) {
  LinkStudy study;
  study.simulated = false;
  for (const std::filesystem::path& file : files) {
    const record::SessionReader reader(file);
    std::vector<LedPass> led = led_passes(reader);
    study.simulated = study.simulated || reader.info().simulated;
    std::ranges::move(led, std::back_inserter(study.passes));
  }
  if (study.passes.empty()) {
    return std::nullopt;
  }
  study.networks = networks_by_delay(study.passes);
  study.quantities = link_quantities(study.passes, study.networks, {seed, "link", 9999, threads});
  return study;
}

}  // namespace haptrial::analysis::link
