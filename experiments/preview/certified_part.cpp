#include "experiments/preview/certified_part.h"

#include <fmt/format.h>

#include <cmath>

namespace haptrial::experiments {
namespace {

std::string judged(const DeviceDemand& demand, const device::Certificate& certificate) {
  if (demand.stiffness <= 0.0) {
    return "no stiffness";
  }
  if (!std::isfinite(demand.stiffness)) {
    return "the force jumps, which no stiffness bounds";
  }
  if (!certificate.stiffest_wall) {
    return "not certified";
  }
  const double share = demand.stiffness / *certificate.stiffest_wall;
  return share <= 1.0 ? fmt::format("yes, {:.0f} % of it", 100.0 * share)
                      : fmt::format("no, {:.3g} times as stiff", share);
}

void add_figures(const device::Certificate& c, Preview& preview) {
  std::vector<std::vector<std::string>> rows;
  const auto add = [&](const char* name, const std::optional<double>& value, double unit,
                       const char* unit_name) {
    rows.push_back({name, value ? fmt::format("{:.4g} {}", *value / unit, unit_name)
                                : "not in the certificate"});
  };
  add("stiffest wall that stays passive", c.stiffest_wall, 1.0, "N/m");
  add("force measured per force commanded", c.gain, 1.0, "");
  add("longest command without a force", c.dead_zone, 1.0, "N");
  add("friction", c.friction, 1.0, "N");
  add("noise of the force", c.force_noise, 1.0, "N");
  add("delay of the force", c.delay, 1e-3, "ms");
  preview.document.table({"certified", "value"}, rows);
}

}  // namespace

void add_certified(const protocols::Definition& d, const std::vector<DeviceDemand>& demands,
                   Preview& preview) {
  preview.document.subheading("What the certified device presents");
  if (!d.certificate) {
    preview.document.paragraph(
        "The definition names no certificate of a device (device.certificate), so that the forces "
        "are not compared with what a device can present.");
    return;
  }
  const device::Certificate& certificate = *d.certificate;
  preview.document.paragraph(fmt::format(
      "Certificate {} of the device {}{}. It has no figure for damping, which is listed only.",
      certificate.file, certificate.device, certificate.simulated ? ", a virtual one" : ""));
  add_figures(certificate, preview);
  std::vector<std::vector<std::string>> rows;
  for (const DeviceDemand& demand : demands) {
    rows.push_back({demand.name, fmt::format("{:.4g}", demand.stiffness),
                    fmt::format("{:.4g}", demand.damping), judged(demand, certificate)});
  }
  preview.document.table(
      {"asked for by", "stiffness [N/m]", "damping [N·s/m]", "within the stiffest wall"}, rows);
}

}  // namespace haptrial::experiments
