#include "experiments/studies/drilling/trainee_pages.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "analysis/bone_drilling/checklist/checklist.h"
#include "analysis/bone_drilling/feedback/curriculum_page.h"
#include "analysis/bone_drilling/feedback/procedure_page.h"
#include "analysis/bone_drilling/feedback/score.h"
#include "analysis/bone_drilling/feedback/trainee_page.h"
#include "analysis/bone_drilling/report/visibility_picture.h"
#include "core/base/error.h"
#include "core/base/exception_words.h"
#include "core/base/file_text.h"
#include "core/base/whole_file.h"
#include "core/bone/record/drilling_tables.h"
#include "core/record/read/session_reader.h"
#include "experiments/studies/drilling/drilling_curriculum.h"
#include "experiments/studies/drilling/expert_sessions.h"
#include "experiments/studies/drilling/learn_phases.h"
#include "experiments/studies/drilling/learn_score.h"
#include "experiments/studies/drilling/procedure_setup.h"
#include "experiments/study/study_run.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;
namespace drilling = analysis::drilling;

/// A session file as pages use it.
struct Session {
  explicit Session(const fs::path& file) : path(file), reader(file) {
    const record::SessionInfo& info = reader.info();
    definition = protocols::parse_bone_definition(info.definition, info.definition_name);
  }

  fs::path path;
  record::SessionReader reader;
  protocols::BoneDefinition definition;
};

drilling::SafeOptions options_for(const TraineeRequest& request) {
  drilling::SafeOptions options;
  if (!request.phases.empty()) {
    options.phases = phases_by(request.phases);
  }
  return options;
}

class Pages {
 public:
  explicit Pages(const TraineeRequest& request)
      : request_(request), options_(options_for(request)) {}

  std::vector<fs::path> written() {
    load_sessions();
    load_experts();
    if (!request_.score.empty()) {
      score_ = drilling::read_score_model(request_.score);
    }
    if (!request_.checklist.empty()) {
      checklist_ = drilling::load_checklist(request_.checklist);
    }
    std::vector<std::pair<const Session*, int>> procedures = chosen();
    require_room(procedures.size());
    experts_ = drilling::experts_of(summaries_, participant_, options_);
    for (const auto& [session, trial] : procedures) {
      write_procedure(*session, trial, procedures.size());
    }
    if (procedures.size() > 1) {
      write(request_.out,
            drilling::trainee_page(participant_, done_, experts_, curriculum_section()));
      std::rotate(files_.begin(), files_.end() - 1, files_.end());
    }
    return files_;
  }

 private:
  void load_sessions();
  void load_experts();
  std::vector<std::pair<const Session*, int>> chosen();
  void require_room(std::size_t procedures) const;
  void write_procedure(const Session& session, int trial, std::size_t procedures);
  drilling::Procedure load(const Session& session, int trial);
  const ExpertSession* shown_beside(const bone::BoneModel* bone) const;
  drilling::FirstView first_view(const Session& session) const;
  std::string picture(const drilling::Findings& findings, const Session& session) const;
  std::string curriculum_section() const;
  void write(const fs::path& file, const std::string& html);
  fs::path numbered(std::size_t number) const {
    return request_.out.parent_path() / fmt::format("{}-{}{}", request_.out.stem().string(), number,
                                                    request_.out.extension().string());
  }

  const TraineeRequest& request_;
  drilling::SafeOptions options_;
  drilling::StudyBones bones_;
  std::vector<std::unique_ptr<Session>> sessions_;  // in order of their start
  std::string participant_;
  ExpertSessions expert_sessions_{options_, bones_};
  std::vector<drilling::ExpertProcedure> summaries_;  // (of them)
  drilling::Experts experts_;
  std::optional<drilling::ScoreModel> score_;
  std::optional<drilling::Checklist> checklist_;
  std::vector<drilling::TraineeProcedure> done_;
  std::vector<fs::path> files_;
};

void Pages::load_sessions() {
  for (const fs::path& file : request_.sessions) {
    require_drilling(file);
    sessions_.push_back(std::make_unique<Session>(file));
    const std::string& subject = sessions_.back()->reader.info().subject;
    if (sessions_.size() > 1 && subject != participant_) {
      throw InputError(fmt::format("{}: is of participant {}, but {} is of {}; a page is about one",
                                   file.string(), subject, request_.sessions.front().string(),
                                   participant_));
    }
    participant_ = subject;
  }
  std::stable_sort(sessions_.begin(), sessions_.end(), [](const auto& a, const auto& b) {
    return a->reader.info().start_utc < b->reader.info().start_utc;
  });
}

void Pages::load_experts() {
  for (const fs::path& file : request_.experts) {
    expert_sessions_.add(file);
  }
  if (!request_.study.empty()) {
    expert_sessions_.add_study(request_.study);
  }
  summaries_ = expert_sessions_.for_feedback();
}

/// Every procedure that gets a page.
std::vector<std::pair<const Session*, int>> Pages::chosen() {
  std::vector<std::pair<const Session*, int>> procedures;
  for (const auto& session : sessions_) {
    std::vector<int> trials;
    for (const record::PassRow& pass : session->reader.passes()) {
      const bool wanted = !request_.trial || pass.trial == *request_.trial;
      if (!pass.practice && wanted && pass.phase == record::kDrillingPhase &&
          std::find(trials.begin(), trials.end(), pass.trial) == trials.end()) {
        trials.push_back(pass.trial);
      }
    }
    std::sort(trials.begin(), trials.end());
    for (const int trial : trials) {
      procedures.emplace_back(session.get(), trial);
    }
  }
  if (procedures.empty()) {
    throw InputError(fmt::format("{}: holds no procedure{}", request_.sessions.front().string(),
                                 request_.trial ? fmt::format(" {}", *request_.trial) : ""));
  }
  return procedures;
}

/// Checks the room before any work.
void Pages::require_room(std::size_t procedures) const {
  std::vector<fs::path> files{request_.out};
  for (std::size_t n = 1; n <= procedures && procedures > 1; ++n) {
    files.push_back(numbered(n));
  }
  for (const fs::path& file : files) {
    if (!request_.overwrite && fs::exists(file)) {
      throw InputError(
          fmt::format("{}: exists already; choose another name or add --overwrite", file.string()));
    }
  }
}

drilling::Procedure Pages::load(const Session& session, int trial) {
  for (drilling::Procedure& procedure :
       load_procedures(session.reader, procedure_setup(session.reader), &bones_)) {
    if (procedure.number == trial) {
      return std::move(procedure);
    }
  }
  throw InputError(fmt::format("{}: holds no procedure {}", session.path.string(), trial));
}

/// Another person's session on the same bone: of the procedures that were asked for by name the one
/// with most in sight, else of all.
const ExpertSession* Pages::shown_beside(const bone::BoneModel* bone) const {
  const auto named = [this](const ExpertSession& expert) {
    return std::find(request_.experts.begin(), request_.experts.end(), expert.file) !=
           request_.experts.end();
  };
  const auto rank = [&](const ExpertSession& expert) {
    return std::pair(named(expert), expert.procedure.summary.value("visible_share").value_or(-1.0));
  };
  const ExpertSession* best = nullptr;
  for (const ExpertSession& expert : expert_sessions_.procedures()) {
    if (expert.bone.get() == bone && expert.procedure.summary.participant != participant_ &&
        (best == nullptr || rank(expert) > rank(*best))) {
      best = &expert;
    }
  }
  return best;
}

drilling::FirstView Pages::first_view(const Session& session) const {
  const Camera& start = session.definition.simulator.camera.start;
  return {start.eye - start.target, start.up};
}

std::string Pages::picture(const drilling::Findings& f, const Session& session) const {
  if (f.summary.removed.empty()) {
    return "";
  }
  const drilling::FirstView view = first_view(session);
  const Eigen::Matrix3d R_BW = f.pose_WB.linear().transpose();
  const fs::path file = request_.out.string() + ".picture.png";
  render::write_png(file, drilling::visibility_figure(
                              {f.summary.bone.get(), f.summary.removed, f.summary.removed_seen},
                              {R_BW * view.towards_eye, R_BW * view.up}));
  std::string bytes = file_text(file);
  fs::remove(file);
  return bytes;
}

void Pages::write_procedure(const Session& session, int trial, std::size_t procedures) {
  const drilling::Findings f =
      drilling::findings_of(load(session, trial), experts_, bones_, options_);
  const bool several = procedures > 1;
  drilling::ProcedurePage page;
  page.findings = &f;
  page.experts = &experts_;
  page.scene = drilling::scene_json(f, first_view(session));
  page.picture = picture(f, session);
  page.started = session.reader.info().start_utc;
  page.overview = several ? request_.out.filename().string() : "";
  if (const ExpertSession* expert = shown_beside(f.summary.bone.get())) {
    const Session other(expert->file);
    const std::string& name = expert->procedure.summary.participant;
    const drilling::Experts others = drilling::experts_of(summaries_, name, options_);
    const drilling::Findings theirs =
        drilling::findings_of(load(other, expert->trial), others, bones_, options_);
    page.expert_scene = drilling::scene_json(theirs, first_view(other));
    page.expert_name = fmt::format("Expert {}, procedure {}{}", name, expert->trial,
                                   theirs.summary.simulated ? " (simulated)" : "");
  }
  if (score_) {
    page.score = drilling::score_section(
        *score_, score_of(*score_, f.summary, score_rules(session.definition)));
  }
  page.curriculum = several ? "" : curriculum_section();
  if (checklist_) {
    check_measures(*checklist_, f.summary, request_.checklist.string());
    page.checklist = drilling::checklist_section(*checklist_, f.summary);
  }
  const fs::path file = several ? numbered(done_.size() + 1) : request_.out;
  write(file, drilling::procedure_page(page));
  drilling::TraineeProcedure done;
  done.summary = f.summary;
  done.summary.removed = {};
  done.summary.removed_seen = {};
  done.summary.near = {};
  done.judged = static_cast<std::size_t>(std::count(f.judged.begin(), f.judged.end(), 1));
  done.too_hard = f.count(drilling::kForceFault);
  done.too_fast = f.count(drilling::kSpeedFault);
  done.page = file.filename().string();
  done.started = page.started;
  done_.push_back(std::move(done));
}

/// How the participant stands in the curriculum of the last session, by every session that the
/// folder holds; empty without one.
std::string Pages::curriculum_section() const {
  const Session& last = *sessions_.back();
  const auto& curriculum = last.definition.curriculum;
  if (!curriculum) {
    return "";
  }
  std::map<std::uint64_t, fs::path> files;  // by number of the session
  for (const fs::path& file :
       session_files(last.path.parent_path().empty() ? fs::path(".") : last.path.parent_path())) {
    const record::SessionReader reader(file);
    const record::SessionInfo& info = reader.info();
    if (info.subject == participant_ && info.pilot == last.reader.info().pilot) {
      files[info.session] = file;
    }
  }
  std::vector<fs::path> own;
  for (const auto& [session, file] : files) {
    own.push_back(file);
  }
  const auto attempts = case_attempts(*curriculum, own, score_ ? &*score_ : nullptr);
  const auto sessions = static_cast<std::uint64_t>(last.definition.sessions());
  return drilling::curriculum_section(*curriculum, standing(*curriculum, attempts),
                                      files.empty() || files.rbegin()->first < sessions);
}

void Pages::write(const fs::path& file, const std::string& html) {
  WholeFile whole(file, request_.overwrite);
  whole.write(html);
  whole.finish();
  files_.push_back(file);
}

}  // namespace

std::vector<fs::path> write_trainee_pages(const TraineeRequest& request) {
  return Pages(request).written();
}

std::vector<std::string> page_after_session(const protocols::BoneDefinition& definition,
                                            const fs::path& folder, const fs::path& file) {
  if (!definition.trainee_page) {
    return {};
  }
  TraineeRequest request;
  request.sessions = {file};
  request.out = fs::path(file).replace_extension(".html");
  request.overwrite = true;
  if (!definition.experts_study.empty()) {
    request.study = folder / definition.experts_study;
  }
  if (!definition.score_file.empty()) {
    request.score = folder / definition.score_file;
  }
  if (!definition.phases_file.empty()) {
    request.phases = folder / definition.phases_file;
  }
  if (!definition.checklist_file.empty()) {
    request.checklist = folder / definition.checklist_file;
  }
  try {
    return {"page: " + write_trainee_pages(request).front().string()};
  } catch (const std::exception& error) {  // the session itself is whole
    return {fmt::format("no page: {}", sentence_of(error))};
  }
}

}  // namespace haptrial::experiments
