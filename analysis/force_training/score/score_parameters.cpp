#include "analysis/force_training/score/score_parameters.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <string>

namespace haptrial::analysis {
namespace {

constexpr int kMostSamples = 10000;
constexpr double kWidestFilter = 10.0;
constexpr Bounds kWeight{0.0, 1e6};
constexpr Bounds kPower{1.0, 100.0};

bool is_within(double value, const Bounds& bounds) {
  return value >= bounds.low && value <= bounds.high;
}

/// Exponent as it stands after a unit that is raised to the power.
std::string exponent(double power) {
  return power == 1.0 ? "" : power == 2.0 ? "²" : fmt::format("^{}", power);
}

/// The keys that the published form does not need.
void read_form(Table& analysis, ScoreParameters& p) {
  if (analysis.has("step_pattern")) {
    const std::string name = analysis.choice("step_pattern", pattern_names());
    p.alignment.pattern = pattern_of(name).value_or(StepPattern::kPublished);
  }
  if (analysis.has("window")) {
    p.window = analysis.number("window", kNonNegative, "s");
  }
  if (analysis.has("open_begin")) {
    p.alignment.open_begin = analysis.boolean("open_begin");
  }
  if (analysis.has("open_end")) {
    p.alignment.open_end = analysis.boolean("open_end");
  }
  if (p.alignment.open_begin && doubles_straight(p.alignment.pattern)) {
    analysis.reject(
        "open_begin",
        fmt::format("is true with the step pattern {}; choose published, symmetric1 or asymmetric",
                    name_of(p.alignment.pattern)));
  }
}

}  // namespace

ScoreParameters read_score_parameters(Table& analysis) {
  ScoreParameters p;
  p.samples = static_cast<int>(analysis.integer("samples", 2, kMostSamples));
  p.filter_width = analysis.number("filter_width", {0.0, kWidestFilter}, "s");
  p.alignment.power = analysis.number("power", kPower, "");
  const std::string raised = exponent(p.alignment.power);
  p.alignment.force_weight = analysis.number("force_weight", kWeight, "1/N" + raised);
  p.alignment.slope_weight =
      analysis.number("slope_weight", kWeight, fmt::format("s{0}/N{0}", raised));
  p.alignment.penalty = analysis.number("penalty", kWeight, "");
  read_form(analysis, p);
  p.cost_share = analysis.number("cost_share", kWeight, "");
  p.force_share = analysis.number("force_share", kWeight, "1/N");
  p.slope_share = analysis.number("slope_share", kWeight, "s/N");
  const bool all_there =
      analysis.has("cost_share") && analysis.has("force_share") && analysis.has("slope_share");
  if (all_there && p.cost_share + p.force_share + p.slope_share == 0.0) {
    analysis.reject("cost_share",
                    "is 0, like force_share and slope_share; set at least one of them above 0");
  }
  return p;
}

ScoreParameters read_scoring(Table& root, Table& analysis) {
  ScoreParameters p = read_score_parameters(analysis);
  Table guidance = root.table("guidance");
  p.over_path = guidance.has("kind") && guidance.choice("kind", {"trajectory", "curve"}) == "curve";
  p.free_path = guidance.has("recall") && guidance.choice("recall", {"guided", "free"}) == "free";
  return p;
}

std::vector<std::pair<std::string, std::string>> described(const ScoreParameters& p) {
  const AlignmentOptions& a = p.alignment;
  std::vector<std::pair<std::string, std::string>> rows;
  if (p.over_path) {
    rows.emplace_back("forces are compared over",
                      "the place on the path, as the time that it takes at the definition's speed");
  }
  const std::vector<std::pair<std::string, std::string>> always{
      {"samples of the common time base", fmt::format("{}", p.samples)},
      {"box filter on the applied force", fmt::format("{} s", p.filter_width)},
      {"error matrix: weight of force", fmt::format("{}", a.force_weight)},
      {"error matrix: weight of slope", fmt::format("{}", a.slope_weight)},
      {"error matrix: power", fmt::format("{}", a.power)},
      {"penalty of a step along one curve", fmt::format("{}", a.penalty)}};
  rows.insert(rows.end(), always.begin(), always.end());
  if (a.pattern != StepPattern::kPublished) {
    rows.emplace_back("step pattern", std::string(name_of(a.pattern)));
  }
  if (p.window) {
    rows.emplace_back("window", fmt::format("{} s", *p.window));
  }
  if (a.window) {
    rows.emplace_back("window", fmt::format("{} samples", *a.window));
  }
  if (a.open_begin || a.open_end) {
    rows.emplace_back("open ends", a.open_begin && a.open_end ? "begin and end"
                                   : a.open_begin             ? "begin"
                                                              : "end");
  }
  rows.emplace_back("score: share of the alignment cost", fmt::format("{}", p.cost_share));
  rows.emplace_back("score: share of the force difference", fmt::format("{} /N", p.force_share));
  rows.emplace_back("score: share of the slope difference", fmt::format("{} s/N", p.slope_share));
  return rows;
}

void check(const ScoreParameters& p) {
  const auto require = [](bool holds, const std::string& sentence) {
    if (!holds) {
      throw std::invalid_argument("score: " + sentence);
    }
  };
  require(p.samples >= 2 && p.samples <= kMostSamples, "samples must be 2 to 10,000");
  require(is_within(p.filter_width, {0.0, kWidestFilter}), "filter_width must be 0 to 10 s");
  const std::string problem = problem_of(p.alignment);
  require(problem.empty(), problem);
  require(is_within(p.alignment.force_weight, kWeight), "force_weight must be 0 to 1e6");
  require(is_within(p.alignment.slope_weight, kWeight), "slope_weight must be 0 to 1e6");
  require(is_within(p.alignment.penalty, kWeight), "penalty must be 0 to 1e6");
  require(!p.window || is_within(*p.window, kNonNegative), "window must be at least 0 s");
  require(!p.window || !p.alignment.window, "window must be given in seconds or samples, not both");
  require(is_within(p.cost_share, kWeight), "cost_share must be 0 to 1e6");
  require(is_within(p.force_share, kWeight), "force_share must be 0 to 1e6");
  require(is_within(p.slope_share, kWeight), "slope_share must be 0 to 1e6");
  require(p.cost_share + p.force_share + p.slope_share > 0.0, "at least one share must be above 0");
}

}  // namespace haptrial::analysis
