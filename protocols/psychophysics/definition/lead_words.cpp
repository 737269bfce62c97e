#include "protocols/psychophysics/definition/lead_words.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "protocols/psychophysics/definition/presented.h"

namespace haptrial::protocols {
namespace {

bool has(std::uint64_t bits, std::size_t i) { return (bits >> i & 1U) != 0; }

}  // namespace

void LeadReport::add(const Presented& presented) {
  for (const NamedStage& named : presented.stages) {
    const Stage& stage = named.stage;
    for (std::size_t r = 0; r < presented.regions.size(); ++r) {
      if (!has(stage.until.inside, r) || stage.late == Consequence::kGoOn) {
        continue;
      }
      const scene::Region& region = presented.regions[r];
      const scene::PlacedShape shape(region.shape);
      const std::uint64_t acting = stage.fields & presented.felt[presented.region_devices[r]];
      std::string leading;
      double nearest = INFINITY;
      for (std::size_t f = 0; f < presented.fields.size(); ++f) {
        const auto end =
            has(acting, f) ? scene::traits_of(presented.fields[f]).leads_to : std::nullopt;
        if (end) {
          const double away = shape.distance(*end).distance;
          leading = away < nearest ? presented.fields[f].name : leading;
          nearest = std::min(nearest, away);
        }
      }
      if (std::isfinite(nearest) && nearest > 0.0) {
        beside_.try_emplace(
            named.name,
            fmt::format("stage {} waits until the tool is inside regions.{}, and fields.{} leads "
                        "it to a place {:.3g} m beside it; a hand that is led never arrives",
                        named.name, region.name, leading, nearest));
      }
    }
  }
}

std::vector<std::string> LeadReport::warnings() const {
  std::vector<std::string> all;
  for (const auto& [stage, sentence] : beside_) {
    all.push_back(sentence);
  }
  return all;
}

}  // namespace haptrial::protocols
