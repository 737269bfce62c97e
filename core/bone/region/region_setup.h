#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/definition/given_in.h"
#include "core/base/definition/schema_forward.h"

namespace haptrial::bone {

/// How a forbidden region keeps a burr away: by a spring that gives way, by one that hardly does,
/// or by a chime alone.
enum class RegionKind : std::uint8_t { kSoft, kHard, kSound };

/// The condition of trials with forbidden regions: "regions on".
inline constexpr const char* kRegions = "regions";

/// The margins around structures that a burr is to keep out of ([forbidden]). Crossings are
/// recorded in all trials; force and chime are given in some.
struct RegionSetup {
  std::vector<std::string> structures;
  double margin{2e-3};  // of bone around each >= 0 [m]
  RegionKind kind{RegionKind::kSoft};
  std::optional<double> stiffness;    // > 0; default: by kind [N/m]
  std::optional<double> force_limit;  // of one structure's region > 0; default: by kind [N]
  GivenIn given{GivenIn::kAll};

  /// Stiffness and greatest force of a region; 0 of one that only sounds.
  double spring() const noexcept;      // [N/m]
  double most_force() const noexcept;  // [N]
};

/// The keys of [forbidden].
const Schema<RegionSetup>& region_schema();

}  // namespace haptrial::bone
