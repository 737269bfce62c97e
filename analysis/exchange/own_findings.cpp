#include "analysis/exchange/own_findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "analysis/document/finding_json_internal.h"
#include "analysis/quality/channel_quality.h"
#include "core/base/error.h"
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

/// The certificates of the devices that sessions ran with, as their definitions state them: which
/// force reached the hand for a commanded newton, and what hid it. Each certificate has a row; no
/// table if none is stated.
/// @throws InputError for a file that is no session
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

/// A figure that takes `least` samples.
Finding figure(const char* name, const char* title, double value, const char* unit,
               const ChannelQuality& c, std::uint64_t least) {
  Finding finding{.name = name, .title = title, .unit = unit};
  if (c.samples >= least) {
    finding.value = value;
  } else {
    finding.why_not = c.samples == 0 ? "no sample came" : "one sample came";
  }
  return finding;
}

FindingRow row_of(const record::SessionInfo& info, const ChannelQuality& c) {
  return {{.name = "participant", .title = "Participant", .value = info.subject},
          {.name = "session", .title = "Session", .value = info.session},
          {.name = "channel", .title = "Channel", .value = c.name},
          {.name = "samples", .title = "Samples", .value = c.samples},
          figure("rate", "A second", c.rate(), "Hz", c, 2),
          figure("uncertainty", "Times within, median", c.uncertainty, "s", c, 1),
          figure("largest_uncertainty", "at most", c.largest_uncertainty, "s", c, 1),
          {.name = "missing", .title = "Missing", .value = c.missing},
          {.name = "losses", .title = "Times lost", .value = c.losses},
          {.name = "faults", .title = "Faults that it stated", .value = c.faults},
          {.name = "clock_steps", .title = "Steps of its clock", .value = c.clock_steps}};
}

/// How well the sessions recorded their channels, a row for each channel of each session; no tables
/// where no session has one. @param sessions  files @throws InputError when one is damaged
FindingList channel_findings(const std::vector<std::filesystem::path>& sessions) {
  FindingTable table{"channels", "Samples of each channel, and how well their times are known"};
  for (const std::filesystem::path& file : sessions) {
    const record::SessionReader reader(file);
    for (const ChannelQuality& quality : channel_quality(reader)) {
      table.rows.push_back(row_of(reader.info(), quality));
    }
  }
  FindingList list{"channels", "Channels"};
  if (!table.rows.empty()) {
    list.tables.push_back(std::move(table));
  }
  return list;
}

std::vector<FindingSource>& sources() {
  static std::vector<FindingSource> all{{"certificates", certificate_findings},
                                        {"channels", channel_findings}};
  return all;
}

/// A number is in own_findings.csv under its name unless it has another one there.
void complete(const std::string& list, FindingRow& row) {
  for (Finding& f : row) {
    if (f.name.empty()) {
      throw RunError(fmt::format("the findings '{}' have one without a name: '{}'", list, f.title));
    }
    if (f.csv.empty()) {
      f.csv = f.name;
    }
  }
  row.insert(row.begin(), Finding{.name = "findings", .value = list, .form = JsonForm::kAbsent});
}

FindingList found_by(const FindingSource& source,
                     const std::vector<std::filesystem::path>& sessions, bool simulated) {
  FindingList list = source.find(sessions);
  list.name = source.name;
  list.heading += simulated ? " (simulated)" : "";
  complete(list.name, list.findings);
  for (FindingTable& table : list.tables) {
    for (FindingRow& row : table.rows) {
      complete(list.name, row);
    }
  }
  for (Figure& figure : list.figures) {
    figure.name = fmt::format("own-{}-{}", list.name, figure.name);
    figure.simulated = simulated;
  }
  try {
    json_of(std::vector{list});
  } catch (const nlohmann::json::exception&) {
    throw RunError(fmt::format("the findings '{}' have a name that is a value and a group at once",
                               list.name));
  }
  return list;
}

}  // namespace

void add_finding_source(FindingSource source) {
  const bool plain = std::ranges::all_of(
      source.name, [](unsigned char c) { return std::isalnum(c) != 0 || c == '-' || c == '_'; });
  if (source.name.empty() || !plain) {
    throw std::invalid_argument(
        fmt::format("add_finding_source: the name is '{}'; allowed: letters, digits, '-' and '_'",
                    source.name));
  }
  if (std::ranges::find(sources(), source.name, &FindingSource::name) != sources().end()) {
    throw std::invalid_argument(
        fmt::format("add_finding_source: there is a source '{}' already", source.name));
  }
  sources().push_back(std::move(source));
}

std::vector<FindingList> own_findings(const std::vector<std::filesystem::path>& sessions) {
  std::vector<FindingList> lists;
  const bool simulated = std::ranges::any_of(sessions, [](const std::filesystem::path& file) {
    return record::SessionReader(file).info().simulated;
  });
  for (const FindingSource& source : sources()) {
    FindingList list = found_by(source, sessions, simulated);
    if (list.has_values() || !list.blocks.empty()) {
      lists.push_back(std::move(list));
    }
  }
  return lists;
}

}  // namespace haptrial::analysis
