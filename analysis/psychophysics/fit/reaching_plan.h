#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/definition/schema_forward.h"

namespace haptrial::analysis::trials {

/// Names of a definition that the analysis of reaches may use.
struct ReachingNames {
  std::vector<std::string> stages;
  std::vector<std::string> places;
  std::vector<std::string> fields;  // of type matrix_viscous
  std::size_t combinations{8};      // of the factors: as many trials as make a cycle
};

/// A number of a reach that conditions may be compared in.
enum class ReachQuantity : std::uint8_t {
  kError,              // that learning is about, turned [m]
  kMovementTime,       // [s]
  kPeakSpeed,          // [m/s]
  kDirection,          // at 150 ms, turned [rad]
  kArea,               // turned [m²]
  kForceCompensation,  // of reaches in a channel
  kThroughput,         // of reaches to targets, see throughput() [bit/s]
};

/// Which cycles of a block such a comparison takes.
enum class ReachCycles : std::uint8_t { kAll, kFirst, kLast };

/// Content of [analysis] of kind "reaching".
struct ReachingPlan {
  std::string stage{"reach"};
  std::string start{"start"};    // a place
  std::string target{"target"};  // likewise
  std::string field;             // that is learnt; empty: the definition has none
  std::string clamp{"clamp"};    // probe
  std::size_t cycle{8};          // trials
  bool at_150_ms{false};         // the error that is learnt from; else the largest
  std::size_t resamples{1999};   // of participants
  std::vector<ReachQuantity> quantities{ReachQuantity::kError};  // compared between conditions
  ReachCycles cycles{ReachCycles::kAll};                         // of each block, for that
  std::uint64_t seed{1};
};

/// Reads the keys of [analysis] of kind "reaching", all of which may be left out. Problems are
/// noted.
ReachingPlan read_reaching_plan(Table& table, const ReachingNames& names);

}  // namespace haptrial::analysis::trials
