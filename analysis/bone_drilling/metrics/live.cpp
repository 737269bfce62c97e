#include "analysis/bone_drilling/metrics/live.h"

#include <stdexcept>

#include "analysis/bone_drilling/metrics/in_order.h"

namespace haptrial::analysis::drilling {
namespace {

template <class Row>
void drop(std::vector<Row>& rows, std::size_t count) {
  rows.erase(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(count));
}

}  // namespace

LiveMetrics::LiveMetrics(const std::shared_ptr<const bone::BoneModel>& bone,
                         const Eigen::Isometry3d& pose_WB, const std::vector<ProcedureTool>& tools,
                         double scale, double rate, const Eigen::Vector3d& handle,
                         const ProcedurePlans& plans)
    : meter_(bone, pose_WB, tools, rate, bones_, plans), scale_(scale), handle_(handle) {}

void LiveMetrics::add(std::span<const record::Sample> samples,
                      std::span<const record::ToolRow> tool) {
  if (samples.size() != tool.size()) {
    throw std::invalid_argument("LiveMetrics: as many rows of /tool as of /samples are needed");
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples[i].sequence != tool[i].sequence) {
      throw std::invalid_argument("LiveMetrics: rows of /samples and /tool are of other ticks");
    }
    if (tool[i].active) {
      waiting_.ticks.push_back(tick_of(samples[i], tool[i], scale_, handle_));
    }
  }
}

void LiveMetrics::add(std::span<const record::RemovalRow> rows) {
  for (const record::RemovalRow& row : rows) {
    (row.cut ? waiting_.cuts : waiting_.removals).push_back(removal_of(row));
  }
}

void LiveMetrics::add(std::span<const record::CameraRow> rows) {
  for (const record::CameraRow& row : rows) {
    waiting_.views.push_back(view_of(row));
  }
}

void LiveMetrics::add(std::span<const record::SplitRow> rows) {
  for (const record::SplitRow& row : rows) {
    if (row.to < 0) {
      waiting_.crumbs.push_back({row.sequence, {row.voxel[0], row.voxel[1], row.voxel[2]}});
    }
  }
}

void LiveMetrics::add(std::span<const record::PieceRow> rows) {
  for (const record::PieceRow& row : rows) {
    meter_.add(row);
  }
}

void LiveMetrics::add(std::span<const record::ScrewRow> rows) {
  for (const record::ScrewRow& row : rows) {
    meter_.add(row);
  }
}

void LiveMetrics::add(const Procedure& earlier) {
  add(std::span(earlier.pieces));
  add(std::span(earlier.screws));
  const auto append = [](auto& to, const auto& rows) {
    to.insert(to.end(), rows.begin(), rows.end());
  };
  append(waiting_.views, earlier.views);
  append(waiting_.crumbs, earlier.crumbs);
  append(waiting_.ticks, earlier.ticks);
  append(waiting_.removals, earlier.removals);
  append(waiting_.cuts, earlier.cuts);
}

void LiveMetrics::advance(std::uint64_t through) {
  std::array<std::size_t, 5> done{};
  visit_in_order(waiting_, meter_, done, through);
  drop(waiting_.views, done[0]);
  drop(waiting_.crumbs, done[1]);
  drop(waiting_.ticks, done[2]);
  drop(waiting_.removals, done[3]);
  drop(waiting_.cuts, done[4]);
}

LiveFigures LiveMetrics::figures() const {
  const Usage usage = meter_.usage();
  LiveFigures figures;
  figures.time = usage.time;
  figures.drilling = usage.drilling;
  figures.removed = usage.removed;
  figures.voxels = meter_.visibility().visible.size();
  figures.visible_share = meter_.visibility().share();
  figures.injured_voxels = meter_.injuries().voxels();
  figures.injuries = meter_.injuries().injuries();
  figures.mean_force = usage.mean_force;
  figures.achieved = meter_.achieved();
  return figures;
}

}  // namespace haptrial::analysis::drilling
