#include "core/subject/drilling/cavity_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/base/error.h"
#include "core/base/nearest.h"
#include "core/bone/model/distance_field.h"
#include "core/geometry/volume/voxel_grid.h"

namespace haptrial::subject {
namespace {

constexpr double kCell = 0.5e-3;   // of charts [m]
constexpr double kReach = 10e-3;   // of clearances [m]
constexpr double kBelow = 2e-3;    // layers under the cavity's end [m]
constexpr double kAbove = 45e-3;   // and above it: more than a temporal bone is thick [m]
constexpr double kAround = 22e-3;  // columns on each side [m]

[[noreturn]] void refuse(const bone::BoneModel& model, const char* key, const std::string& name) {
  std::vector<bool> there(model.structures.size(), false);
  for (const std::uint8_t label : model.labels) {
    there[label] = true;
  }
  std::vector<std::string> known;
  for (std::size_t label = 1; label < there.size(); ++label) {
    if (there[label]) {
      known.push_back(model.structures[label].name);
    }
  }
  const std::string hint = did_you_mean(name, known);
  throw InputError(fmt::format("{} names \"{}\", which {} does not have{} allowed: {}", key, name,
                               model.name.empty() ? "the bone" : model.name,
                               hint.empty() ? ";" : hint, fmt::join(known, ", ")));
}

Eigen::Vector3d middle_of(const bone::BoneModel& model, const std::string& name) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  std::size_t count = 0;
  const geometry::VoxelGrid& grid = model.grid;
  geometry::visit_voxels(grid, [&](const bone::Voxel& voxel, std::size_t at) {
    if (model.structures[model.labels[at]].name == name) {
      sum += grid.centre(voxel);
      ++count;
    }
  });
  if (count == 0) {
    refuse(model, "cavity.beside", name);
  }
  return sum / static_cast<double>(count);
}

/// Columns and layers about the cavity's end.
DrillingChart empty_chart(const Eigen::Vector3d& end_W, const CavityParameters& cavity) {
  DrillingChart chart;
  chart.cell = kCell;
  const Eigen::Vector3d inward = cavity.inward.normalized();
  const Eigen::Vector3d other =
      std::abs(inward.x()) < 0.9 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitZ();
  chart.axes.col(2) = inward;
  chart.axes.col(0) = (other - other.dot(inward) * inward).normalized();
  chart.axes.col(1) = inward.cross(chart.axes.col(0));
  const auto across = static_cast<int>(2.0 * kAround / kCell) + 1;
  chart.size = {across, across, static_cast<int>((kAbove + kBelow) / kCell) + 1};
  chart.end = {kAround, kAround, kAbove};
  chart.corner = end_W - chart.axes * chart.end;
  chart.floor_radius = cavity.radius;
  chart.slope = cavity.slope;
  return chart;
}

/// A margin to what is not there, or has a name but no voxels, would be one that nobody keeps.
void check_structures(const bone::BoneModel& model, const CavityParameters& cavity) {
  std::vector<bool> there(model.structures.size(), false);
  for (const std::uint8_t label : model.labels) {
    there[label] = true;
  }
  for (const std::string& name : cavity.structures) {
    bool found = false;
    for (std::size_t label = 1; label < there.size(); ++label) {
      found = found || (there[label] && model.structures[label].name == name);
    }
    if (!found) {
      refuse(model, "cavity.structures", name);
    }
  }
}

double margin_of(const CavityParameters& cavity, const std::string& structure) {
  for (std::size_t s = 0; s < cavity.structures.size(); ++s) {
    if (cavity.structures[s] == structure) {
      return cavity.margins[s];
    }
  }
  return cavity.margin;
}

/// The voxels that may have a distance to a structure: those that are no farther than `reach`.
Eigen::AlignedBox3d voxels_near(const bone::BoneModel& model, std::size_t label, double reach) {
  Eigen::AlignedBox3d box;
  geometry::visit_voxels(model.grid, [&](const bone::Voxel& voxel, std::size_t at) {
    if (model.labels[at] == label) {
      box.extend(voxel.cast<double>());
    }
  });
  const double around = reach / model.grid.spacing + 1.0;
  return {box.min().array() - around, box.max().array() + around};
}

/// The chart's entries that such voxels are around; one more on each side, so that rounding leaves
/// none out.
Eigen::AlignedBox3i entries_near(const DrillingChart& chart, const Eigen::AlignedBox3d& voxels,
                                 const geometry::VoxelGrid& grid, const Eigen::Isometry3d& X_BW) {
  const Eigen::Isometry3d X_WB = X_BW.inverse();
  Eigen::AlignedBox3d places;
  for (int corner = 0; corner < 8; ++corner) {
    const auto type = static_cast<Eigen::AlignedBox3d::CornerType>(corner);
    const Eigen::Vector3d p_B = grid.origin + grid.spacing * voxels.corner(type);
    places.extend(chart.place(X_WB * p_B) / chart.cell);
  }
  const Eigen::Array3i last = Eigen::Array3i(chart.size[0], chart.size[1], chart.size[2]) - 1;
  return {(places.min().array().floor().cast<int>() - 1).max(0).matrix(),
          (places.max().array().ceil().cast<int>() + 1).min(last).matrix()};
}

/// Lowers every entry to the distance from one structure, less its margin.
void keep_away(DrillingChart& chart, const bone::BoneModel& model, const Eigen::Isometry3d& X_BW,
               std::size_t label, double margin) {
  std::vector<bool> labels(label + 1, false);
  labels[label] = true;
  const double reach = std::min(kReach, 240.0 * model.grid.spacing);
  const bone::DistanceField field(model, labels, reach);
  if (field.empty()) {
    return;
  }
  const Eigen::AlignedBox3i near =
      entries_near(chart, voxels_near(model, label, reach), model.grid, X_BW);
  for (int k = near.min().z(); k <= near.max().z(); ++k) {
    for (int j = near.min().y(); j <= near.max().y(); ++j) {
      for (int i = near.min().x(); i <= near.max().x(); ++i) {
        const Eigen::Vector3d place = chart.cell * Eigen::Vector3d(i, j, k);
        const auto distance = field.linear_at(X_BW * chart.world(place));
        if (distance) {
          float& clearance =
              chart.clearance[chart.column(i, j) + chart.columns() * static_cast<std::size_t>(k)];
          clearance = std::min(clearance, static_cast<float>(*distance - margin));
        }
      }
    }
  }
}

void find_surface(DrillingChart& chart, const bone::BoneModel& model,
                  const Eigen::Isometry3d& X_BW) {
  const geometry::VoxelGrid& grid = model.grid;
  for (int j = 0; j < chart.size[1]; ++j) {
    for (int i = 0; i < chart.size[0]; ++i) {
      for (double w = 0.0; w < kAbove + kBelow; w += 0.5 * kCell) {
        const Eigen::Vector3d place(i * kCell, j * kCell, w);
        const bone::Voxel v = grid.nearest(X_BW * chart.world(place));
        if (grid.contains(v) && model.labels[grid.index(v)] != 0) {
          chart.surface[chart.column(i, j)] = static_cast<float>(w);
          break;
        }
      }
    }
  }
}

}  // namespace

DrillingChart make_chart(const bone::BoneModel& model, const Eigen::Isometry3d& X_WB,
                         const CavityParameters& cavity) {
  check_structures(model, cavity);
  const Eigen::Vector3d end_B = middle_of(model, cavity.beside) + cavity.offset_B;
  DrillingChart chart = empty_chart(X_WB * end_B, cavity);
  const Eigen::Isometry3d X_BW = X_WB.inverse();
  chart.surface.assign(chart.columns(), DrillingChart::kNone);
  chart.clearance.assign(chart.columns() * static_cast<std::size_t>(chart.size[2]),
                         static_cast<float>(kReach));
  find_surface(chart, model, X_BW);
  for (std::size_t label = 1; label < model.structures.size(); ++label) {
    const std::string& name = model.structures[label].name;
    if (name != bone::kPlainBone && !name.empty()) {
      keep_away(chart, model, X_BW, label, margin_of(cavity, name));
    }
  }
  return chart;
}

std::vector<float> cavity_depths(const bone::BoneModel& model, const Eigen::Isometry3d& X_WB,
                                 const DrillingChart& chart, const std::vector<float>& floor) {
  std::vector<float> depths(model.grid.count(), -1.0F);
  geometry::visit_voxels(model.grid, [&](const bone::Voxel& voxel, std::size_t at) {
    if (model.labels[at] == 0 || model.structures[model.labels[at]].name != bone::kPlainBone) {
      return;
    }
    const Eigen::Vector3d place = chart.place(X_WB * model.grid.centre(voxel));
    const auto u = static_cast<int>(std::lround(place.x() / chart.cell));
    const auto v = static_cast<int>(std::lround(place.y() / chart.cell));
    if (u < 0 || v < 0 || u >= chart.size[0] || v >= chart.size[1]) {
      return;
    }
    const std::size_t column = chart.column(u, v);
    const auto deep = static_cast<float>(place.z());
    // A column that is to be left has its floor at its surface, which a slope may rise above.
    const bool drilled =
        chart.surface[column] != DrillingChart::kNone && floor[column] > chart.surface[column];
    const double aside = (place - chart.end).head<2>().norm();
    const double wide = chart.floor_radius + chart.slope * std::max(0.0, chart.end.z() - place.z());
    if (drilled && deep < floor[column] && aside <= wide) {
      depths[at] = std::max(0.0F, deep - chart.surface[column]);
    }
  });
  return depths;
}

}  // namespace haptrial::subject
