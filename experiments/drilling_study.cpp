#include "experiments/drilling_study.h"

#include <fmt/format.h>
#include <unistd.h>

#include <toml++/toml.h>
#include <algorithm>
#include <optional>
#include <system_error>

#include "analysis/drilling/visibility_picture.h"
#include "core/base/error.h"
#include "core/record/session_reader.h"
#include "core/render/scene.h"
#include "experiments/bone_definition.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;
namespace drilling = analysis::drilling;

constexpr const char* kNovices = "novices";
constexpr const char* kEverybody = "participants";

std::optional<int> number_at_end(const std::string& subject) {
  const auto letter = subject.find_last_not_of("0123456789");
  const std::string digits = subject.substr(letter == std::string::npos ? 0 : letter + 1);
  constexpr std::size_t kLongest = 5;
  return digits.empty() || digits.size() > kLongest ? std::nullopt
                                                    : std::optional<int>(std::stoi(digits));
}

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

// As the surgeon looked at it first.
drilling::SurgeonsView surgeons_view(const BoneDefinition& definition,
                                     const geometry::VoxelGrid& grid) {
  const bone::Microscope& start = definition.simulator.camera.start;
  const Eigen::Matrix3d R_BW = pose_of(definition.placement, grid).linear().transpose();
  return {R_BW * (start.eye - start.target), R_BW * start.up};
}

drilling::StudyPicture visibility_picture(const drilling::ProcedureSummary& procedure,
                                          const BoneDefinition& definition, const std::string& name,
                                          const std::string& which, const fs::path& folder) {
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
    const std::vector<drilling::ProcedureSummary>& procedures, const BoneDefinition& definition,
    const fs::path& folder) {
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

std::vector<StudyGroup> study_groups(std::string_view definition, std::string_view file_name) {
  toml::table root;
  try {
    root = toml::parse(definition);
  } catch (const toml::parse_error& error) {
    throw InputError(fmt::format("{}: is not TOML: {}", file_name, error.description()));
  }
  std::vector<std::pair<toml::source_position, StudyGroup>> found;
  if (const toml::table* groups = root["groups"].as_table()) {
    for (const auto& [key, value] : *groups) {
      const auto count = value.value<std::int64_t>();
      constexpr std::int64_t kMost = 10000;
      if (!value.is_integer() || *count < 1 || *count > kMost) {
        throw InputError(
            fmt::format("{}: groups.{} is not a number of participants; allowed: 1 to {}",
                        file_name, key.str(), kMost));
      }
      found.push_back({key.source().begin,
                       {std::string(key.str()), static_cast<int>(*count), key.str() != kNovices}});
    }
  }
  std::sort(found.begin(), found.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<StudyGroup> result;
  for (auto& [position, group] : found) {
    result.push_back(std::move(group));
  }
  if (result.empty()) {
    result.push_back({kEverybody, 0, false});
  }
  return result;
}

std::string group_of(const std::vector<StudyGroup>& groups, const std::string& subject) {
  if (groups.size() == 1) {
    return groups.front().name;
  }
  const std::optional<int> number = number_at_end(subject);
  int last = 0;
  for (const StudyGroup& group : groups) {
    last += group.participants;
    if (number && *number >= 1 && *number <= last) {
      return group.name;
    }
  }
  throw InputError(
      fmt::format("participant {} belongs to no group; allowed: an identifier that ends in a "
                  "number from 1 to {}",
                  subject, last));
}

drilling::ProcedureSetup procedure_setup(const record::SessionReader& session,
                                         const std::vector<StudyGroup>& groups) {
  const record::SessionInfo& info = session.info();
  drilling::ProcedureSetup setup =
      procedure_setup(parse_bone_definition(info.definition, info.definition_name));
  setup.group = group_of(groups, info.subject);
  return setup;
}

drilling::ProcedureSetup procedure_setup(const BoneDefinition& definition) {
  drilling::ProcedureSetup setup;
  setup.scale = definition.drilling.scale;
  setup.pose_WB = [placement = definition.placement](const geometry::VoxelGrid& grid) {
    return pose_of(placement, grid);
  };
  for (const bone::ToolSpec& tool : definition.simulator.tools) {
    const bool burr = tool.kind == bone::ToolKind::kBurr;
    setup.tools.push_back({tool.name, burr ? 0.5 * tool.burr.diameter : 0.0});
  }
  return setup;
}

std::vector<std::string> analyze_drillings(const fs::path& folder, const StudyFiles& files,
                                           const fs::path& out, int threads) {
  const record::SessionInfo& first = files.first;
  const std::vector<StudyGroup> groups = study_groups(first.definition, first.definition_name);
  drilling::ValidityStudy study;
  study.title = "Construct validity of simulated bone surgery";
  study.files = files.files;
  study.threads = threads;
  study.ratings = folder / kRatingsFile;
  study.setup = [&](const record::SessionReader& session) {
    return procedure_setup(session, groups);
  };
  for (const StudyGroup& group : groups) {
    study.plan.groups.push_back(group.name);
    if (group.expert) {
      study.plan.expert_groups.push_back(group.name);
    }
  }
  drilling::ValidityResult result = drilling::analyze(study);
  result.remarks = files.remarks;
  const PictureFolder pictures(out);
  result.pictures = visibility_pictures(
      result.procedures, parse_bone_definition(first.definition, first.definition_name),
      pictures.path());
  drilling::write_validity(result, out);
  std::vector<std::string> lines = drilling::summary_lines(result);
  lines.insert(lines.end(), result.remarks.begin(), result.remarks.end());
  return lines;
}

}  // namespace haptrial::experiments
