#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "analysis/bone_drilling/metrics/metrics.h"

namespace haptrial::analysis::drilling {

/// One item of a checklist. A rater gives it from no point to the most; a measure may propose them.
struct ChecklistItem {
  std::string name;     // in tables, each once
  std::string text;     // for raters
  int points{1};        // the most >= 1
  double weight{1.0};   // of the item in the total > 0
  std::string measure;  // of quantity(); empty: only a rater says
  double none{0.0};     // value of the measure up to which there is no point
  double full{0.0};     // value from which there are all; below `none`: less is better
};

/// A course's own checklist of a procedure. Source: Morris 2006, §8.3.3.3.
struct Checklist {
  std::string name;
  std::vector<ChecklistItem> items;
};

/// Reads a checklist (TOML):
///
///     name = "Cortical mastoidectomy"
///     [[items]]
///     name = "cavity"
///     text = "The planned cavity is removed"
///     points = 3
///     weight = 2.0
///     measure = "planned_removed"   # a column of metrics.csv, without its unit
///     none = 60.0
///     full = 90.0
///
/// @throws InputError with a sentence for every mistake
Checklist load_checklist(const std::filesystem::path& file);

/// Checks that procedures have the measure of every item.
/// @throws InputError naming the first item without one, and the measures that may stand there
void check_measures(const Checklist& checklist, const ProcedureSummary& summary,
                    const std::string& file);

/// The points that an item's measure proposes: all from `full` on, none up to `none`, in between in
/// proportion, rounded to whole points. Nothing where no measure or value is.
std::optional<int> proposed_points(const ChecklistItem& item, const ProcedureSummary& summary);

/// Weighted share of all points, in percent. @param points  (items)
double total_of(const Checklist& checklist, const std::vector<int>& points);

/// A section of a page, as HTML: each item and what its measure proposes. @param checklist  with
/// items
std::string checklist_section(const Checklist& checklist, const ProcedureSummary& summary);

}  // namespace haptrial::analysis::drilling
