#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "analysis/psychophysics/study/cue_study.h"
#include "tests/analysis/psychophysics/study/simulated_cues.h"

namespace haptrial::test {

/// Functions of all conditions, fitted and compared.
analysis::trials::CueStudy studied(const analysis::trials::TrialsData& data,
                                   const analysis::trials::TrialsPlan& plan);

/// A test of the comparison of cues in many studies.
struct NullCueTest {
  std::string name;
  std::size_t found{0};         // studies with p < 0.05
  std::size_t replications{0};  // in which it is defined
  double mean{0.0};             // difference that it compares, over studies
  double error{0.0};            // standard error of that mean
};

struct NullCues {
  std::array<NullCueTest, 3> tests;

  /// @throws std::out_of_range for a name that no test has.
  const NullCueTest& of(const std::string& name) const;
};

/// Studies of 8 people who use two cues in one way (simulated_cues.h).
NullCues null_cues(CueUse use, std::size_t replications, std::uint64_t seed, int threads);

}  // namespace haptrial::test
