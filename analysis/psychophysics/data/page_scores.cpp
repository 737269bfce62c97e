#include "analysis/psychophysics/data/page_scores.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

#include "analysis/psychophysics/data/trials_data.h"
#include "analysis/statistics/base/descriptive.h"
#include "core/questions/scores.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/answer_rows.h"

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

/// The answers to one page at one time of a session.
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

/// A participant's value: the mean, if the session has several files.
std::vector<double> values_by_participant(const PageSummary& summary,
                                          const std::vector<PageScore>& scores) {
  std::map<std::string, std::vector<double>> own;
  for (const PageScore& score : scores) {
    if (same(summary, score)) {
      own[score.participant].push_back(score.value);
    }
  }
  std::vector<double> values;
  for (const auto& [participant, each] : own) {
    values.push_back(moments(each)->mean());
  }
  return values;
}

}  // namespace

std::vector<PageScore> page_scores(const std::vector<std::filesystem::path>& files,
                                   const questions::PagePlan& plan, const GroupOf& group_of) {
  std::vector<PageScore> scores;
  if (plan.empty()) {
    return scores;
  }
  std::vector<std::int64_t> sessions;  // (scores)
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
        sessions.push_back(reader.info().session);
      }
    }
  }
  const bool several = std::ranges::any_of(sessions, [](auto session) { return session > 1; });
  for (std::size_t i = 0; several && i < scores.size(); ++i) {
    scores[i].when = fmt::format("session {}, {}", sessions[i], scores[i].when);
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
    const auto over_people = moments(values_by_participant(summary, scores));
    summary.count = over_people->count;
    summary.mean = over_people->mean();
    summary.deviation = summary.count > 1 ? std::sqrt(over_people->variance()) : kNotKnown;
  }
  return all;
}

}  // namespace haptrial::analysis::trials
