#include "analysis/psychophysics/data/page_scores.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/questions/scores.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/page_answer.h"

namespace haptrial::analysis::trials {
namespace {

std::string time_word(const record::AnswerRow& row) {
  switch (row.when) {
    case record::PageTime::kBefore:
      return "before";
    case record::PageTime::kAfterBlock:
      return fmt::format("after block {}", row.block);
    case record::PageTime::kAfter:
      break;
  }
  return "after";
}

/// The answers to one page on one occasion.
struct Filled {
  std::string page, when;
  std::vector<questions::GivenAnswer> answers;
};

std::vector<Filled> filled_pages(const record::SessionReader& reader) {
  std::vector<Filled> all;
  const std::vector<record::AnswerRow> rows = reader.rows<record::AnswerRow>();
  const std::vector<bool> standing = record::standing_answers(rows);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!standing[i]) {
      continue;
    }
    const record::AnswerRow& row = rows[i];
    const std::string when = time_word(row);
    auto found = std::find_if(all.begin(), all.end(), [&](const Filled& each) {
      return each.page == row.questionnaire && each.when == when;
    });
    if (found == all.end()) {
      all.push_back({row.questionnaire, when, {}});
      found = all.end() - 1;
    }
    found->answers.push_back({row.item, row.value, row.text});
  }
  return all;
}

bool same(const PageSummary& summary, const PageScore& score) {
  return summary.page == score.page && summary.when == score.when && summary.score == score.score &&
         summary.group == score.group;
}

}  // namespace

std::vector<PageScore> page_scores(const std::vector<std::filesystem::path>& files,
                                   const questions::PagePlan& plan, const GroupOf& group_of) {
  std::vector<PageScore> scores;
  if (plan.empty()) {
    return scores;
  }
  for (const std::filesystem::path& file : files) {
    const record::SessionReader reader(file);
    const std::string& person = reader.info().subject;
    const std::string group = group_of ? group_of(person) : std::string();
    for (const Filled& filled : filled_pages(reader)) {
      const bool known =
          std::any_of(plan.pages.begin(), plan.pages.end(),
                      [&](const questions::Page& p) { return p.name == filled.page; });
      if (!known) {
        continue;
      }
      for (const questions::Score& score :
           questions::scores_of(plan.page(filled.page), filled.answers)) {
        scores.push_back({person, group, filled.page, filled.when, score.name, score.value});
      }
    }
  }
  return scores;
}

std::vector<PageSummary> summaries_of(const std::vector<PageScore>& scores) {
  std::vector<PageSummary> all;
  for (const PageScore& score : scores) {
    const bool known = std::any_of(all.begin(), all.end(),
                                   [&](const PageSummary& each) { return same(each, score); });
    if (!known) {
      all.push_back({score.page, score.when, score.score, score.group});
    }
  }
  for (PageSummary& summary : all) {
    std::vector<double> values;
    for (const PageScore& score : scores) {
      if (same(summary, score)) {
        values.push_back(score.value);
      }
    }
    const auto count = static_cast<double>(values.size());
    double sum = 0.0;
    for (const double value : values) {
      sum += value / count;
    }
    double squares = 0.0;
    for (const double value : values) {
      squares += (value - sum) * (value - sum);
    }
    summary.count = values.size();
    summary.mean = sum;
    summary.deviation = values.size() > 1 ? std::sqrt(squares / (count - 1.0))
                                          : std::numeric_limits<double>::quiet_NaN();
  }
  return all;
}

}  // namespace haptrial::analysis::trials
