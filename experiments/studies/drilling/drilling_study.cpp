#include "experiments/studies/drilling/drilling_study.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <iterator>
#include <system_error>

#include "analysis/bone_drilling/report/learned_quantities.h"
#include "analysis/bone_drilling/report/validity_summary.h"
#include "analysis/bone_drilling/report/visibility_picture.h"
#include "analysis/exchange/own_findings.h"
#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/record/read/session_reader.h"
#include "experiments/studies/curve_analysis.h"
#include "experiments/studies/drilling/learn_phases.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;
namespace drilling = analysis::drilling;

// Pictures on their way into a report; gone at the end.
class PictureFolder {
 public:
  explicit PictureFolder(const fs::path& study)
      : path_(study / fmt::format(".pictures-{}", getpid())) {
    std::error_code error;
    if (!fs::create_directories(path_, error)) {
      throw InputError(
          fmt::format("{}: cannot be written ({}); choose a folder with write permission",
                      study.string(), error.message()));
    }
  }
  ~PictureFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  PictureFolder(const PictureFolder&) = delete;
  PictureFolder& operator=(const PictureFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

// View with which the surgeon looked at the bone first.
drilling::SurgeonsView surgeons_view(const protocols::BoneDefinition& definition,
                                     const geometry::VoxelGrid& grid) {
  const Camera& start = definition.simulator.camera.start;
  const Eigen::Matrix3d R_BW = pose_of(definition.placement, grid).linear().transpose();
  return {R_BW * (start.eye - start.target), R_BW * start.up};
}

drilling::StudyPicture visibility_picture(const drilling::ProcedureSummary& procedure,
                                          const protocols::BoneDefinition& definition,
                                          const std::string& name, const std::string& which,
                                          const fs::path& folder) {
  const fs::path file = folder / (name + ".png");
  render::write_png(file, drilling::visibility_figure(
                              {procedure.bone.get(), procedure.removed, procedure.removed_seen},
                              surgeons_view(definition, procedure.bone->grid)));
  return {name, fmt::format("Removed voxels of the procedure with the {} share in sight", which),
          fmt::format("Green: visible when they were removed ({:.0f} %). Magenta: hidden by other "
                      "bone. Pale colours: vital structures. Left: as the surgeon looks into the "
                      "cavity, bone is not drawn. Right: cut open where most was hidden, the way "
                      "out is up; beige: bone that stands.",
                      100.0 * procedure.value("visible_share").value_or(0.0)),
          "Green and magenta voxels of a cavity among vital structures, whole and cut open.", file};
}

// Figure 18: the two ends of the study.
std::vector<drilling::StudyPicture> visibility_pictures(
    const std::vector<drilling::ProcedureSummary>& procedures,
    const protocols::BoneDefinition& definition, const fs::path& folder) {
  const drilling::ProcedureSummary *least = nullptr, *most = nullptr;
  for (const auto& p : procedures) {
    if (const auto share = p.value("visible_share")) {
      least = least == nullptr || *share < *least->value("visible_share") ? &p : least;
      most = most == nullptr || *share > *most->value("visible_share") ? &p : most;
    }
  }
  std::vector<drilling::StudyPicture> pictures;
  if (least != nullptr) {
    pictures.push_back(
        visibility_picture(*least, definition, "figure-18-undercut", "smallest", folder));
    pictures.push_back(
        visibility_picture(*most, definition, "figure-18-saucerized", "largest", folder));
  }
  return pictures;
}

}  // namespace

std::vector<std::string> analyze_drillings(const AnalysisRequest& request) {
  const record::SessionInfo& first = request.files.first;
  drilling::ValidityStudy study;
  const auto definition = protocols::parse_bone_definition(first.definition, first.definition_name);
  Table root = definition.root();
  study.learning = read_drilling_learning(root, &definition);
  study.learning_names = learning_names(definition);
  const bool learns = !study.learning.outcomes.empty();
  study.title = learns                 ? "Learning in drillings"
                : definition.nerves    ? "Drilling beside watched nerves"
                : definition.hints     ? "Drilling with hints"
                : definition.forbidden ? "Drilling beside forbidden regions"
                                       : "Construct validity of simulated bone surgery";
  study.files = request.files.files;
  study.threads = request.threads;
  study.ratings = request.folder / kRatingsFile;
  if (const fs::path phases = request.folder / kPhasesFile; fs::exists(phases)) {
    study.metrics.phases = phases_by(phases);
  }
  if (fs::exists(request.folder / kCheckedFile)) {
    study.checklist = request.folder / kChecklistFile;
    study.checked = request.folder / kCheckedFile;
  }
  study.setup = [&](const record::SessionReader& session) { return procedure_setup(session); };
  for (const protocols::StudyGroup& group : definition.groups) {
    study.plan.groups.push_back(group.name);
    if (group.expert && !learns) {
      study.plan.expert_groups.push_back(group.name);
    }
  }
  std::vector<std::string> remarks = request.files.remarks;
  if (learns) {
    study.learning.plan =
        plan_for(request.planned, request.reference, study.learning.plan, remarks);
  } else if (!request.planned.empty() || !request.reference.empty()) {
    throw InputError(
        "--planned and --reference are of studies that compare sessions; in this study of "
        "drillings nothing is learned from session to session; leave them out");
  }
  drilling::ValidityResult result = drilling::analyze(study);
  std::ranges::move(remarks, std::back_inserter(result.remarks));
  const PictureFolder pictures(request.out);
  result.pictures = visibility_pictures(result.procedures, definition, pictures.path());
  const auto own = analysis::own_findings(request.files.files);
  drilling::write_validity(result, request.out, request.paper, own);
  std::vector<std::string> lines = drilling::summary_lines(result);
  for (const analysis::FindingList& list : own) {
    std::ranges::move(analysis::lines_of(list), std::back_inserter(lines));
  }
  lines.insert(lines.end(), result.remarks.begin(), result.remarks.end());
  return lines;
}

analysis::LearningPlan read_drilling_learning(Table& root,
                                              const protocols::BoneDefinition* definition) {
  const auto names =
      definition == nullptr ? analysis::LearningNames{} : learning_names(*definition);
  return analysis::read_learning_plan(root, names, analysis::drilling::drilling_outcomes());
}

}  // namespace haptrial::experiments
