#include "analysis/psychophysics/report/report_apparatus.h"

#include <cmath>

#include "analysis/psychophysics/report/trials_report.h"

namespace haptrial::analysis::trials {
namespace {

Finding level(const char* name, const char* title, const Estimated& e, const std::string& unit) {
  return {
      .name = name, .title = title, .value = e.value, .low = e.low, .high = e.high, .unit = unit};
}

FindingRow level_row(const std::string& who, const std::string& condition,
                     const std::string& quantity, const Estimated& commanded,
                     const std::string& unit, const device::Certificate& certificate) {
  return {{.name = "participant", .title = "participant", .value = who},
          {.name = "condition", .title = "condition", .value = condition},
          {.name = "quantity", .title = "quantity", .value = quantity},
          level("commanded", "as commanded", commanded, unit),
          level("measured", "as measured", as_measured(commanded, certificate), unit)};
}

FindingTable measured_table(const TrialsResult& result, const device::Certificate& certificate) {
  FindingTable table{"thresholds", "Levels as commanded and as measured"};
  const std::string& unit = result.plan.function.axis.unit;
  for (const FunctionFit& fit : result.fits) {
    if (fit.stated && grows_with_force(unit)) {
      table.rows.push_back(level_row(fit.participant, fit.condition, "threshold",
                                     fit.stated->threshold, unit, certificate));
    }
  }
  for (const Quantity& q : result.quantities) {
    for (std::size_t cell = 0; cell < q.means.size(); ++cell) {
      if (q.means[cell] && grows_with_force(q.unit)) {
        const MeanInterval& mean = *q.means[cell];
        table.rows.push_back(level_row(
            "mean over participants", result.plan.by.empty() ? "all" : q.table.names[cell], q.title,
            {mean.mean, mean.low, mean.high}, q.unit, certificate));
      }
    }
  }
  return table;
}

}  // namespace

std::optional<device::Certificate> certificate_of(const TrialsResult& result) {
  return device::certificate_in(result.definition, result.definition_name);
}

bool grows_with_force(const std::string& unit) {
  return unit == "N" || unit == "mN" || unit.starts_with("N/") || unit.starts_with("N·") ||
         unit.starts_with("N s") || unit.starts_with("N*");
}

Estimated as_measured(const Estimated& commanded, const device::Certificate& certificate) {
  const double gain = certificate.gain.value();
  Estimated made{gain * commanded.value};
  const double below = commanded.value * (gain - certificate.gain_low.value());
  const double above = commanded.value * (certificate.gain_high.value() - gain);
  made.low = made.value - std::hypot(gain * (commanded.value - commanded.low), below);
  made.high = made.value + std::hypot(gain * (commanded.high - commanded.value), above);
  return made;
}

FindingList apparatus_findings(const TrialsResult& result) {
  FindingList list{.name = "apparatus", .heading = "Apparatus"};
  const auto certificate = certificate_of(result);
  if (certificate && certificate->gain) {
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
  if (certificate->gain) {
    document.paragraph(
        "Levels as measured are those as commanded times the gain of the device's certificate; "
        "their intervals hold the uncertainty of both. Shares such as the Weber fraction are alike "
        "in both.");
  } else {
    document.paragraph(
        "The device's certificate states no gain, so that levels are as commanded: a gain takes a "
        "force sensor or a known mass.");
  }
}

}  // namespace haptrial::analysis::trials
