#include "analysis/bone_drilling/report/crossing_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "analysis/bone_drilling/metrics/procedure.h"
#include "analysis/files/delimited.h"
#include "core/base/counted.h"
#include "core/base/definition/table.h"
#include "core/bone/region/forbidden_region.h"
#include "core/bone/region/region_setup.h"
#include "core/record/read/session_reader.h"

namespace haptrial::analysis::drilling {
namespace {

/// Sum over the procedures of one condition.
struct CrossingSum {
  int procedures{0};
  double minutes{0.0};  // of drilling
  int count{0};
  double time{0.0};     // [s]
  double deepest{0.0};  // [m]
};

/// Adds the crossings that began in a pass.
void add_rows(const std::vector<record::CrossingRow>& rows, const record::PassRow& pass,
              double rate, const bone::BoneModel& bone, CrossingProcedure& p) {
  for (const record::CrossingRow& row : rows) {
    if (row.begin < pass.first_sample || row.begin > pass.last_sample) {
      continue;
    }
    const std::string& name = bone.structures.at(row.label).name;
    auto at = std::find_if(p.structures.begin(), p.structures.end(),
                           [&](const Crossings& each) { return each.structure == name; });
    if (at == p.structures.end()) {
      at = p.structures.insert(at, {name, 0, 0.0, 0.0});
    }
    ++at->count;
    at->time += static_cast<double>(row.sequence - row.begin + 1) / rate;
    at->deepest = std::max(at->deepest, row.depth);
  }
}

std::map<std::string, CrossingSum> sums_of(std::span<const CrossingProcedure> procedures) {
  std::map<std::string, CrossingSum> sums;
  for (const CrossingProcedure& p : procedures) {
    CrossingSum& sum = sums[p.condition];
    ++sum.procedures;
    sum.minutes += p.drilling / 60.0;
    for (const Crossings& each : p.structures) {
      sum.count += each.count;
      sum.time += each.time;
      sum.deepest = std::max(sum.deepest, each.deepest);
    }
  }
  return sums;
}

/// Crossings a minute of drilling of each procedure.
std::vector<GivenValue> rates_of(std::span<const CrossingProcedure> procedures) {
  std::vector<GivenValue> rates;
  for (const CrossingProcedure& p : procedures) {
    rates.push_back(
        {p.participant, p.given,
         p.drilling > 0.0 ? std::optional(60.0 * p.count() / p.drilling) : std::nullopt});
  }
  return rates;
}

}  // namespace

int CrossingProcedure::count() const {
  int sum = 0;
  for (const Crossings& each : structures) {
    sum += each.count;
  }
  return sum;
}

/// Whether a session's definition has regions: a repaired file has empty tables of others, too.
static bool has_regions(const record::SessionReader& file) {
  const record::SessionInfo& info = file.info();
  return file.has(record::table_of<record::CrossingRow>()) &&
         Table::parse(info.definition, info.definition_name).has("forbidden");
}

std::vector<CrossingProcedure> load_crossings(const record::SessionReader& file,
                                              std::span<const ProcedureSummary> summaries) {
  if (!has_regions(file)) {
    return {};
  }
  const auto rows = file.rows<record::CrossingRow>();
  const auto passes = counted_passes(file);
  std::vector<CrossingProcedure> procedures;
  for (const ProcedureSummary& summary : summaries) {
    const std::vector<CountedPass>& own = passes.at(summary.number);
    CrossingProcedure p{given_procedure(summary, own.back().pass.condition, bone::kRegions), {}};
    for (const CountedPass& each : own) {
      add_rows(rows, each.pass, file.info().rate, *summary.bone, p);
    }
    procedures.push_back(std::move(p));
  }
  return procedures;
}

std::string crossings_csv(std::span<const CrossingProcedure> procedures) {
  std::string text =
      "session,participant,group,procedure,simulated,condition,given,drilling_s,structure,"
      "crossings,time_s,deepest_mm\n";
  for (const CrossingProcedure& p : procedures) {
    std::vector<Crossings> structures = p.structures;
    if (structures.empty()) {
      structures.emplace_back();
    }
    for (const Crossings& each : structures) {
      exchange::RowText row(text, exchange::Delimited::kCsv);
      row.add(std::string_view(p.session)).add(std::string_view(p.participant));
      row.add(std::string_view(p.group)).add(p.number).add(p.simulated ? 1 : 0);
      row.add(std::string_view(p.condition)).add(p.given ? 1 : 0).add(p.drilling);
      row.add(std::string_view(each.structure)).add(each.count).add(each.time);
      row.add(1e3 * each.deepest).end();
    }
  }
  return text;
}

FindingList crossing_findings(std::span<const CrossingProcedure> procedures) {
  FindingList list{.name = "forbidden_regions", .heading = "Forbidden regions"};
  if (procedures.empty()) {
    return list;
  }
  FindingTable& table = list.tables.emplace_back("conditions", "");
  for (const auto& [condition, sum] : sums_of(procedures)) {
    table.rows.push_back(
        {plain_finding("condition", "condition", condition),
         plain_finding("procedures", "procedures", sum.procedures),
         plain_finding("drilling_min", "drilling", sum.minutes, "min"),
         plain_finding("crossings", "crossings", sum.count),
         plain_finding("crossings_per_minute", "crossings a minute of drilling",
                       sum.minutes > 0.0 ? sum.count / sum.minutes : FindingValue(), "1/min"),
         plain_finding("time_s", "time in regions", sum.time, "s"),
         plain_finding("deepest_mm", "deepest", 1e3 * sum.deepest, "mm")});
  }
  if (const std::vector<GivenValue> rates = rates_of(procedures); has_both(rates)) {
    list.findings = difference_findings("crossings_per_minute", "crossings a minute of drilling",
                                        "1/min", with_less_without(rates));
  }
  Document words;
  words.paragraph(
      "A crossing begins where a burr, turning or not, comes nearer to a structure than its "
      "margin, and ends where it has left. Crossings are recorded whether the participant felt or "
      "heard the regions or not. Differences are of participants' means.");
  list.blocks = words.blocks;
  return list;
}

std::vector<std::string> crossing_lines(std::span<const CrossingProcedure> procedures) {
  std::vector<std::string> lines;
  for (const auto& [condition, sum] : sums_of(procedures)) {
    lines.push_back(fmt::format("{}: {} of forbidden regions in {}, {:.1f} min of drilling",
                                condition, counted(sum.count, "crossing", "crossings"),
                                counted(sum.procedures, "procedure", "procedures"), sum.minutes));
  }
  return lines;
}

}  // namespace haptrial::analysis::drilling
