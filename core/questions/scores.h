#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/questions/page.h"

namespace haptrial::questions {

/// An answer to one item.
struct GivenAnswer {
  std::string item;
  double value{0.0};  // NaN: the answer is no number
  std::string text;
};

/// Mean of the six ratings of the NASA-TLX, 0 to 100; nothing unless all are there.
/// Source: Hart 2006 ("raw TLX").
std::optional<double> tlx_raw(const std::vector<GivenAnswer>& answers);

/// Ratings r weighted by how often each scale was chosen from the 15 pairs:
///
///     sum of w r / 15, the sum of the w being 15
///
/// Nothing unless all six ratings and all 15 choices are there.
/// Source: Hart and Staveland 1988.
std::optional<double> tlx_weighted(const std::vector<GivenAnswer>& answers);

/// The laterality quotient of the Edinburgh inventory, -100 (left) to 100 (right):
///
///     100 (R - L) / (R + L)
///
/// "always right" counts 2 for R, "right" 1, "either" 1 for both; left likewise; "never done"
/// nothing. Nothing without an activity that counts. Source: Oldfield 1971.
std::optional<double> laterality_quotient(const std::vector<GivenAnswer>& answers);

struct Score {
  std::string name;  // "raw", "weighted", "laterality quotient", or that of an item
  double value{0.0};
};

/// Scores of a page's answers: of known questionnaires, and of every item that is answered by a
/// number. Items without an answer, and answers that are none, have no score.
std::vector<Score> scores_of(const Page& page, const std::vector<GivenAnswer>& answers);

}  // namespace haptrial::questions
