#include "analysis/force_training/study/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

#include "analysis/force_training/score/path_places.h"
#include "analysis/force_training/score/score.h"
#include "analysis/force_training/study/quality_summary.h"
#include "analysis/force_training/study/recall_frequency.h"
#include "analysis/force_training/study/session_recalls.h"
#include "analysis/force_training/study/study_statistics.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/record/read/session_reader.h"

namespace haptrial::analysis {
namespace {

namespace fs = std::filesystem;

struct Session {
  fs::path file;
  SessionRecalls recalls;
  bool test{false};  // without training
};

std::vector<Session> read_all(const std::vector<fs::path>& files, const ScoreParameters& parameters,
                              int jobs) {
  std::vector<Session> sessions(files.size());
  const int workers = std::min(jobs, static_cast<int>(files.size()));
  parallel_for(files.size(), workers, [&](std::size_t i) {
    const record::SessionReader reader(files[i]);
    sessions[i] = {files[i], session_recalls(reader, parameters, jobs / workers)};
  });
  return sessions;
}

void sort_by_subject(std::vector<Session>& sessions) {
  const auto place = [](const Session& s) {
    const record::SessionInfo& info = s.recalls.summary.info;
    return std::pair(info.subject, info.session);
  };
  std::sort(sessions.begin(), sessions.end(), [&](const auto& a, const auto& b) {
    return place(a) != place(b) ? place(a) < place(b) : a.file < b.file;
  });
  const auto twin =
      std::adjacent_find(sessions.begin(), sessions.end(),
                         [&](const auto& a, const auto& b) { return place(a) == place(b); });
  if (twin != sessions.end()) {
    throw InputError(
        fmt::format("{} and {} are both of subject {}; keep one session file for each subject",
                    twin->file.string(), (twin + 1)->file.string(), place(*twin).first));
  }
}

// Origin of a score.
struct Origin {
  const Session* session{nullptr};
  const ScoredPass* pass{nullptr};
};

RecallPicture picture_of(const Origin& origin, const std::string& which,
                         const ScoreParameters& parameters) {
  const record::SessionReader reader(origin.session->file);
  const record::PassRow row = reader.passes().at(origin.pass->pass);
  const auto run = run_samples(reader, row);
  const auto places = path_places(reader, row.block, parameters);
  const auto curves = recall_curves(*run, reader.info().rate, places.get());
  return recall_picture(which, origin.pass->score,
                        score_recall_in_detail(curves->target, curves->applied, parameters));
}

std::vector<RecallPicture> pictures(const std::vector<Session>& sessions,
                                    const std::vector<TrialScore>& scores,
                                    const ScoreParameters& parameters) {
  std::vector<Origin> origins;  // one for each of scores
  for (const auto& session : sessions) {
    for (const auto& pass : session.recalls.scored) {
      if (!session.test) {
        origins.push_back({&session, &pass});
      }
    }
  }
  std::vector<RecallPicture> result;
  for (const auto& [which, at] : notable(scores)) {
    result.push_back(picture_of(origins[at], which, parameters));
  }
  return result;
}

/// Counts blocks over the sessions that train, as they follow each other.
void count_over_sessions(std::vector<TrialScore>& scores) {
  std::map<std::int32_t, std::int32_t> last;  // block of each session
  for (const TrialScore& score : scores) {
    last[score.session] = std::max(last[score.session], score.block);
  }
  for (TrialScore& score : scores) {
    for (const auto& [session, block] : last) {
      score.block += session < score.session ? block : 0;
    }
  }
}

}  // namespace

StudyResult analyze_study(const std::vector<fs::path>& session_files,
                          const ScoreParameters& parameters, int jobs, const AnalysisPlan& plan,
                          const std::vector<SessionOfStudy>& planned_sessions) {
  if (session_files.empty()) {
    throw InputError("there is no session file to analyse");
  }
  if (jobs < 1) {
    throw std::invalid_argument("analyze_study: jobs is below 1");
  }
  check(parameters);
  auto sessions = read_all(session_files, parameters, jobs);
  sort_by_subject(sessions);
  for (Session& session : sessions) {
    const std::size_t at = session.recalls.summary.info.session - 1;
    session.test = at < planned_sessions.size() && !planned_sessions[at].trains;
  }

  StudyResult study;
  study.planned_sessions = planned_sessions;
  std::vector<PassTracking> tracking;
  std::vector<RecallSpectrum> spectra;  // (scores)
  for (const auto& [file, recalls, test] : sessions) {
    study.sessions.push_back(recalls.summary);
    for (const auto& pass : recalls.scored) {
      if (test) {
        study.tests.push_back(pass.score);
      } else {
        study.scores.push_back(pass.score);
        spectra.push_back(pass.spectrum);
      }
    }
    study.exclusions.insert(study.exclusions.end(), recalls.exclusions.begin(),
                            recalls.exclusions.end());
    tracking.insert(tracking.end(), recalls.tracking.begin(), recalls.tracking.end());
  }
  count_over_sessions(study.scores);
  study.statistics = study_statistics(study.scores, questions_of(study.factors, plan, jobs));
  study.path = path_statistics(study.scores, questions_of(study.factors, plan, jobs));
  study.frequencies =
      recall_by_frequency(recalled_spectra(study.scores, spectra), study.statistics.conditions);
  study.tracking = summarize_tracking("all participants", tracking);
  study.recalls = pictures(sessions, study.scores, parameters);
  study.stimulus = sessions.front().recalls.stimulus;
  study.parameters = described(parameters);
  study.over_path = parameters.over_path;
  study.alarms = quality_alarms(judged_trials(study.scores, study.tests));
  return study;
}

}  // namespace haptrial::analysis
