#include "analysis/force_training/exchange/import_curves.h"

#include <fmt/format.h>

#include "analysis/force_training/exchange/import_checks.h"
#include "analysis/force_training/exchange/import_trials.h"
#include "analysis/force_training/score/score.h"
#include "analysis/force_training/study/recall_frequency.h"
#include "analysis/force_training/study/study_statistics.h"
#include "core/base/error.h"

namespace haptrial::exchange {
namespace {

analysis::RecallDetail aligned(const ImportedCurves& curves, const std::string& place,
                               const analysis::ScoreParameters& parameters) {
  try {
    return analysis::align_curves(curves.target.view(), curves.applied.view(), parameters);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", place, error.what()));
  }
}

void add_subjects(analysis::StudyResult& result, const std::vector<ImportedTrial>& trials) {
  for (const auto& trial : trials) {
    auto& sessions = result.sessions;
    if (sessions.empty() || sessions.back().info.subject != trial.score.subject) {
      sessions.emplace_back();
      sessions.back().file = result.curves_from;
      sessions.back().info.subject = trial.score.subject;
      sessions.back().info.simulated = false;
    }
    auto& session = sessions.back();
    session.info.simulated = session.info.simulated || trial.simulated;
    ++session.test_passes;
    ++session.scored;
  }
}

}  // namespace

analysis::StudyResult analyze_curves(const CurveStudy& study,
                                     const analysis::ScoreParameters& parameters, int jobs,
                                     const Watch& watch) {
  check(parameters);
  const auto found = read_trials(study);
  std::vector<ImportedTrial> trials = found->trials();
  std::vector<TrialLook> looks(trials.size());
  std::vector<analysis::RecallSpectrum> spectra(trials.size());
  share_out(
      trials.size(), jobs,
      [&](std::size_t i, Counter& counter) {
        const ImportedCurves curves = found->curves(i);
        const auto detail = aligned(curves, found->place(i), parameters);
        fill(trials[i].score, detail.score);
        looks[i] = look_at(curves, detail);
        spectra[i] = analysis::recall_spectrum(curves.target.view(), curves.applied.view());
        counter.add(1);
        counter.check();
      },
      watch);
  analysis::StudyResult result;
  result.curves_from = study.table.filename().string();
  result.factors = found->factors();
  for (const auto& trial : trials) {
    result.scores.push_back(trial.score);
  }
  add_subjects(result, trials);
  result.statistics =
      study_statistics(result.scores, questions_of(result.factors, study.plan, jobs));
  result.frequencies = analysis::recall_over_time(
      analysis::recalled_spectra(result.scores, spectra), result.statistics.conditions);
  for (const auto& [which, at] : analysis::notable(result.scores)) {
    result.recalls.push_back(recall_picture(
        which, result.scores[at], aligned(found->curves(at), found->place(at), parameters)));
  }
  result.parameters = described(parameters);
  result.remarks = import_warnings(*found, looks);
  return result;
}

}  // namespace haptrial::exchange
