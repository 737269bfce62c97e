#include "analysis/exchange/certificate_findings.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/device/certificate.h"
#include "core/device/handle_part.h"
#include "core/record/read/session_reader.h"

namespace haptrial::analysis {
namespace {

Finding certified(const char* name, const char* title, const std::optional<double>& value,
                  const char* unit) {
  Finding finding{.name = name, .title = title, .unit = unit};
  if (value) {
    finding.value = *value;
  } else {
    finding.why_not = "the certificate does not state it";
  }
  return finding;
}

Finding certified_gain(const device::CertifiedForce& c) {
  Finding gain = certified("gain", "Force on the hand per force commanded", c.gain, "");
  if (c.gain) {
    gain.low = c.gain_low.value_or(Finding::kNone);
    gain.high = c.gain_high.value_or(Finding::kNone);
  }
  return gain;
}

FindingRow certificate_row(const device::Certificate& c, std::size_t sessions) {
  FindingRow row{{.name = "device",
                  .title = "Device",
                  .value = fmt::format("{}{}", c.device, c.simulated ? " (simulated)" : "")},
                 {.name = "certificate", .title = "Certificate", .value = c.file},
                 {.name = "checksum", .title = "Checksum", .value = c.checksum},
                 {.name = "sessions", .title = "Sessions", .value = sessions},
                 certified_gain(c)};
  row.push_back(certified("dead_zone", "Commands up to here gave no force", c.dead_zone, "N"));
  row.push_back(certified("friction", "Friction", c.friction, "N"));
  row.push_back(certified("delay", "Delay from a command to its force", c.delay, "s"));
  return row;
}

/// Figures of a rotation or grip, in their own units.
FindingRow part_row(const device::Certificate& whole, const device::CertifiedForce& c,
                    device::Part part) {
  const char* unit = device::units_of(part, 1.0).force;
  return {{.name = "certificate", .title = "Certificate", .value = whole.file},
          {.name = "part", .title = "Part", .value = device::part_word(part)},
          certified_gain(c),
          certified("dead_zone", "Commands up to here gave none", c.dead_zone, unit),
          certified("friction", "Friction", c.friction, unit),
          certified("delay", "Delay from a command", c.delay, "s")};
}

}  // namespace

FindingList certificate_findings(const std::vector<std::filesystem::path>& sessions) {
  struct Used {
    device::Certificate certificate;
    std::size_t sessions{1};
  };
  std::vector<Used> all;
  for (const std::filesystem::path& file : sessions) {
    const record::SessionReader reader(file);
    const auto certificate =
        device::certificate_in(reader.info().definition, reader.info().definition_name);
    if (!certificate) {
      continue;
    }
    const auto known = std::ranges::find_if(
        all, [&](const Used& used) { return used.certificate.checksum == certificate->checksum; });
    if (known == all.end()) {
      all.push_back({*certificate});
    } else {
      ++known->sessions;
    }
  }
  FindingList list{"certificates", "Device"};
  if (!all.empty()) {
    FindingTable table{"certificates", "What the device did with what was commanded"};
    FindingTable parts{"certified_parts", "The same of its rotation and grip"};
    for (const Used& used : all) {
      table.rows.push_back(certificate_row(used.certificate, used.sessions));
      if (used.certificate.rotation) {
        parts.rows.push_back(
            part_row(used.certificate, *used.certificate.rotation, device::Part::kRotation));
      }
      if (used.certificate.grip) {
        parts.rows.push_back(
            part_row(used.certificate, *used.certificate.grip, device::Part::kGrip));
      }
    }
    list.tables.push_back(std::move(table));
    if (!parts.rows.empty()) {
      list.tables.push_back(std::move(parts));
    }
  }
  return list;
}

}  // namespace haptrial::analysis
