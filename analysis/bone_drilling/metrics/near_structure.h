#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/bone_drilling/metrics/procedure.h"
#include "analysis/statistics/base/defined.h"
#include "analysis/statistics/base/descriptive.h"
#include "core/bone/model/distance_field.h"

namespace haptrial::analysis::drilling {

/// Force and speed of a removal, and how far from the structure it was.
struct NearRemoval {
  float distance{0.0F};  // between centres of voxels [m]
  float force{0.0F};     // [N]
  float speed{0.0F};     // [m/s]
};

/// A procedure's removals within reach of one structure.
struct NearRemovals {
  std::string structure;
  std::vector<NearRemoval> removals;  // in order

  /// Means over the removals that are no farther than `within`; nothing where there are none.
  std::optional<double> mean_force(double within) const;
  std::optional<double> mean_speed(double within) const;
};

/// Source: Morris 2006, §3.5.2 (0.2 cm within 3 cm).
struct NearBins {
  double width{2e-3};   // > 0 [m]
  double reach{30e-3};  // >= width [m]

  std::size_t count() const;
};

/// Removals within reach [m] of a structure. @param field  of it, reaching at least as far
NearRemovals near_removals(const Procedure& procedure, const std::string& structure,
                           const bone::DistanceField& field, double reach = NearBins{}.reach);

/// Removals of a participant near a structure.
struct NearCase {
  std::string participant;
  const NearRemovals* removals{nullptr};
};

/// One interval of distance, [low, high).
struct ProfileBin {
  double low{0.0}, high{0.0};  // [m]
  std::size_t removals{0};
  std::size_t participants{0};  // with a removal in it
  /// Mean over removals, as the source has it. Those of one participant are not independent: its
  /// interval is too narrow.
  Defined<MeanInterval> pooled{Undefined{"there is no removal"}};
  /// Mean over participants' means, each one value: this is the one to plot.
  Defined<MeanInterval> by_participant{Undefined{"there is no removal"}};
};

enum class NearQuantity { kForce, kSpeed };  // [N], [m/s]

/// The profile of a group: mean and 95 % interval by distance.
std::vector<ProfileBin> near_profile(std::span<const NearCase> group, NearQuantity quantity,
                                     const NearBins& bins = {});

}  // namespace haptrial::analysis::drilling
