#include "analysis/bone_drilling/metrics/procedure.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "analysis/bone_drilling/metrics/study_bones.h"
#include "core/base/error.h"
#include "core/bone/record/recorded_bone.h"
#include "core/record/read/session_facts.h"
#include "core/record/read/session_reader.h"
#include "core/record/read/tick_rows.h"
#include "core/record/table/schema.h"
#include "core/subject/drilling/work_row.h"

namespace haptrial::analysis::drilling {
namespace {

constexpr std::uint64_t kAtOnce = 65536;  // rows of samples in memory

/// The rows of one table, in the order of their sequence numbers.
template <class Row>
class Rows {
 public:
  explicit Rows(const record::SessionReader& file) : rows_(file.rows<Row>()) {
    const bool ordered = std::is_sorted(rows_.begin(), rows_.end(), [](const Row& a, const Row& b) {
      return a.sequence < b.sequence;
    });
    if (!ordered) {
      throw InputError(fmt::format(
          "{}: the sequence numbers of a drilling table do not ascend; the file is damaged",
          file.path().string()));
    }
  }

  /// Rows from `first` to `last`, both inclusive.
  std::span<const Row> of(const record::PassRow& pass) const {
    const auto low =
        std::lower_bound(rows_.begin(), rows_.end(), pass.first_sample,
                         [](const Row& row, std::uint64_t value) { return row.sequence < value; });
    const auto high =
        std::upper_bound(low, rows_.end(), pass.last_sample,
                         [](std::uint64_t value, const Row& row) { return value < row.sequence; });
    return {low, high};
  }

 private:
  std::vector<Row> rows_;
};

class Loader {
 public:
  Loader(const record::SessionReader& file, const ProcedureSetup& setup, StudyBones* bones)
      : file_(file),
        setup_(setup),
        bones_(bones),
        removals_(file),
        views_(file),
        splits_(file),
        tears_(file),
        pieces_(file),
        screws_(file),
        ends_(file.rows<record::ProcedureRow>()),
        fields_(file.rows<record::FieldRow>()),
        works_(file.rows<record::WorkRow>()) {
    for (const record::BoneRecord& record : record::recorded_bones(file)) {
      models_.push_back(keep(record));
    }
  }

  Procedure load(int trial, const std::vector<CountedPass>& passes) const {
    Procedure procedure;
    procedure.session = file_.path().filename().string();
    procedure.participant = file_.info().subject;
    procedure.session_number = static_cast<int>(file_.info().session);
    procedure.session_name = setup_.session_name;
    procedure.case_name = setup_.of_cases ? passes.back().pass.condition : "";
    procedure.group = setup_.group;
    procedure.number = trial;
    procedure.simulated = file_.info().simulated;
    procedure.completed = passes.back().pass.status == record::PassStatus::kCompleted;
    procedure.rate = file_.info().rate;
    procedure.bone = models_[bone_of_trial(trial, passes)];
    if (setup_.pose_WB) {
      procedure.pose_WB = setup_.pose_WB(procedure.bone->grid);
    }
    procedure.tools = setup_.tools;
    procedure.plans = setup_.plans ? setup_.plans(procedure.bone) : ProcedurePlans{};
    for (const CountedPass& pass : passes) {
      add(pass.pass, procedure);
    }
    for (const record::FieldRow& field : fields_) {  // the last is of the end
      if (std::any_of(passes.begin(), passes.end(), [&](const CountedPass& pass) {
            return std::cmp_equal(field.pass, pass.row);
          })) {
        procedure.field = field;
      }
    }
    for (const record::WorkRow& row : works_) {
      if (std::any_of(passes.begin(), passes.end(), [&](const CountedPass& pass) {
            return std::cmp_equal(row.pass, pass.row);
          })) {
        procedure.work.push_back({row.time, std::string(record::word_of(row.work))});
      }
    }
    return procedure;
  }

 private:
  std::shared_ptr<const bone::BoneModel> keep(const record::BoneRecord& record) const {
    try {
      bone::BoneModel model = bone::bone_of(record);
      return bones_ != nullptr ? bones_->keep(std::move(model))
                               : std::make_shared<const bone::BoneModel>(std::move(model));
    } catch (const std::invalid_argument& error) {
      throw InputError(
          fmt::format("{}: bone '{}' is damaged ({}); choose an undamaged session file",
                      file_.path().string(), record.bone.name, error.what()));
    }
  }

  /// Number of a trial's bone. /procedures has it, unless the session was killed before the end of
  /// a pass: then procedures have taken the bones in turn.
  std::size_t bone_of_trial(int trial, const std::vector<CountedPass>& passes) const {
    auto bone = static_cast<std::int64_t>(trial - 1) %
                static_cast<std::int64_t>(std::max<std::size_t>(models_.size(), 1));
    for (const record::ProcedureRow& end : ends_) {
      for (const CountedPass& pass : passes) {
        bone = std::cmp_equal(end.pass, pass.row) ? end.bone : bone;
      }
    }
    if (bone < 0 || std::cmp_greater_equal(bone, models_.size())) {
      throw InputError(fmt::format("{}: trial {} is on bone {}; allowed: 0 to {}",
                                   file_.path().string(), trial, bone, std::ssize(models_) - 1));
    }
    return static_cast<std::size_t>(bone);
  }

  void add(const record::PassRow& pass, Procedure& procedure) const {
    const record::RowSpan there =
        record::span_of_ticks(file_, record::samples_table(), pass.first_sample,
                              pass.last_sample - pass.first_sample + 1);
    const std::uint64_t end = there.first + there.count;
    for (std::uint64_t first = there.first; first < end; first += kAtOnce) {
      const std::uint64_t count = std::min(kAtOnce, end - first);
      const auto samples = file_.samples(first, count);
      const auto tool = file_.rows<record::ToolRow>(first, count);
      for (std::size_t i = 0; i < samples.size() && i < tool.size(); ++i) {
        if (samples[i].sequence != tool[i].sequence) {
          throw InputError(
              fmt::format("{}: row {} of /tool is of tick {}; allowed: tick {}, as in /samples",
                          file_.path().string(), first + i, tool[i].sequence, samples[i].sequence));
        }
        if (tool[i].active) {
          procedure.ticks.push_back(tick_of(samples[i], tool[i], setup_.scale, setup_.handle));
        }
      }
    }
    for (const record::RemovalRow& row : removals_.of(pass)) {
      (row.cut ? procedure.cuts : procedure.removals).push_back(removal_of(row));
    }
    for (const record::CameraRow& row : views_.of(pass)) {
      procedure.views.push_back(view_of(row));
    }
    for (const record::TearRow& row : tears_.of(pass)) {
      procedure.tears.push_back(
          {row.sequence, row.label, row.by_suction, row.force, procedure.pose_WB * row.place});
    }
    const auto append = [](auto& to, const auto& rows) {
      to.insert(to.end(), rows.begin(), rows.end());
    };
    append(procedure.pieces, pieces_.of(pass));
    append(procedure.screws, screws_.of(pass));
    for (const record::SplitRow& row : splits_.of(pass)) {
      if (row.to < 0) {
        procedure.crumbs.push_back({row.sequence, {row.voxel[0], row.voxel[1], row.voxel[2]}});
      }
    }
  }

  const record::SessionReader& file_;
  const ProcedureSetup& setup_;
  StudyBones* bones_;
  std::vector<std::shared_ptr<const bone::BoneModel>> models_;
  Rows<record::RemovalRow> removals_;
  Rows<record::CameraRow> views_;
  Rows<record::SplitRow> splits_;
  Rows<record::TearRow> tears_;
  Rows<record::PieceRow> pieces_;
  Rows<record::ScrewRow> screws_;
  std::vector<record::ProcedureRow> ends_;
  std::vector<record::FieldRow> fields_;
  std::vector<record::WorkRow> works_;
};

double as_filed(double value, double resolution) {
  return static_cast<double>(static_cast<float>(record::on_grid(value, resolution)));
}

Eigen::Vector3d as_filed(const Eigen::Vector3d& value, double resolution) {
  return value.unaryExpr([&](double x) { return as_filed(x, resolution); });
}

double as_float(double value) { return static_cast<double>(static_cast<float>(value)); }

}  // namespace

const ProcedureTool* Procedure::tool(std::int32_t tool) const noexcept {
  return tool >= 0 && std::cmp_less(tool, tools.size()) ? &tools[static_cast<std::size_t>(tool)]
                                                        : nullptr;
}

double Procedure::burr_radius(std::int32_t tool) const noexcept {
  const ProcedureTool* const of = this->tool(tool);
  return of != nullptr ? of->burr_radius : 0.0;
}

std::vector<Procedure> load_procedures(const record::SessionReader& file,
                                       const ProcedureSetup& setup, StudyBones* bones) {
  if (!(setup.scale > 0.0)) {
    throw std::invalid_argument("ProcedureSetup: the scale must be above 0");
  }
  if (!record::drills(file)) {
    throw InputError(fmt::format("{}: is not a drilling session", file.path().string()));
  }
  record::check_phases(file, std::array{record::kDrillingPhase});
  const Loader loader(file, setup, bones);
  std::vector<Procedure> procedures;
  for (const auto& [trial, passes] : counted_passes(file)) {
    procedures.push_back(loader.load(trial, passes));
  }
  return procedures;
}

ToolTick tick_of(const record::Sample& sample, const record::ToolRow& tool, double scale,
                 const Eigen::Vector3d& handle) {
  ToolTick tick;
  tick.sequence = sample.sequence;
  tick.position = as_filed(sample.position, record::kPositionResolution) / scale;
  tick.velocity = as_filed(sample.velocity, record::kVelocityResolution) / scale;
  Eigen::Quaterniond turn = tool.orientation;
  for (double& number : turn.coeffs()) {
    number = as_filed(number, record::kOrientationResolution);
  }
  tick.axis = (turn.normalized() * handle.normalized()).cast<float>();
  tick.force = as_filed(tool.contact, record::kForceResolution).norm();
  tick.removed = as_float(tool.removed);
  tick.tool = tool.tool;
  tick.drives_tool = tool.mode == 0;
  tick.power = tool.power;
  tick.in_bone = tool.immersed > 0;
  return tick;
}

Removal removal_of(const record::RemovalRow& row) {
  return {row.sequence, bone::Voxel(row.voxel[0], row.voxel[1], row.voxel[2]), row.label,
          as_float(row.force), as_float(row.speed)};
}

View view_of(const record::CameraRow& row) {
  return {row.sequence, row.eye, row.target, row.field_of_view};
}

std::map<std::int32_t, std::vector<CountedPass>> counted_passes(const record::SessionReader& file) {
  std::map<std::int32_t, std::vector<CountedPass>> trials;
  const std::vector<record::PassRow> passes = file.passes();
  for (std::size_t row = 0; row < passes.size(); ++row) {
    const record::PassRow& pass = passes[row];
    if (pass.practice || pass.phase != record::kDrillingPhase) {
      continue;
    }
    std::vector<CountedPass>& own = trials[pass.trial];
    if (!own.empty() && own.back().pass.repetition < pass.repetition) {
      own.clear();
    }
    own.push_back({row, pass});
  }
  return trials;
}

}  // namespace haptrial::analysis::drilling
