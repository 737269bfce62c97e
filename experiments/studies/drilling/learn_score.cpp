#include "experiments/studies/drilling/learn_score.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "analysis/bone_drilling/report/ratings.h"
#include "core/base/definition/definition_changes.h"
#include "core/base/error.h"
#include "core/record/read/session_reader.h"
#include "experiments/studies/drilling/drilling_study.h"
#include "experiments/studies/drilling/expert_sessions.h"
#include "experiments/study/study_files.h"
#include "protocols/bone_drilling/bone_protocol.h"
#include "protocols/bone_drilling/definition/bone_definition.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;
namespace drilling = analysis::drilling;

/// Mean of a procedure's ratings; nothing if nobody rated it.
std::optional<double> mean_rating(const std::vector<drilling::Rating>& ratings,
                                  const drilling::ProcedureSummary& summary) {
  double sum = 0.0;
  double count = 0.0;
  for (const drilling::Rating& rating : ratings) {
    if (rating.session == summary.session && rating.procedure == summary.number) {
      sum += rating.score;
      count += 1.0;
    }
  }
  return count > 0.0 ? std::optional(sum / count) : std::nullopt;
}

/// Rated procedures of a session.
void add_session(const fs::path& file, const std::vector<drilling::Rating>& ratings,
                 ExpertSessions& sessions, std::vector<drilling::RatedSummary>& rated) {
  const std::size_t before = sessions.procedures().size();
  sessions.add(file);
  for (std::size_t n = before; n < sessions.procedures().size(); ++n) {
    const ExpertSession& each = sessions.procedures()[n];
    const drilling::ProcedureSummary& summary = each.procedure.summary;
    const auto rating = mean_rating(ratings, summary);
    if (rating && !each.left_out) {
      rated.push_back({summary, *rating});
    }
  }
}

void add_case(const fs::path& session, drilling::ScoreModel& model,
              const std::vector<drilling::RatedSummary>& rated) {
  const record::SessionInfo info = record::SessionReader(session).info();
  const auto definition = protocols::parse_bone_definition(info.definition, info.definition_name);
  model.study = definition.name;
  model.rules = score_rules(definition);
  std::set<const bone::BoneModel*> bones;
  for (const drilling::RatedSummary& each : rated) {
    if (bones.insert(each.summary.bone.get()).second) {
      model.bones.push_back(drilling::bone_digest(*each.summary.bone));
    }
  }
}

}  // namespace

std::map<std::string, std::string> score_rules(const protocols::BoneDefinition& d) {
  static const std::vector<std::string> kTables{"tools",       "cavity", "osteotomy",
                                                "forbidden",   "heat",   "bleeding",
                                                "soft_tissue", "pieces", "second_hand"};
  std::map<std::string, std::string> rules = definition_values(d.text, kTables);
  rules["drilling.time_limit"] = fmt::format("{:g} s", d.drilling.time_limit);
  rules["drilling.scale"] = fmt::format("{:g}", d.drilling.scale);
  rules["drilling.force_limit"] = fmt::format("{:g} N", d.drilling.force_limit);
  return rules;
}

drilling::ScoreModel learn_study_score(const fs::path& folder) {
  const fs::path table = folder / kRatingsFile;
  if (!fs::exists(table)) {
    throw InputError(fmt::format(
        "{}: holds no {}, so nothing is rated yet; haptrial rate import reads the raters' sheets",
        folder.string(), kRatingsFile));
  }
  const std::vector<drilling::Rating> ratings = drilling::load_ratings(table);
  const std::vector<fs::path> files = files_of_one_study(folder, protocols::bone_drilling());
  const drilling::SafeOptions options;
  drilling::StudyBones bones;
  ExpertSessions sessions(options, bones);
  std::vector<drilling::RatedSummary> rated;
  for (const fs::path& file : files) {
    require_drilling(file);
    add_session(file, ratings, sessions, rated);
  }
  const analysis::Defined<drilling::ScoreModel> learned = drilling::learn_score(rated);
  if (!learned) {
    throw InputError(fmt::format("{}: gives no score: {}", folder.string(), learned.because()));
  }
  drilling::ScoreModel model = *learned;
  std::set<std::string> raters;
  for (const drilling::Rating& rating : ratings) {
    raters.insert(rating.rater);
    model.simulated = model.simulated || rating.simulated;
  }
  model.raters = raters.size();
  add_case(files.front(), model, rated);
  return model;
}

namespace {

hint::SafeStructure limits_of(const drilling::SafeProfile& profile) {
  hint::SafeStructure structure{profile.structure, {}};
  for (const drilling::SafeBin& bin : profile.bins) {
    if (bin.force && bin.speed) {
      structure.intervals.push_back({bin.low, bin.high, bin.force->high, bin.speed->high});
    }
  }
  return structure;
}

std::string study_of(const std::filesystem::path& session) {
  const record::SessionInfo info = record::SessionReader(session).info();
  return protocols::parse_bone_definition(info.definition, info.definition_name).name;
}

}  // namespace

hint::SafeLimits learn_limits(const LimitsRequest& request) {
  if (request.experts.empty() && request.study.empty()) {
    throw InputError("nobody is named to learn from; name --study FOLDER or --expert SESSION");
  }
  const drilling::SafeOptions options;
  drilling::StudyBones bones;
  ExpertSessions sessions(options, bones);
  for (const std::filesystem::path& file : request.experts) {
    require_drilling(file);
    sessions.add(file);
  }
  if (!request.study.empty()) {
    sessions.add_study(request.study);
  }
  const drilling::Experts experts =
      drilling::experts_of(sessions.for_feedback(), /*without=*/"", options);
  hint::SafeLimits limits;
  limits.study = study_of(sessions.procedures().front().file);
  limits.participants = experts.participants.size();
  limits.procedures = experts.summaries.size();
  limits.share = options.high;
  limits.simulated = experts.simulated;
  for (const drilling::SafeProfile& profile : experts.profiles) {
    hint::SafeStructure structure = limits_of(profile);
    if (!structure.intervals.empty()) {
      limits.structures.push_back(std::move(structure));
    }
  }
  if (limits.structures.empty()) {
    throw InputError(fmt::format(
        "the experts' procedures have no {} removals in any interval of distance from a vital "
        "structure, so that nothing can be learned; name more of them",
        options.fewest));
  }
  return limits;
}

}  // namespace haptrial::experiments
