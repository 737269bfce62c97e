#include "analysis/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <thread>

#include "analysis/score.h"
#include "analysis/session_recalls.h"
#include "core/base/error.h"
#include "core/record/session_reader.h"

namespace haptrial::analysis {
namespace {

namespace fs = std::filesystem;

struct Session {
  fs::path file;
  SessionRecalls recalls;
};

std::vector<Session> read_all(const std::vector<fs::path>& files, const ScoreParameters& parameters,
                              int jobs) {
  std::vector<Session> sessions(files.size());
  std::vector<std::exception_ptr> failures(files.size());
  const int workers = std::min(jobs, static_cast<int>(files.size()));
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i; (i = next.fetch_add(1)) < files.size();) {
      try {
        const record::SessionReader reader(files[i]);
        sessions[i] = {files[i], session_recalls(reader, parameters, jobs / workers)};
      } catch (...) {
        failures[i] = std::current_exception();
      }
    }
  };
  {
    std::vector<std::jthread> threads;
    for (int k = 1; k < workers; ++k) {
      threads.emplace_back(work);
    }
    work();
  }
  for (const auto& failure : failures) {
    if (failure) {
      std::rethrow_exception(failure);
    }
  }
  return sessions;
}

void sort_by_subject(std::vector<Session>& sessions) {
  const auto subject = [](const Session& s) -> const std::string& {
    return s.recalls.summary.info.subject;
  };
  std::sort(sessions.begin(), sessions.end(), [&](const auto& a, const auto& b) {
    return subject(a) != subject(b) ? subject(a) < subject(b) : a.file < b.file;
  });
  const auto twin =
      std::adjacent_find(sessions.begin(), sessions.end(),
                         [&](const auto& a, const auto& b) { return subject(a) == subject(b); });
  if (twin != sessions.end()) {
    throw InputError(
        fmt::format("{} and {} are both of subject {}; allowed: one session file for each subject",
                    twin->file.string(), (twin + 1)->file.string(), subject(*twin)));
  }
}

// Where a score came from.
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
  auto detail = score_recall_in_detail(curves->target, curves->applied, parameters);
  RecallPicture picture{which,
                        origin.pass->score,
                        detail.time.duration,
                        std::move(detail.target),
                        std::move(detail.applied),
                        std::move(detail.warped)};
  for (const auto& point : detail.path) {
    picture.pairs.emplace_back(point.target, point.applied);
  }
  return picture;
}

// Best, median (the lower of two) and worst; of equal scores the first.
std::vector<RecallPicture> pictures(const std::vector<Session>& sessions,
                                    const ScoreParameters& parameters) {
  std::vector<Origin> origins;
  for (const auto& session : sessions) {
    for (const auto& pass : session.recalls.scored) {
      origins.push_back({&session, &pass});
    }
  }
  if (origins.empty()) {
    return {};
  }
  std::stable_sort(origins.begin(), origins.end(), [](const Origin& a, const Origin& b) {
    return a.pass->score.score < b.pass->score.score;
  });
  return {picture_of(origins.front(), "best", parameters),
          picture_of(origins[(origins.size() - 1) / 2], "median", parameters),
          picture_of(origins.back(), "worst", parameters)};
}

std::vector<std::pair<std::string, std::string>> parameter_rows(const ScoreParameters& p) {
  std::vector<std::pair<std::string, std::string>> rows;
  if (p.over_path) {
    rows.emplace_back("forces are compared over",
                      "the place on the path, as the time that it takes at the definition's speed");
  }
  const std::vector<std::pair<std::string, std::string>> numbers{
      {"samples of the common time base", fmt::format("{}", p.samples)},
      {"box filter on the applied force", fmt::format("{} s", p.filter_width)},
      {"error matrix: weight of force", fmt::format("{}", p.alignment.force_weight)},
      {"error matrix: weight of slope", fmt::format("{}", p.alignment.slope_weight)},
      {"error matrix: power", fmt::format("{}", p.alignment.power)},
      {"penalty of a step along one curve", fmt::format("{}", p.alignment.penalty)},
      {"score: share of the alignment cost", fmt::format("{}", p.cost_share)},
      {"score: share of the force difference", fmt::format("{} /N", p.force_share)},
      {"score: share of the slope difference", fmt::format("{} s/N", p.slope_share)}};
  rows.insert(rows.end(), numbers.begin(), numbers.end());
  return rows;
}

}  // namespace

StudyResult analyze_study(const std::vector<fs::path>& session_files,
                          const ScoreParameters& parameters, int jobs) {
  if (session_files.empty()) {
    throw InputError("there is no session file to analyse; allowed: one or more");
  }
  if (jobs < 1) {
    throw std::invalid_argument("analyze_study: jobs is below 1");
  }
  check(parameters);
  auto sessions = read_all(session_files, parameters, jobs);
  sort_by_subject(sessions);

  StudyResult study;
  std::vector<PassTracking> tracking;
  for (const auto& [file, recalls] : sessions) {
    study.sessions.push_back(recalls.summary);
    for (const auto& pass : recalls.scored) {
      study.scores.push_back(pass.score);
    }
    study.exclusions.insert(study.exclusions.end(), recalls.exclusions.begin(),
                            recalls.exclusions.end());
    tracking.insert(tracking.end(), recalls.tracking.begin(), recalls.tracking.end());
  }
  study.statistics = study_statistics(study.scores);
  study.tracking = summarize_tracking("all participants", tracking);
  study.recalls = pictures(sessions, parameters);
  study.stimulus = sessions.front().recalls.stimulus;
  study.parameters = parameter_rows(parameters);
  study.over_path = parameters.over_path;
  return study;
}

}  // namespace haptrial::analysis
