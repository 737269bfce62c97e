#include "analysis/bone_drilling/checklist/checklist.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "analysis/document/html.h"
#include "core/base/definition/schema.h"
#include "core/base/error.h"

namespace haptrial::analysis::drilling {
namespace {

const Schema<ChecklistItem>& item_schema() {
  using I = ChecklistItem;
  constexpr Bounds kAny{-1e9, 1e9};
  static const auto schema =
      Schema<I>()
          .text("name", &I::name, "Name of the item in tables")
          .required()
          .text("text", &I::text, "Question or statement for the rater")
          .required()
          .integer("points", &I::points, 1, 10, "Greatest number of points")
          .number("weight", &I::weight, {0.0, 1000.0, true}, "", "Weight of the item in the total")
          .text("measure", &I::measure, "Quantity of metrics.csv that proposes the points")
          .otherwise("none")
          .number("none", &I::none, kAny, "", "Value of the measure up to which no point is given")
          .number("full", &I::full, kAny, "",
                  "Value of the measure from which all points are given")
          .check([](Table& table, I& item) {
            if (item.measure.empty() && (table.has("none") || table.has("full"))) {
              table.reject("none", "or full stands without a measure; name it or leave them out");
            }
            if (!item.measure.empty() && item.none == item.full) {
              table.reject("full", fmt::format("{}, as none", item.full),
                           "another value than none");
            }
          });
  return schema;
}

}  // namespace

Checklist load_checklist(const std::filesystem::path& file) {
  Table root = Table::load(file);
  Checklist checklist;
  checklist.name = root.text("name");
  std::set<std::string> names;
  for (Table& each : root.tables("items")) {
    checklist.items.push_back(item_schema().read(each));
    if (!names.insert(checklist.items.back().name).second) {
      each.reject("name", fmt::format("\"{}\"", checklist.items.back().name),
                  "a name that no other item has");
    }
  }
  if (checklist.items.empty()) {
    root.reject("items", "is missing; write a table [[items]] for each item");
  }
  root.finish();
  return checklist;
}

void check_measures(const Checklist& checklist, const ProcedureSummary& summary,
                    const std::string& file) {
  const std::vector<std::string> known = quantity_names(summary);
  for (const ChecklistItem& item : checklist.items) {
    if (!item.measure.empty() && std::count(known.begin(), known.end(), item.measure) == 0) {
      throw InputError(fmt::format("{}: measure of item \"{}\" is \"{}\"; allowed: {}", file,
                                   item.name, item.measure, fmt::join(known, ", ")));
    }
  }
}

std::optional<int> proposed_points(const ChecklistItem& item, const ProcedureSummary& summary) {
  const auto value = item.measure.empty() ? std::nullopt : judged_quantity(summary, item.measure);
  if (!value) {
    return std::nullopt;
  }
  const double share = std::clamp((*value - item.none) / (item.full - item.none), 0.0, 1.0);
  constexpr double kRounding = 1e-9;  // of a share that is a whole number of points
  return static_cast<int>(std::floor(share * item.points + kRounding));
}

double total_of(const Checklist& checklist, const std::vector<int>& points) {
  double sum = 0.0, all = 0.0;
  for (std::size_t n = 0; n < checklist.items.size(); ++n) {
    const ChecklistItem& item = checklist.items[n];
    sum += item.weight * points.at(n) / item.points;
    all += item.weight;
  }
  return 100.0 * sum / all;
}

std::string checklist_section(const Checklist& checklist, const ProcedureSummary& summary) {
  std::vector<std::vector<std::string>> rows;
  for (const ChecklistItem& item : checklist.items) {
    const auto points = proposed_points(item, summary);
    const double value =
        item.measure.empty() ? NAN : judged_quantity(summary, item.measure).value_or(NAN);
    rows.push_back({item.text, points ? std::to_string(*points) : "a rater says",
                    std::to_string(item.points), item.measure,
                    std::isnan(value)   ? "-"
                    : std::isinf(value) ? "beyond what is measured"
                                        : fmt::format("{:.4g}", value)});
  }
  return "<h2>" + escape_html("Checklist: " + checklist.name) + "</h2>\n" +
         html_table({"item", "points", "of", "by the measure", "its value"}, rows) +
         "<p>Points are what a measure proposes; a rater may see it otherwise.</p>\n";
}

}  // namespace haptrial::analysis::drilling
