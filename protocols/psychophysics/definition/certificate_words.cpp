#include "protocols/psychophysics/definition/certificate_words.h"

#include <fmt/format.h>

#include "core/device/handle_part.h"
#include "protocols/psychophysics/definition/trials_definition.h"

namespace haptrial::protocols {
namespace {

using device::Part;

/// The figures of one part by a certificate, and words for the part.
struct CertifiedPart {
  Part part;
  const device::CertifiedForce& figures;
  std::string file;

  const char* unit() const { return device::units_of(part, 1.0).force; }
  const char* force() const { return device::force_word(part); }
  const char* owner() const { return part == Part::kTip ? "device" : device::part_word(part); }
};

void add_track(const Track& track, const CertifiedPart& c, std::vector<std::string>& all) {
  if (track.unit != c.unit() || !track.range_known) {
    return;
  }
  const device::CertifiedForce& figures = c.figures;
  if (figures.dead_zone && track.low < *figures.dead_zone) {
    all.push_back(fmt::format(
        "{}: its levels begin at {:g} {}, but the certificate {} says that commands up to {:.3g} "
        "{} give no {}",
        track.name, track.low, c.unit(), c.file, *figures.dead_zone, c.unit(), c.force()));
  } else if (figures.friction && track.low < *figures.friction) {
    all.push_back(fmt::format(
        "{}: its levels begin at {:g} {}, but the certificate {} says that the {}'s friction is "
        "{:.3g} {}, which hides less",
        track.name, track.low, c.unit(), c.file, c.owner(), *figures.friction, c.unit()));
  }
  if (figures.force_noise && track.resolution > 0.0 && track.resolution < *figures.force_noise) {
    all.push_back(fmt::format(
        "{}: its levels are {:g} {} apart, but the certificate {} says that the {}'s {} ripples by "
        "{:.3g} {}",
        track.name, track.resolution, c.unit(), c.file, c.owner(), c.force(), *figures.force_noise,
        c.unit()));
  }
}

void add_stiffest(const StiffestStage& stiffest, const CertifiedPart& c,
                  std::vector<std::string>& all) {
  if (!c.figures.stiffest_wall || stiffest.stiffness <= *c.figures.stiffest_wall) {
    return;
  }
  const char* unit = c.part == Part::kRotation ? "N·m/rad" : "N/m";
  all.push_back(fmt::format(
      "stage {}: its fields{} add up to {:.4g} {}, but the certificate {} says that {:.4g} {} is "
      "the stiffest {} that stays passive while nobody holds the handle",
      stiffest.name, c.part == Part::kTip ? "" : fmt::format(" on the {}", c.owner()),
      stiffest.stiffness, unit, c.file, *c.figures.stiffest_wall, unit,
      c.part == Part::kTip ? "wall" : "spring"));
}

}  // namespace

std::vector<std::string> certificate_warnings(const TrialsDefinition& definition,
                                              const FeltParts& parts) {
  std::vector<std::string> all;
  if (!definition.certificate) {
    return all;
  }
  const device::Certificate& c = *definition.certificate;
  const auto felt = [&](Part part) { return parts[static_cast<std::size_t>(part)].felt; };
  std::vector<CertifiedPart> certified;
  if (felt(Part::kTip) || !felt(Part::kGrip)) {
    certified.push_back({Part::kTip, c, c.file});
  }
  if (c.rotation && felt(Part::kRotation)) {
    certified.push_back({Part::kRotation, *c.rotation, c.file});
  }
  if (c.grip && felt(Part::kGrip)) {
    certified.push_back({Part::kGrip, *c.grip, c.file});
  }
  for (const CertifiedPart& part : certified) {
    for (const Track& track : definition.tracks) {
      add_track(track, part, all);
    }
    add_stiffest(parts[static_cast<std::size_t>(part.part)].stiffest, part, all);
  }
  return all;
}

}  // namespace haptrial::protocols
