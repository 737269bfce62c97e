#pragma once

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

namespace haptrial::test {

/// How often a test was below 0.05 in null studies, in which nothing has an effect.
struct NullLevel {
  std::string test;
  bool leads{false};  // a report's first lines rest on it
  std::size_t found{0};
  std::size_t replications{0};
};

/// Levels in the order in which tests were first noted.
class NullLevels {
 public:
  void note(const std::string& test, bool leads, bool found) {
    add({test, leads, found ? std::size_t{1} : std::size_t{0}, 1});
  }

  void add(const NullLevel& level) {
    const auto at = std::find_if(levels_.begin(), levels_.end(),
                                 [&](const NullLevel& own) { return own.test == level.test; });
    if (at == levels_.end()) {
      levels_.push_back(level);
    } else {
      at->found += level.found;
      at->replications += level.replications;
    }
  }

  const std::vector<NullLevel>& all() const { return levels_; }

 private:
  std::vector<NullLevel> levels_;
};

/// Sum over null studies 0, 1, ...
/// @param study  (number) -> NullLevels; called from several threads at once
template <class Study>
std::vector<NullLevel> null_levels(std::size_t replications, int threads, Study&& study) {
  std::vector<NullLevels> each(replications);
  {
    std::vector<std::jthread> workers;
    for (int t = 0; t < threads; ++t) {
      workers.emplace_back([&, t] {
        for (auto i = static_cast<std::size_t>(t); i < replications;
             i += static_cast<std::size_t>(threads)) {
          each[i] = study(i);
        }
      });
    }
  }
  NullLevels sum;
  for (const NullLevels& levels : each) {
    for (const NullLevel& level : levels.all()) {
      sum.add(level);
    }
  }
  return sum.all();
}

/// Bounds of the number of rejections at 0.05 that chance leaves with this probability.
struct Band {
  std::size_t low{0}, high{0};
};

inline Band binomial_band(std::size_t replications, double probability) {
  constexpr double kAlpha = 0.05;
  const auto n = static_cast<unsigned>(replications);
  const double rest = 0.5 * (1.0 - probability);
  Band band{0, replications};
  while (gsl_cdf_binomial_P(static_cast<unsigned>(band.low), kAlpha, n) < rest) {
    ++band.low;
  }
  while (band.high > 0 &&
         gsl_cdf_binomial_Q(static_cast<unsigned>(band.high - 1), kAlpha, n) < rest) {
    --band.high;
  }
  return band;
}

/// How many null studies a test counts: `usually`, or 2,000 with HAPTRIAL_EVERY_STUDY set.
inline std::size_t null_studies(std::size_t usually) {
  return std::getenv("HAPTRIAL_EVERY_STUDY") != nullptr ? 2000 : usually;
}

}  // namespace haptrial::test
