#include "analysis/score_parameters.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace haptrial::analysis {
namespace {

constexpr int kMostSamples = 10000;
constexpr double kWidestFilter = 10.0;
constexpr Bounds kWeight{0.0, 1e6};

bool is_within(double value, const Bounds& bounds) {
  return value >= bounds.low && value <= bounds.high;
}

}  // namespace

ScoreParameters read_score_parameters(Table& analysis) {
  ScoreParameters p;
  p.samples = static_cast<int>(analysis.integer("samples", 2, kMostSamples));
  p.filter_width = analysis.number("filter_width", {0.0, kWidestFilter}, "s");
  p.alignment.power = static_cast<int>(analysis.integer("power", 1, 2));
  const bool square = p.alignment.power == 2;
  p.alignment.force_weight = analysis.number("force_weight", kWeight, square ? "1/N²" : "1/N");
  p.alignment.slope_weight = analysis.number("slope_weight", kWeight, square ? "s²/N²" : "s/N");
  p.alignment.penalty = analysis.number("penalty", kWeight, "");
  p.cost_share = analysis.number("cost_share", kWeight, "");
  p.force_share = analysis.number("force_share", kWeight, "1/N");
  p.slope_share = analysis.number("slope_share", kWeight, "s/N");
  const bool all_there =
      analysis.has("cost_share") && analysis.has("force_share") && analysis.has("slope_share");
  if (all_there && p.cost_share + p.force_share + p.slope_share == 0.0) {
    analysis.reject("cost_share", "0 as are force_share and slope_share",
                    "at least one share above 0");
  }
  return p;
}

void check(const ScoreParameters& p) {
  const auto require = [](bool holds, const std::string& sentence) {
    if (!holds) throw std::invalid_argument("score: " + sentence);
  };
  require(p.samples >= 2 && p.samples <= kMostSamples, "samples must be 2 to 10,000");
  require(is_within(p.filter_width, {0.0, kWidestFilter}), "filter_width must be 0 to 10 s");
  require(p.alignment.power == 1 || p.alignment.power == 2, "power must be 1 or 2");
  require(is_within(p.alignment.force_weight, kWeight), "force_weight must be 0 to 1e6");
  require(is_within(p.alignment.slope_weight, kWeight), "slope_weight must be 0 to 1e6");
  require(is_within(p.alignment.penalty, kWeight), "penalty must be 0 to 1e6");
  require(is_within(p.cost_share, kWeight), "cost_share must be 0 to 1e6");
  require(is_within(p.force_share, kWeight), "force_share must be 0 to 1e6");
  require(is_within(p.slope_share, kWeight), "slope_share must be 0 to 1e6");
  require(p.cost_share + p.force_share + p.slope_share > 0.0, "at least one share must be above 0");
}

}  // namespace haptrial::analysis
