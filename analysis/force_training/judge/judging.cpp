#include <fmt/format.h>

#include <cmath>
#include <map>

#include "analysis/force_training/judge/judged_curves.h"

namespace haptrial::analysis {
namespace {

JudgeConsistency consistency_of(const std::string& judge, const std::vector<SheetCurve>& key,
                                const std::vector<double>& judged) {
  JudgeConsistency result{.judge = judge};
  std::vector<double> first, second;
  for (std::size_t i = 0; i < key.size(); ++i) {
    if (key[i].first > 0) {
      first.push_back(judged[static_cast<std::size_t>(key[i].first) - 1]);
      second.push_back(judged[i]);
      result.difference += std::abs(first.back() - second.back());
    }
  }
  result.repeated = first.size();
  result.difference /= std::max<double>(1.0, static_cast<double>(first.size()));
  Eigen::MatrixXd pairs(static_cast<Eigen::Index>(first.size()), 2);
  for (std::size_t i = 0; i < first.size(); ++i) {
    pairs.row(static_cast<Eigen::Index>(i)) << first[i], second[i];
  }
  const auto found = intraclass_correlation(pairs);
  result.agreement = found ? found->one_way : Defined<IntraclassForm>(Undefined{found.because()});
  return result;
}

std::string form_words(const Defined<IntraclassForm>& form) {
  return form ? fmt::format("{:.2f} [{:.2f}, {:.2f}]", form->value, form->low, form->high)
              : "not defined, because " + form.because();
}

}  // namespace

Judging judging_of(const std::vector<SheetCurve>& key, const std::vector<std::string>& judges,
                   const std::vector<std::vector<double>>& judgements, std::uint64_t seed) {
  Judging result;
  std::vector<std::size_t> firsts, people;
  std::map<std::string, std::size_t> numbers;
  for (std::size_t i = 0; i < key.size(); ++i) {
    if (key[i].first == 0) {
      firsts.push_back(i);
      people.push_back(numbers.emplace(key[i].subject, numbers.size()).first->second);
    }
  }
  const auto rows = static_cast<Eigen::Index>(firsts.size());
  Eigen::MatrixXd judged(rows, static_cast<Eigen::Index>(judges.size()));
  Eigen::MatrixX3d parts(rows, 3);
  std::vector<double> means;
  for (Eigen::Index row = 0; row < rows; ++row) {
    const std::size_t at = firsts[static_cast<std::size_t>(row)];
    parts.row(row) << key[at].alignment_cost, key[at].rms_force, key[at].rms_slope;
    for (std::size_t j = 0; j < judges.size(); ++j) {
      judged(row, static_cast<Eigen::Index>(j)) = judgements[j][at];
    }
    means.push_back(judged.row(row).mean());
  }
  for (std::size_t j = 0; j < judges.size(); ++j) {
    result.judges.push_back(consistency_of(judges[j], key, judgements[j]));
  }
  if (judges.size() > 1) {
    result.agreement = intraclass_correlation(judged);
  }
  result.skill = fit_skill(parts, means, people, seed);
  return result;
}

Document judging_report(const Judging& judging, bool simulated) {
  Document page;
  page.title = "Judgements of recalled curves";
  page.simulated = simulated;
  if (simulated) {
    page.alarm("SIMULATED: the participants whose curves were judged are programs.");
  }
  page.heading("Agreement of judges");
  page.paragraph(fmt::format(
      "Intraclass correlation of one judge, agreement, ICC(2,1), with its 95 % interval over "
      "curves: {}. Curves of a participant depend on each other, so that the interval is somewhat "
      "too narrow.",
      judging.agreement ? form_words(judging.agreement->random_raters)
                        : "not defined, because " + judging.agreement.because()));
  std::vector<std::vector<std::string>> rows;
  for (const JudgeConsistency& each : judging.judges) {
    rows.push_back({each.judge, fmt::format("{}", each.repeated),
                    fmt::format("{:.2f}", each.difference), form_words(each.agreement)});
  }
  page.table({"judge", "curves that came twice", "mean difference of the two (points)",
              "agreement with oneself, ICC(1,1) [95 %]"},
             rows);
  page.heading("Shares of the score");
  if (!judging.skill) {
    page.paragraph(fmt::format("Not defined, because {}.", judging.skill.because()));
    return page;
  }
  const SkillFit& skill = *judging.skill;
  page.points({skill.verdict});
  page.paragraph(
      fmt::format("R² of {} curves, each participant of {} predicted from the others: {:.3f}, 95 % "
                  "CI {:.3f} to "
                  "{:.3f} over participants; p = {:.3f} by 999 shuffles of the judgements, of "
                  "participants' means and within participants.",
                  skill.curves, skill.people, skill.r_squared, skill.low, skill.high, skill.p));
  if (!skill.predicts) {
    return page;
  }
  std::vector<std::vector<std::string>> shares;
  for (std::size_t j = 0; j < kScoreParts.size(); ++j) {
    const JudgedShare& share = skill.shares[j];
    shares.push_back({kScoreParts[j], fmt::format("{:.3f}", share.value),
                      fmt::format("{:.3f} to {:.3f}", share.low, share.high)});
  }
  page.table({"share", "fitted", "95 % CI over participants"}, shares);
  page.paragraph(
      "Judgements, meant over judges, are fitted by a constant minus the parts of the score times "
      "shares of at least 0 (least squares); shares are stated so that their sum is 1, since their "
      "scale is that of the judgements. Source: Morris 2006, §4.3, where they were set by eye.");
  return page;
}

std::string judged_weights(const SkillFit& skill) {
  std::string text = fmt::format(
      "# Shares of the score by judgements of {} curves of {} participants: cross-validated R² "
      "{:.3f}\n# (95 % CI {:.3f} to {:.3f}). {}\n[analysis]\n",
      skill.curves, skill.people, skill.r_squared, skill.low, skill.high, skill.verdict);
  for (std::size_t j = 0; j < kScoreParts.size(); ++j) {
    text += fmt::format("{} = {:.4f}  # {:.4f} to {:.4f}\n", kScoreParts[j], skill.shares[j].value,
                        skill.shares[j].low, skill.shares[j].high);
  }
  return text;
}

}  // namespace haptrial::analysis
