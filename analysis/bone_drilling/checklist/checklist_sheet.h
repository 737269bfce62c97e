#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/bone_drilling/checklist/checklist.h"

namespace haptrial::analysis::drilling {

/// A procedure that raters judge by a checklist, under a code.
struct CheckedItem {
  std::string code;
  std::string file;  // film (.mp4) or sheet of pictures (.png) beside the page
  std::vector<std::optional<int>> proposed;  // (items) points by the measures
};

/// The page in which a rater fills in the checklist beside each film: one HTML file that needs
/// nothing but the films and saves a table, NAME-checklist.csv: code, item, points.
std::string checklist_page(const Checklist& checklist, const std::vector<CheckedItem>& procedures);

/// A rater's points for all items of one procedure.
struct CheckedRow {
  std::string session;  // or the code, on a rater's sheet
  int procedure{1};
  std::string rater;
  std::vector<int> points;    // (items)
  std::vector<int> proposed;  // (items) by the measures; -1: none

  bool operator==(const CheckedRow&) const = default;
};

/// Whether a file is a sheet of checklist_page() by its columns.
bool is_checklist_sheet(const std::filesystem::path& file);
/// A rater's sheet, with codes for sessions; the rater's name is the file's, without "-checklist".
/// @throws InputError for the first line that is wrong: an unknown code or item, one twice or
/// missing, points out of bounds
std::vector<CheckedRow> read_checklist_sheet(const std::filesystem::path& file,
                                             const Checklist& checklist,
                                             const std::vector<std::string>& codes);

/// A table: session, procedure, rater, item, points, most, weight, proposed.
std::string checked_csv(const Checklist& checklist, const std::vector<CheckedRow>& rows);
/// @throws InputError for what checked_csv() does not write for this checklist, among it points or
/// weights of another version of it
std::vector<CheckedRow> load_checked(const std::filesystem::path& file, const Checklist& checklist);

}  // namespace haptrial::analysis::drilling
