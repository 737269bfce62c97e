#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "analysis/psychophysics/data/read_trials.h"
#include "core/questions/page.h"

namespace haptrial::analysis::trials {

/// Score of a participant's answers to a page.
struct PageScore {
  std::string participant;
  std::string group;  // empty: the study has none
  std::string page;
  std::string when;   // "before", "after block 2"; of several sessions "session 2, before"
  std::string score;  // "raw", "laterality quotient", or an item
  double value{0.0};
};

/// The same score over participants.
struct PageSummary {
  std::string page, when, score;
  std::string group;  // empty: the study has none
  std::size_t count{0};
  double mean{0.0};
  double deviation{0.0};  // standard deviation; NaN of a single participant
};

/// The scores of every session with answers, in the order of files and pages.
/// @throws InputError naming a file that is damaged.
std::vector<PageScore> page_scores(const std::vector<std::filesystem::path>& files,
                                   const questions::PagePlan& plan, const GroupOf& group_of);

/// Mean and standard deviation over participants for each time and group, in the order of first
/// occurrence.
std::vector<PageSummary> summaries_of(const std::vector<PageScore>& scores);

}  // namespace haptrial::analysis::trials
