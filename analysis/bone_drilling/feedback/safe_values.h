#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/bone_drilling/metrics/near_structure.h"
#include "analysis/bone_drilling/metrics/phase_span.h"
#include "analysis/bone_drilling/metrics/study_bones.h"

namespace haptrial::analysis::drilling {

/// A removal and the vital structure that was nearest to it.
struct NearestRemoval {
  std::int32_t structure{-1};  // of the names that were given; -1: none within reach
  NearRemoval at;              // distance 0 without a structure
};

/// One for each removal of a procedure, in order. @param names  of structures of its bone, which
/// need not have them all; reach [m], at most 250 voxels count
std::vector<NearestRemoval> nearest_structures(const Procedure& procedure,
                                               std::span<const std::string> names,
                                               StudyBones& bones, double reach);

struct SafeOptions {
  NearBins bins;           // as the source has them: 2 mm within 30 mm
  double low{0.05};        // the range of the experts lies between these shares of removals
  double high{0.95};       // low < high < 1
  std::size_t fewest{20};  // removals; an interval with fewer says nothing
  FindPhases phases;       // for summaries; empty: procedures are not divided
};

/// The removals of one expert.
struct SafeCase {
  std::string participant;
  std::span<const NearestRemoval> removals;
};

struct SafeRange {
  double low{0.0}, median{0.0}, high{0.0};
};

/// Values of experts at [low, high) from a structure.
struct SafeBin {
  double low{0.0}, high{0.0};  // [m]
  std::size_t removals{0};
  std::size_t participants{0};
  std::optional<SafeRange> force;  // [N]; nothing where there were fewer than SafeOptions::fewest
  std::optional<SafeRange> speed;  // [m/s]; likewise
};

struct SafeProfile {
  std::string structure;
  std::vector<SafeBin> bins;

  /// Nothing out of reach.
  const SafeBin* at(double distance) const noexcept;
};

/// Greatest safe forces and speeds, learned from experts: by structure and distance the quantiles
/// over their removals, of which each counts for the structure that was nearest to it. In a bin
/// every participant weighs the same, however many removals there are; the quantile of p is the
/// smallest value up to which a share of at least p lies.
/// @param names  that NearestRemoval::structure counts
/// Source: Morris 2006, §3.5.2.
std::vector<SafeProfile> learn_safe_values(std::span<const SafeCase> experts,
                                           std::span<const std::string> names,
                                           const SafeOptions& options = {});

}  // namespace haptrial::analysis::drilling
