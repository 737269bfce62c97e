#include "analysis/bone_drilling/report/field_section.h"

#include <fmt/format.h>

#include <algorithm>

namespace haptrial::analysis::drilling {
namespace {

constexpr double kMillilitres = 1e6;  // in a cubic metre

bool warms(const record::FieldRow& field) { return field.hottest > 0.0; }

}  // namespace

bool has_field(std::span<const ProcedureSummary> procedures) {
  return std::any_of(procedures.begin(), procedures.end(),
                     [](const ProcedureSummary& p) { return p.field.has_value(); });
}

FindingList field_findings(std::span<const ProcedureSummary> procedures) {
  FindingList list{.name = "heat_and_blood", .heading = "Heat and blood"};
  if (!has_field(procedures)) {
    return list;
  }
  FindingTable& table = list.tables.emplace_back("procedures", "");
  for (const ProcedureSummary& p : procedures) {
    if (p.field) {
      const record::FieldRow& field = *p.field;
      const auto of_heat = [&](double value) {
        return warms(field) ? FindingValue(value) : FindingValue();
      };
      table.rows.push_back(
          {plain_finding("session", "", p.session),
           plain_finding("participant", "participant", p.participant),
           plain_finding("group", "group", p.group),
           plain_finding("procedure", "procedure", p.number),
           plain_finding("hottest_degC", "hottest at the burr", of_heat(field.hottest), "°C"),
           plain_finding("harmful_time_s", "above the harmful temperature",
                         of_heat(field.harmful_time), "s"),
           plain_finding("bled_ml", "blood lost", kMillilitres * field.bled, "ml"),
           plain_finding("blood_sucked_ml", "sucked away", kMillilitres * field.blood_sucked,
                         "ml")});
    }
  }
  Document words;
  words.paragraph(
      "Both are a model to train with. Whoever drills, the temperatures say who pressed long and "
      "rinsed late, and predict nothing about a patient; groups are not compared.");
  list.blocks = words.blocks;
  return list;
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
