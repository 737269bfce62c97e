#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "core/bone/model/bone_model.h"
#include "core/subject/drilling/drilling_chart.h"

namespace haptrial::subject {

/// The cavity that a procedure asks for: a cone whose narrow end is at a place beside a structure,
/// as far as margins to structures leave it. By default a cortical mastoidectomy: the antrum lies
/// behind the incus, and tegmen, sigmoid sinus, ear canal and nerves bound the way to it.
/// docs/algorithms/virtual-surgeon.md
struct CavityParameters {
  Eigen::Vector3d inward{-Eigen::Vector3d::UnitY()};  // into the bone, in W, unit length
  std::string beside{"incus"};                        // name of a structure
  Eigen::Vector3d offset_B{-2.0e-3, 7.0e-3, 1.0e-3};  // of the end from its middle, in B [m]
  double radius{3.5e-3};                              // at the end > 0 [m]
  double slope{0.45};                                 // radius by height >= 0
  double margin{1e-3};                                // to any structure >= 0 [m]
  std::vector<std::string> structures;                // with margins of their own
  std::vector<double> margins;                        // theirs >= 0 [m]

  bool operator==(const CavityParameters&) const = default;
};

/// Knowledge of a virtual surgeon about a bone before the first cut, and of a rater about a drilled
/// one.
/// @param X_WB  pose of the bone
/// @throws InputError where the bone has no structure of a name that the cavity gives.
DrillingChart make_chart(const bone::BoneModel& model, const Eigen::Isometry3d& X_WB,
                         const CavityParameters& cavity);

/// Depth of each voxel of a bone (grid.count()) below the first bone of its column, if it is plain
/// bone that the cavity asks to be removed; -1 elsewhere.
/// @param floor  of the columns: cavity_floor(), or as far as a burr reaches
std::vector<float> cavity_depths(const bone::BoneModel& model, const Eigen::Isometry3d& X_WB,
                                 const DrillingChart& chart, const std::vector<float>& floor);

}  // namespace haptrial::subject
