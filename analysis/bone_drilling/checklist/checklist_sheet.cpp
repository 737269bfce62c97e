#include "analysis/bone_drilling/checklist/checklist_sheet.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "analysis/document/html.h"
#include "analysis/files/csv.h"
#include "analysis/files/delimited.h"
#include "core/base/error.h"

namespace haptrial::analysis::drilling {
namespace {

constexpr const char* kHead = R"html(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src 'self' data: file:; media-src 'self' file:">
<meta name="viewport" content="width=device-width, initial-scale=1">
<link rel="icon" href="data:,">
<title>Checklist</title>
<style>
body { font: 16px/1.4 sans-serif; max-width: 80rem; margin: 1rem auto; padding: 0 1rem; }
section { display: grid; grid-template-columns: minmax(16rem, 1fr) minmax(18rem, 1fr); gap: 1rem;
  border-top: 1px solid #888; padding: 1rem 0; }
section h2 { grid-column: 1 / -1; margin: 0; }
video, img { width: 100%; }
label { display: flex; justify-content: space-between; gap: 1rem; padding: 0.25rem 0; }
.open { background: #fff3cd; color: #222; }
#save { font-size: 1.1rem; padding: 0.4rem 1rem; }
@media (max-width: 45rem) { section { grid-template-columns: 1fr; } }
</style></head><body>
)html";

constexpr const char* kScript =
    R"html(<p><label for="rater">Your name <input id="rater" autocomplete="off"></label></p>
<p><button id="save" type="button">Save the sheet</button> <span id="told" role="status"></span></p>
<script>
"use strict";
const fields = [...document.querySelectorAll("select")];
const told = document.getElementById("told");
function mark(field) { field.parentElement.classList.toggle("open", field.value === ""); }
fields.forEach(field => { mark(field); field.addEventListener("change", () => mark(field)); });
document.getElementById("save").addEventListener("click", () => {
  const name = document.getElementById("rater").value.trim().replace(/[^\p{L}\p{N} _.-]/gu, "");
  const open = fields.filter(field => field.value === "");
  if (name === "") { told.textContent = "Write your name first."; return; }
  if (open.length > 0) {
    told.textContent = open.length + " items have no points yet; the first is shown.";
    open[0].focus();
    return;
  }
  const quoted = text => '"' + text.replaceAll('"', '""') + '"';
  const lines = fields.map(f => [quoted(f.dataset.code), quoted(f.dataset.item), f.value].join(","));
  const link = document.createElement("a");
  link.href = URL.createObjectURL(
      new Blob(["code,item,points\n" + lines.join("\n") + "\n"], {type: "text/csv"}));
  link.download = name + "-checklist.csv";
  link.click();
  told.textContent = "Saved as " + link.download + " in the folder of downloads.";
});
</script></body></html>
)html";

std::string field(const ChecklistItem& item, const CheckedItem& procedure,
                  const std::optional<int>& proposed) {
  std::string html = fmt::format(
      "<label><span>{}</span><select data-code=\"{}\" data-item=\"{}\">"
      "<option value=\"\"></option>",
      escape_html(item.text), escape_html(procedure.code), escape_html(item.name));
  for (int points = 0; points <= item.points; ++points) {
    const bool chosen = proposed && *proposed == points;
    html += fmt::format("<option value=\"{0}\"{1}>{0} of {2}{3}</option>", points,
                        chosen ? " selected" : "", item.points, chosen ? " (measured)" : "");
  }
  return html + "</select></label>\n";
}

std::string section(const Checklist& checklist, const CheckedItem& procedure) {
  const bool film = procedure.file.ends_with(".mp4");
  std::string html = fmt::format("<section><h2>{}</h2><div>", escape_html(procedure.code));
  html += film ? fmt::format("<video controls preload=\"metadata\" src=\"{}\"></video>",
                             escape_html(procedure.file))
               : fmt::format("<img alt=\"Moments of procedure {0}\" src=\"{1}\">",
                             escape_html(procedure.code), escape_html(procedure.file));
  html += "</div><div>\n";
  for (std::size_t n = 0; n < checklist.items.size(); ++n) {
    html += field(checklist.items[n], procedure, procedure.proposed.at(n));
  }
  return html + "</div></section>\n";
}

std::size_t item_at(const CsvTable& table, std::size_t row, std::size_t column,
                    const Checklist& checklist) {
  const std::string_view name = table.text(row, column);
  for (std::size_t n = 0; n < checklist.items.size(); ++n) {
    if (checklist.items[n].name == name) {
      return n;
    }
  }
  table.refuse(row, column, "an item of checklist \"" + checklist.name + "\"");
}

int points_at(const CsvTable& table, std::size_t row, std::size_t column, double value, int low,
              int most) {
  if (!(value >= low && value <= most) || value != std::floor(value)) {
    table.refuse(row, column, fmt::format("a whole number from {} to {}", low, most));
  }
  return static_cast<int>(value);
}

/// @throws InputError unless a table has what the checklist says now.
void require_as_rated(const CsvTable& table, std::size_t row, std::size_t column, double rated,
                      double now, const Checklist& checklist) {
  if (rated != now) {
    table.refuse(
        row, column,
        fmt::format("{:g}, as checklist \"{}\" has it; it was changed after the rating, so "
                    "restore it or rate anew",
                    now, checklist.name));
  }
}

CheckedRow& row_for(std::vector<CheckedRow>& rows, const CheckedRow& key, std::size_t items) {
  const auto at = std::find_if(rows.begin(), rows.end(), [&](const CheckedRow& each) {
    return each.session == key.session && each.procedure == key.procedure &&
           each.rater == key.rater;
  });
  if (at != rows.end()) {
    return *at;
  }
  rows.push_back(key);
  rows.back().points.assign(items, -1);
  rows.back().proposed.assign(items, -1);
  return rows.back();
}

void require_all(const std::vector<CheckedRow>& rows, const Checklist& checklist,
                 const std::string& file) {
  for (const CheckedRow& row : rows) {
    for (std::size_t n = 0; n < row.points.size(); ++n) {
      if (row.points[n] < 0) {
        throw InputError(
            fmt::format("{}: {} has no points for item \"{}\"; write a line for each "
                        "of the {} items",
                        file, row.session, checklist.items[n].name, checklist.items.size()));
      }
    }
  }
}

}  // namespace

std::string checklist_page(const Checklist& checklist, const std::vector<CheckedItem>& procedures) {
  std::string html = kHead;
  html += "<h1>" + escape_html(checklist.name) + "</h1>\n";
  html +=
      "<p>Judge each procedure by itself. Points that a measure proposes are chosen already and "
      "marked; change them where you see it otherwise. Coloured items have none yet.</p>\n";
  for (const CheckedItem& procedure : procedures) {
    html += section(checklist, procedure);
  }
  return html + kScript;
}

bool is_checklist_sheet(const std::filesystem::path& file) {
  const CsvTable table = CsvTable::load(file);
  return table.has("item") && table.has("points");
}

std::vector<CheckedRow> read_checklist_sheet(const std::filesystem::path& file,
                                             const Checklist& checklist,
                                             const std::vector<std::string>& codes) {
  constexpr std::string_view kEnding = "-checklist";
  const CsvTable table = CsvTable::load(file);
  std::string rater = file.stem().string();
  if (rater.ends_with(kEnding)) {
    rater.resize(rater.size() - kEnding.size());
  }
  const std::size_t code = table.column("code"), item = table.column("item");
  const std::size_t points = table.column("points");
  const std::vector<double> values = table.numbers(points);
  std::vector<CheckedRow> rows;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::string found(table.text(row, code));
    if (std::count(codes.begin(), codes.end(), found) == 0) {
      table.refuse(row, code, "a code of this study's page");
    }
    const std::size_t n = item_at(table, row, item, checklist);
    CheckedRow& own = row_for(rows, {found, 1, rater, {}, {}}, checklist.items.size());
    if (own.points[n] >= 0) {
      table.refuse(row, item, "each item once for a code");
    }
    own.points[n] = points_at(table, row, points, values[row], 0, checklist.items[n].points);
  }
  require_all(rows, checklist, file.string());
  if (rows.size() < codes.size()) {
    throw InputError(fmt::format("{}: has {} of the {} codes; rate every procedure of the page",
                                 file.string(), rows.size(), codes.size()));
  }
  return rows;
}

std::string checked_csv(const Checklist& checklist, const std::vector<CheckedRow>& rows) {
  std::string text = "session,procedure,rater,item,points,most,weight,proposed\n";
  for (const CheckedRow& each : rows) {
    for (std::size_t n = 0; n < checklist.items.size(); ++n) {
      const ChecklistItem& item = checklist.items[n];
      exchange::RowText row(text, exchange::Delimited::kCsv);
      row.add(std::string_view(each.session)).add(each.procedure);
      row.add(std::string_view(each.rater)).add(std::string_view(item.name));
      row.add(each.points.at(n)).add(item.points).add(item.weight).add(each.proposed.at(n)).end();
    }
  }
  return text;
}

std::vector<CheckedRow> load_checked(const std::filesystem::path& file,
                                     const Checklist& checklist) {
  constexpr int kMostProcedures = 999'999;
  const CsvTable table = CsvTable::load(file);
  const std::size_t session = table.column("session"), procedure = table.column("procedure");
  const std::size_t rater = table.column("rater"), item = table.column("item");
  const std::size_t points = table.column("points"), proposed = table.column("proposed");
  const std::vector<double> numbers = table.numbers(procedure), values = table.numbers(points);
  const std::vector<double> measured = table.numbers(proposed);
  const std::size_t full = table.column("most"), weight = table.column("weight");
  const std::vector<double> mosts = table.numbers(full), weights = table.numbers(weight);
  std::vector<CheckedRow> rows;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::size_t n = item_at(table, row, item, checklist);
    const int number = points_at(table, row, procedure, numbers[row], 1, kMostProcedures);
    CheckedRow& own = row_for(rows,
                              {std::string(table.text(row, session)),
                               number,
                               std::string(table.text(row, rater)),
                               {},
                               {}},
                              checklist.items.size());
    const int most = checklist.items[n].points;
    require_as_rated(table, row, full, mosts[row], most, checklist);
    require_as_rated(table, row, weight, weights[row], checklist.items[n].weight, checklist);
    own.points[n] = points_at(table, row, points, values[row], 0, most);
    own.proposed[n] = points_at(table, row, proposed, measured[row], -1, most);
  }
  require_all(rows, checklist, file.string());
  return rows;
}

}  // namespace haptrial::analysis::drilling
