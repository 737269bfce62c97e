#include "analysis/bone_drilling/report/field_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace haptrial::analysis::drilling {
namespace {

constexpr double kMillilitres = 1e6;  // in a cubic metre

bool warms(const record::FieldRow& field) { return field.hottest > 0.0; }

}  // namespace

bool has_field(std::span<const ProcedureSummary> procedures) {
  return std::any_of(procedures.begin(), procedures.end(),
                     [](const ProcedureSummary& p) { return p.field.has_value(); });
}

void add_field_section(Document& document, std::span<const ProcedureSummary> procedures,
                       bool simulated) {
  if (!has_field(procedures)) {
    return;
  }
  document.heading(simulated ? "Heat and blood (simulated)" : "Heat and blood");
  document.paragraph(
      "Both are a model to train with. Whoever drills, the temperatures say who pressed long and "
      "rinsed late, and predict nothing about a patient; groups are not compared.");
  std::vector<std::vector<std::string>> rows;
  for (const ProcedureSummary& p : procedures) {
    if (p.field) {
      const record::FieldRow& field = *p.field;
      rows.push_back({p.participant, p.group, std::to_string(p.number),
                      warms(field) ? fmt::format("{:.1f}", field.hottest) : "–",
                      warms(field) ? fmt::format("{:.1f}", field.harmful_time) : "–",
                      fmt::format("{:.2f}", kMillilitres * field.bled),
                      fmt::format("{:.2f}", kMillilitres * field.blood_sucked)});
    }
  }
  document.table({"participant", "group", "procedure", "hottest at the burr [°C]",
                  "above the harmful temperature [s]", "blood lost [ml]", "sucked away [ml]"},
                 rows);
}

std::string field_csv(std::span<const ProcedureSummary> procedures) {
  std::string text =
      "session,participant,group,procedure,simulated,hottest_degC,harmful_time_s,bled_ml,"
      "blood_sucked_ml,blood_lying_ml\n";
  for (const ProcedureSummary& p : procedures) {
    if (p.field) {
      const record::FieldRow& field = *p.field;
      text += fmt::format(
          "{},{},{},{},{},{},{},{:.6g},{:.6g},{:.6g}\n", p.session, p.participant, p.group,
          p.number, p.simulated ? 1 : 0, warms(field) ? fmt::format("{:.3f}", field.hottest) : "",
          warms(field) ? fmt::format("{:.3f}", field.harmful_time) : "", kMillilitres * field.bled,
          kMillilitres * field.blood_sucked, kMillilitres * field.blood_lying);
    }
  }
  return text;
}

}  // namespace haptrial::analysis::drilling
