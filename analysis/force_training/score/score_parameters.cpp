#include "analysis/force_training/score/score_parameters.h"

#include <fmt/format.h>

#include <stdexcept>

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

std::vector<std::pair<std::string, StepPattern>> patterns() {
  std::vector<std::pair<std::string, StepPattern>> words;
  for (const std::string& name : pattern_names()) {
    words.emplace_back(name, pattern_of(name).value_or(StepPattern::kPublished));
  }
  return words;
}

/// The keys of the alignment.
const Schema<AlignmentOptions>& alignment_schema() {
  using A = AlignmentOptions;
  static const auto schema =
      Schema<A>()
          .number("power", &A::power, kPower, "",
                  "Power to which differences of force and slope are raised")
          .required()
          .custom("force_weight", "Weight of a difference of force in the error matrix",
                  [](Table& table, const std::string& key, A& a) {
                    a.force_weight = table.number(key, kWeight, "1/N" + exponent(a.power));
                  })
          .required()
          .custom("slope_weight", "Weight of a difference of slope in the error matrix",
                  [](Table& table, const std::string& key, A& a) {
                    const std::string raised = exponent(a.power);
                    a.slope_weight = table.number(key, kWeight, fmt::format("s{0}/N{0}", raised));
                  })
          .required()
          .number("penalty", &A::penalty, kWeight, "",
                  "Penalty of a step of the alignment along one curve alone")
          .required()
          .choice("step_pattern", &A::pattern, patterns(), "Steps that the alignment may take")
          .flag("open_begin", &A::open_begin, "Whether the applied curve may begin late")
          .flag("open_end", &A::open_end, "Whether the applied curve may end early")
          .check([](Table& table, const A& a) {
            if (a.open_begin && doubles_straight(a.pattern)) {
              table.reject("open_begin",
                           fmt::format("is true with the step pattern {}; choose published, "
                                       "symmetric1 or asymmetric",
                                       name_of(a.pattern)));
            }
          });
  return schema;
}

/// The keys of the shares.
void add_shares(Schema<ScoreParameters>& schema) {
  using P = ScoreParameters;
  schema
      .number("cost_share", &P::cost_share, kWeight, "",
              "Share of the alignment's cost in the score")
      .required()
      .number("force_share", &P::force_share, kWeight, "1/N",
              "Share of the difference of force in the score")
      .required()
      .number("slope_share", &P::slope_share, kWeight, "s/N",
              "Share of the difference of slope in the score")
      .required()
      .check([](Table& table, const P& p) {
        const bool all_there =
            table.has("cost_share") && table.has("force_share") && table.has("slope_share");
        if (all_there && p.cost_share + p.force_share + p.slope_share == 0.0) {
          table.reject("cost_share",
                       "is 0, like force_share and slope_share; set at least one of them "
                       "above 0");
        }
      });
}

const Schema<ScoreParameters>& shares_schema() {
  static const auto schema = [] {
    Schema<ScoreParameters> shares;
    add_shares(shares);
    return shares;
  }();
  return schema;
}

}  // namespace

const Schema<ScoreParameters>& score_schema() {
  using P = ScoreParameters;
  static const auto schema = [] {
    Schema<P> all;
    all.integer("samples", &P::samples, 2, kMostSamples,
                "Samples of the time base on which curves are compared")
        .required()
        .number("filter_width", &P::filter_width, {0.0, kWidestFilter}, "s",
                "Width of the box filter on the applied force")
        .required()
        .keys_of(&P::alignment, alignment_schema())
        .number("window", &P::window, kNonNegative, "s",
                "Greatest difference in time that the alignment may make")
        .otherwise("no window");
    add_shares(all);
    return all;
  }();
  return schema;
}

ScoreParameters with_shares_of(const std::filesystem::path& file, ScoreParameters parameters) {
  Table root = Table::load(file);
  Table analysis = root.table("analysis");
  shares_schema().read(analysis, parameters);
  root.check();
  return parameters;
}

ScoreParameters read_scoring(Table& root, Table& analysis) {
  ScoreParameters p = score_schema().read(analysis);
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
