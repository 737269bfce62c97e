#include "protocols/psychophysics/definition/certificate_words.h"

#include <fmt/format.h>

#include "protocols/psychophysics/definition/trials_definition.h"

namespace haptrial::protocols {
namespace {

void add_track(const Track& track, const device::Certificate& c, std::vector<std::string>& all) {
  if (track.unit != "N" || !track.range_known) {
    return;
  }
  if (c.dead_zone && track.low < *c.dead_zone) {
    all.push_back(fmt::format(
        "{}: its levels begin at {:g} N, but the certificate {} says that commands up to {:.3g} N "
        "give no force",
        track.name, track.low, c.file, *c.dead_zone));
  } else if (c.friction && track.low < *c.friction) {
    all.push_back(fmt::format(
        "{}: its levels begin at {:g} N, but the certificate {} says that the device's friction is "
        "{:.3g} N, which hides less",
        track.name, track.low, c.file, *c.friction));
  }
  if (c.force_noise && track.resolution > 0.0 && track.resolution < *c.force_noise) {
    all.push_back(fmt::format(
        "{}: its levels are {:g} N apart, but the certificate {} says that the device's force "
        "ripples by {:.3g} N",
        track.name, track.resolution, c.file, *c.force_noise));
  }
}

}  // namespace

std::vector<std::string> certificate_warnings(const TrialsDefinition& definition,
                                              const StiffestStage& stiffest) {
  std::vector<std::string> all;
  if (!definition.certificate) {
    return all;
  }
  const device::Certificate& c = *definition.certificate;
  for (const Track& track : definition.tracks) {
    add_track(track, c, all);
  }
  if (c.stiffest_wall && stiffest.stiffness > *c.stiffest_wall) {
    all.push_back(fmt::format(
        "stage {}: its fields add up to {:g} N/m, but the certificate {} says that {:.4g} N/m is "
        "the stiffest wall that stays passive while nobody holds the handle",
        stiffest.name, stiffest.stiffness, c.file, *c.stiffest_wall));
  }
  return all;
}

}  // namespace haptrial::protocols
