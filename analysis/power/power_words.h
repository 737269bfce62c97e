#pragma once

#include <string>
#include <vector>

#include "analysis/power/power_result.h"
#include "analysis/power/smallest_n.h"

namespace haptrial::analysis {

/// "0.812 (0.786 to 0.836)", "not made".
std::string share_words(const TestCount& count);
/// "compatible with its level", "rejects too often", "rejects too seldom", "not known".
std::string level_words(Level level);
/// Word for rejections of the watched test: "power", or that they are none, with the true rate.
std::string verdict(const PowerResult& result);
/// 0.0123 ± 0.0004, with the Monte Carlo standard error.
std::string mean_words(const RunningMean& mean);

/// The cells of one combination of all keys but one, by its rising levels.
struct PowerLine {
  std::string name;  // "observer.drift 0.01"; empty: there are no other keys
  std::vector<double> x;
  std::vector<const PowerCell*> cells;
};
std::vector<PowerLine> lines_over(const PowerResult& result, std::size_t key);

/// A line for each combination: how many participants the target takes, or that it was not met.
std::vector<std::string> size_lines(const PowerResult& result);

}  // namespace haptrial::analysis
