#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "analysis/statistics/design/design_tests.h"
#include "analysis/tutoring/led_passes.h"

namespace haptrial::analysis::link {

/// A figure of led passes, above zero, and whether it differs between networks. It is tested on
/// natural logarithms: a hand that is led badly strays by a share of what it strays anyway.
struct LinkQuantity {
  std::string title;
  double LedPass::*of{nullptr};
  DesignTable table;  // participants' means of the logarithm by network
  DesignTests tests;
};

/// The led passes of a study.
struct LinkStudy {
  std::vector<LedPass> passes;           // by file, then in order
  std::vector<std::string> networks;     // by delay, then by name; empty where none is named
  std::vector<LinkQuantity> quantities;  // none with fewer than two networks
  bool simulated{true};
};

/// @param files  of sessions
/// @param seed   of the permutation tests
/// @returns nothing where no session has a link
/// @throws InputError where a file is damaged
std::optional<LinkStudy> link_study(const std::vector<std::filesystem::path>& files,
                                    std::uint64_t seed, int threads);

/// The tests of passes that were read already.
std::vector<LinkQuantity> link_quantities(const std::vector<LedPass>& passes,
                                          const std::vector<std::string>& networks,
                                          const Resampling& resampling);

}  // namespace haptrial::analysis::link
