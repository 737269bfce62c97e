#include "analysis/psychophysics/report/report_apparatus.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "analysis/psychophysics/report/trials_report.h"
#include "core/base/definition/table.h"

namespace haptrial::analysis::trials {
namespace {

Finding level(const char* name, const char* title, const Estimated& e, const std::string& unit) {
  return {
      .name = name, .title = title, .value = e.value, .low = e.low, .high = e.high, .unit = unit};
}

FindingRow level_row(const std::string& who, const std::string& condition,
                     const std::string& quantity, const Estimated& commanded,
                     const std::string& unit, const device::CertifiedForce& figures) {
  return {{.name = "participant", .title = "participant", .value = who},
          {.name = "condition", .title = "condition", .value = condition},
          {.name = "quantity", .title = "quantity", .value = quantity},
          level("commanded", "as commanded", commanded, unit),
          level("measured", "as measured", as_measured(commanded, unit, figures), unit)};
}

bool is_torque(const std::string& unit) {
  return unit.starts_with("N·m") || unit.starts_with("mN·m");
}

/// Whether fields and objects of a definition act on a grip, and whether they act on a tip.
struct ActsOn {
  bool grip{false}, tip{false};
};

/// The tables in one of a definition's, each with its name.
std::vector<std::pair<std::string, Table>> tables_in(Table& root, const char* kind) {
  std::vector<std::pair<std::string, Table>> all;
  if (root.has(kind)) {
    Table table = root.table(kind);
    for (const std::string& name : table.keys()) {
      all.emplace_back(name, table.table(name));
    }
  }
  return all;
}

ActsOn acts_on(const std::string& definition) {
  ActsOn on;
  Table root = Table::parse(definition, "definition");
  std::set<std::string> grips;
  for (auto& [name, device] : tables_in(root, "devices")) {
    if (device.has("grip_of")) {
      grips.insert(name);
    }
  }
  for (const char* kind : {"fields", "objects"}) {
    for (auto& [name, own] : tables_in(root, kind)) {
      const bool grip = own.has("device") && grips.contains(own.text("device"));
      (grip ? on.grip : on.tip) = true;
    }
  }
  return on;
}

/// Changes from a baseline are no levels: a dead zone is no part of them.
bool changes(const TrialsResult& result) { return !result.plan.baseline.empty(); }

FindingTable measured_table(const TrialsResult& result, const device::Certificate& certificate) {
  FindingTable table{"thresholds", "Levels as commanded and as measured"};
  const std::string& unit = result.plan.function.axis.unit;
  const auto of_levels = figures_of(unit, certificate, result.definition);
  for (const FunctionFit& fit : result.fits) {
    if (fit.stated && of_levels) {
      table.rows.push_back(level_row(fit.participant, fit.condition, "threshold",
                                     fit.stated->threshold, unit, *of_levels));
    }
  }
  for (const Quantity& q : result.quantities) {
    const auto figures = figures_of(q.unit, certificate, result.definition);
    for (std::size_t cell = 0; cell < q.means.size(); ++cell) {
      if (q.means[cell] && figures && !changes(result)) {
        const MeanInterval& mean = *q.means[cell];
        table.rows.push_back(level_row(
            "mean over participants", result.plan.by.empty() ? "all" : q.table.names[cell], q.title,
            {mean.mean, mean.low, mean.high}, q.unit, *figures));
      }
    }
  }
  return table;
}

bool has_gain(const device::Certificate& certificate) {
  return certificate.gain || (certificate.rotation && certificate.rotation->gain) ||
         (certificate.grip && certificate.grip->gain);
}

}  // namespace

std::optional<device::Certificate> certificate_of(const TrialsResult& result) {
  return device::certificate_in(result.definition, result.definition_name);
}

bool grows_with_force(const std::string& unit) {
  return unit == "N" || unit == "mN" || unit.starts_with("mN·m") || unit.starts_with("N/") ||
         unit.starts_with("N·") || unit.starts_with("N s") || unit.starts_with("N*");
}

std::optional<device::CertifiedForce> figures_of(const std::string& unit,
                                                 const device::Certificate& certificate,
                                                 const std::string& definition) {
  if (!grows_with_force(unit)) {
    return std::nullopt;
  }
  std::optional<device::CertifiedForce> figures = certificate;
  if (is_torque(unit)) {
    figures = certificate.rotation;
  } else if (const ActsOn on = acts_on(definition); on.grip) {
    figures = on.tip ? std::nullopt : certificate.grip;
  }
  return figures && figures->gain ? figures : std::nullopt;
}

Estimated as_measured(const Estimated& commanded, const std::string& unit,
                      const device::CertifiedForce& figures) {
  constexpr double kMilli = 1e3;
  const double gain = figures.gain.value();
  const bool force = unit == "N" || unit == "N·m" || unit == "mN" || unit == "mN·m";
  const double zone =
      (force ? figures.dead_zone.value_or(0.0) : 0.0) * (unit.starts_with("mN") ? kMilli : 1.0);
  const double felt = std::max(commanded.value - zone, 0.0);
  Estimated made{gain * felt};
  const double below = felt * (gain - figures.gain_low.value());
  const double above = felt * (figures.gain_high.value() - gain);
  made.low = made.value - std::hypot(gain * (commanded.value - commanded.low), below);
  made.high = made.value + std::hypot(gain * (commanded.high - commanded.value), above);
  if (zone > 0.0 && made.low < 0.0) {
    made.low = 0.0;
  }
  return made;
}

FindingList apparatus_findings(const TrialsResult& result) {
  FindingList list{.name = "apparatus", .heading = "Apparatus"};
  const auto certificate = certificate_of(result);
  if (certificate && has_gain(*certificate)) {
    list.tables.push_back(measured_table(result, *certificate));
  }
  return list;
}

void add_apparatus(Document& document, const TrialsResult& result) {
  const auto certificate = certificate_of(result);
  if (!certificate) {
    return;
  }
  add_section(document, result, "Apparatus");
  for (const FindingTable& table : apparatus_findings(result).tables) {
    if (!table.rows.empty()) {
      add_table(document, table, false);
    }
  }
  if (has_gain(*certificate)) {
    document.paragraph(
        "Levels as measured are what forces and torques have beyond the dead zone, and stiffnesses "
        "and the like as they are, times the gain, by the figures of the device's certificate for "
        "the part that they act on; their intervals hold the uncertainty of level and gain. Shares "
        "such as the Weber fraction are alike in both if there is no dead zone.");
  } else {
    document.paragraph(
        "The device's certificate states no gain, so that levels are as commanded: a gain takes a "
        "force sensor or a known mass.");
  }
}

}  // namespace haptrial::analysis::trials
