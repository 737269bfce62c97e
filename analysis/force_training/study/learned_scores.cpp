#include "analysis/force_training/study/learned_scores.h"

#include <algorithm>
#include <array>

#include "analysis/files/delimited.h"
#include "analysis/force_training/study/study_result.h"

namespace haptrial::analysis {
namespace {

struct ScoreOutcome {
  const char* name;
  const char* title;
  const char* unit;
  double TrialScore::*value;
};

using S = TrialScore;

constexpr std::array<ScoreOutcome, 5> kOutcomes{{
    {"score", "recall error", "1", &S::score},
    {"alignment_cost", "cost of the alignment", "1", &S::alignment_cost},
    {"rms_force", "difference of forces after the alignment", "N", &S::rms_force},
    {"rms_slope", "difference of slopes after the alignment", "N/s", &S::rms_slope},
    {"rms_unaligned", "difference of forces before the alignment", "N", &S::rms_unaligned},
}};

/// Visits the scores of sessions that train, then those of tests.
template <class Visit>
void for_each_score(const StudyResult& study, const Visit& visit) {
  for (const auto* scores : {&study.scores, &study.tests}) {
    for (const TrialScore& score : *scores) {
      visit(score, study.planned_sessions.at(static_cast<std::size_t>(score.session - 1)));
    }
  }
}

std::string group_of(const StudyResult& study, const TrialScore& score) {
  const auto group = study.groups.find(score.subject);
  return group == study.groups.end() ? std::string() : group->second;
}

}  // namespace

LearningOutcomes score_outcomes() {
  std::vector<std::string> names;
  for (const ScoreOutcome& outcome : kOutcomes) {
    names.emplace_back(outcome.name);
  }
  return {names, [](std::string_view name) {
            return std::ranges::any_of(kOutcomes, [&](const auto& o) { return o.name == name; });
          }};
}

std::vector<LearningQuantity> learned_scores(const StudyResult& study,
                                             const std::vector<std::string>& outcomes) {
  std::vector<LearningQuantity> quantities;
  for (const std::string& name : outcomes) {
    const auto* known =
        std::ranges::find_if(kOutcomes, [&](const auto& o) { return o.name == name; });
    LearningQuantity& quantity = quantities.emplace_back();
    quantity = {known->name, known->title, known->unit, {}};
    for_each_score(study, [&](const TrialScore& score, const SessionOfStudy& session) {
      quantity.values.push_back(
          {score.subject, {group_of(study, score), session.name}, score.*known->value});
    });
  }
  return quantities;
}

std::string session_scores_csv(const StudyResult& study) {
  std::string text = "subject,group,session_number,session_name,trial,block,repetition,condition";
  for (const ScoreOutcome& outcome : kOutcomes) {
    text += std::string(",") + outcome.name;
  }
  text += "\n";
  exchange::RowText row(text, exchange::Delimited::kCsv);
  for_each_score(study, [&](const TrialScore& s, const SessionOfStudy& session) {
    row.add(s.subject).add(group_of(study, s)).add(s.session).add(session.name);
    row.add(s.trial).add(s.block).add(s.repetition).add(s.condition);
    for (const ScoreOutcome& outcome : kOutcomes) {
      row.add(s.*outcome.value);
    }
    row.end();
  });
  return text;
}

}  // namespace haptrial::analysis
