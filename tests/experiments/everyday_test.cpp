// Experiments that laboratories run every day, as docs/worked/everyday states them: each is valid,
// is rehearsed by virtual participants without a lost trial, and its report finds what is computed
// here anew from trials.csv.

#include "tests/experiments/everyday.h"

#include <Eigen/Dense>
#include <array>
#include <numbers>

namespace haptrial::everyday_test {
namespace {

using testing::Each;

TEST_F(EverydayTest, VibrotactileFrequency) {
  rehearse("vibrotactile_frequency", 2);
  expect_staircases({3, 2, 100.0}, 2);
}

TEST_F(EverydayTest, Oddity) {
  rehearse("oddity", 2);
  expect_staircases({2, 2, 300.0}, 2);
  EXPECT_NEAR(results_["function"]["guess"], 1.0 / 3.0, 1e-12);
}

TEST_F(EverydayTest, BimanualSize) {
  rehearse("bimanual_size", 2);
  expect_staircases({1, 2, 0.0, false}, 4);
  EXPECT_NEAR(reported("threshold"), 0.03, 0.004) << "nobody is biased";
}

TEST_F(EverydayTest, Duration) {
  rehearse("duration", 3);
  EXPECT_NEAR(reported("threshold"), 0.4, 0.02) << "equal to the standard";
  EXPECT_NEAR(reported("difference_limen"), 0.6745 * std::numbers::sqrt2 * 0.1 * 0.4, 0.01)
      << "each vibration is felt with a tenth";
}

/// The chord is 80 mm long, the bow 95 mm; the virtual hand gives way to both fixtures in part.
TEST_F(EverydayTest, GuidedPath) {
  rehearse("guided_path", 3);
  std::map<std::string, double> path;
  for (const json& condition : results_.at("quantities").at(0).at("conditions")) {
    path[condition.at("condition")] = condition.at("mean").at("mean");
  }
  EXPECT_THAT(path, testing::SizeIs(3));
  EXPECT_NEAR(path["free"], 0.08 - 0.004, 0.003) << "from start to the near side of the goal";
  EXPECT_GT(path["curve"], path["free"] + 0.003);
  EXPECT_GT(path["region"], path["free"] + 0.0003);
}

TEST_F(EverydayTest, GripStiffness) {
  rehearse("grip_stiffness", 2);
  expect_staircases({2, 2, 300.0}, 2);
}

/// The second block presents multiples of what the first one found.
TEST_F(EverydayTest, Titration) {
  rehearse("titration", 2);
  expect_staircases({2, 4, 0.0}, 2);
  for (const auto& [of, threshold] : estimates()) {
    for (const Row& row : trials_[of.first]) {
      if (row.at("block.name") == "use") {
        EXPECT_NEAR(number_in(row, "strength"), number_in(row, "times") * threshold, 1e-9);
      }
    }
  }
}

/// Middles of the last two levels of each series, whose means of both directions are averaged. A
/// series without a change of the answer has no middle.
double limit_of(const std::vector<Row>& rows) {
  std::vector<double> ends[2];
  double before = NAN;
  int series = 0;
  for (const Row& row : rows) {
    const double level = number_in(row, "level");
    const bool descends = series % 2 == 0;
    const bool changed = (row.at("felt.text") == "yes") != descends;
    if (changed && std::isfinite(before)) {
      ends[descends ? 0 : 1].push_back(0.5 * (before + level));
    }
    const bool over = changed || std::abs(level - (descends ? 0.0 : 0.8)) < 1e-9;
    series += over ? 1 : 0;
    before = over ? NAN : level;
  }
  EXPECT_EQ(series, 8);
  return 0.5 * (mean_of(ends[0]) + mean_of(ends[1]));
}

TEST_F(EverydayTest, MethodOfLimits) {
  rehearse("method_of_limits", 3);
  EXPECT_NEAR(reported("setting"), over_participants(limit_of), 1e-9);
}

/// The levels at which the participant was content.
double setting_of(const std::vector<Row>& rows) {
  std::vector<double> settings;
  for (const Row& row : rows) {
    if (row.at("change.text") == "alike") {
      settings.push_back(number_in(row, "level"));
    }
  }
  EXPECT_EQ(settings.size(), 8U);
  return mean_of(settings);
}

TEST_F(EverydayTest, StiffnessMatching) {
  rehearse("stiffness_matching", 3);
  EXPECT_NEAR(reported("setting"), over_participants(setting_of), 1e-6);
}

/// @param said  the response that is a magnitude
double exponent_of(const std::vector<Row>& rows, const std::string& said) {
  std::vector<double> levels, magnitudes;
  for (const Row& row : rows) {
    levels.push_back(std::log(number_in(row, "level")));
    magnitudes.push_back(std::log(number_in(row, said)));
  }
  return slope_of(levels, magnitudes);
}

TEST_F(EverydayTest, RoughnessMagnitude) {
  rehearse("roughness_magnitude", 3);
  const auto exponent = [](const std::vector<Row>& rows) { return exponent_of(rows, "roughness"); };
  EXPECT_NEAR(reported("exponent"), over_participants(exponent), 1e-9);
  EXPECT_NEAR(reported("exponent"), 0.8, 0.2) << "as the virtual participants have it";
}

/// The hand rounds to a hundredth of its line, and moves with noise.
TEST_F(EverydayTest, ViscosityByScale) {
  rehearse("viscosity_by_scale", 3);
  const auto exponent = [](const std::vector<Row>& rows) {
    return exponent_of(rows, "resistance");
  };
  EXPECT_NEAR(reported("exponent"), over_participants(exponent), 1e-9);
  EXPECT_NEAR(reported("exponent"), 0.6, 0.15) << "as the virtual participants have it";
  for (const Row& row : trials_["S01"]) {
    EXPECT_EQ(number_in(row, "resistance"), std::round(number_in(row, "resistance")));
    EXPECT_GT(number_in(row, "resistance.rt"), 1.0) << "a way of the hand and a rest";
  }
}

double slope_over(const std::vector<Row>& rows, const std::string& level,
                  const std::string& stage) {
  std::vector<double> levels, times;
  for (const Row& row : rows) {
    levels.push_back(number_in(row, level));
    times.push_back(number_in(row, stage));
  }
  return slope_of(levels, times);
}

TEST_F(EverydayTest, FittsPointing) {
  rehearse("fitts_pointing", 3);
  for (const char* assistance : {"free", "spring"}) {
    const auto slope = [](const std::vector<Row>& rows) {
      return slope_over(rows, "difficulty", "reach.1.s");
    };
    EXPECT_NEAR(reported("slope", assistance), over_participants(slope, "assistance", assistance),
                1e-6);
  }
  for (const Row& row : trials_["S01"]) {
    EXPECT_NEAR(number_in(row, "difficulty"),
                std::log2(number_in(row, "distance") / number_in(row, "width") + 1.0), 1e-9);
  }
}

/// Every ball takes as long, and the one that is sought lies in the middle or at the end.
TEST_F(EverydayTest, HapticSearch) {
  rehearse("haptic_search", 2);
  const auto slope = [](const std::vector<Row>& rows) {
    return slope_over(rows, "items", "search.1.s");
  };
  EXPECT_NEAR(reported("slope"), over_participants(slope), 1e-6);
  EXPECT_NEAR(reported("slope"), 0.75 * 0.9, 0.05) << "0.9 s for each ball, 3/4 of them are felt";
}

TEST_F(EverydayTest, CrossmodalCongruency) {
  rehearse("crossmodal_congruency", 3);
  const auto time = [](const std::vector<Row>& rows) {
    std::vector<double> times;
    for (const Row& row : rows) {
      if (row.at("where.correct") == "1") {
        times.push_back(number_in(row, "where.rt"));
      }
    }
    return mean_of(times);
  };
  const auto wrong = [](const std::vector<Row>& rows) {
    std::vector<double> each;
    for (const Row& row : rows) {
      each.push_back(1.0 - number_in(row, "where.correct"));
    }
    return mean_of(each);
  };
  for (const char* level : {"congruent", "incongruent"}) {
    EXPECT_NEAR(reported("reaction_time", level), over_participants(time, "congruency", level),
                1e-6);
    EXPECT_NEAR(reported("share_wrong", level), over_participants(wrong, "congruency", level),
                1e-9);
  }
  EXPECT_EQ(quantity("reaction_time")["tests"]["planned"].size(), 1U);
}

/// Rates with 1/2 added to hits and false alarms, 1 to their trials (Hautus 1995).
TEST_F(EverydayTest, GoNoGo) {
  rehearse("go_no_go", 3);
  const auto d_prime = [](const std::vector<Row>& rows) {
    double presses[2] = {0.5, 0.5}, trials[2] = {1.0, 1.0};
    for (const Row& row : rows) {
      const int go = row.at("tap") == "go" ? 1 : 0;
      trials[go] += 1.0;
      presses[go] += row.at("pressed.text") == "go" ? 1.0 : 0.0;
    }
    return normal_quantile(presses[1] / trials[1]) - normal_quantile(presses[0] / trials[0]);
  };
  EXPECT_NEAR(reported("d_prime"), over_participants(d_prime), 1e-6);
  for (const Row& row : trials_["S01"]) {
    EXPECT_EQ(row.at("pressed.rt").empty(), row.at("pressed.text") == "no_go") << "silence";
  }
}

/// The point of Spearman and Kaerber: the mean of the levels at which answers change.
TEST_F(EverydayTest, TemporalOrder) {
  rehearse("temporal_order", 3);
  const auto middle = [](const std::vector<Row>& rows) {
    std::map<double, std::vector<double>> shares;
    for (const Row& row : rows) {
      shares[number_in(row, "onset")].push_back(row.at("first.text") == "left" ? 1.0 : 0.0);
    }
    double sum = 0.0, below = 0.0, before = -0.3;
    for (const auto& [onset, answers] : shares) {
      sum += (mean_of(answers) - below) * 0.5 * (before + onset);
      below = mean_of(answers);
      before = onset;
    }
    return sum + (1.0 - below) * 0.5 * (before + 0.3);
  };
  for (const char* block : {"uncrossed", "crossed"}) {
    EXPECT_NEAR(reported("threshold", block), over_participants(middle, "block.name", block), 0.02);
  }
  EXPECT_EQ(quantity("difference_limen")["unit"], "s");
  EXPECT_NEAR(reported("difference_limen", "uncrossed"), 0.6745 * 0.05, 0.012);
  EXPECT_NEAR(reported("difference_limen", "crossed"), 0.6745 * 0.11, 0.03);
}

/// The level at which a line between shares at listed levels crosses three quarters.
double crossing_of(const std::vector<Row>& rows) {
  std::map<double, std::vector<double>> right;
  for (const Row& row : rows) {
    right[number_in(row, "level")].push_back(number_in(row, "stiffer.correct"));
  }
  double level = 300.0, share = 0.5;
  for (const auto& [next, answers] : right) {
    if (mean_of(answers) > 0.75) {
      return level + (next - level) * (0.75 - share) / (mean_of(answers) - share);
    }
    level = next;
    share = mean_of(answers);
  }
  return NAN;
}

TEST_F(EverydayTest, DualTask) {
  rehearse("dual_task", 2);
  for (const char* block : {"easy", "hard"}) {
    const double level = over_participants(crossing_of, "block.name", block);
    EXPECT_NEAR(std::exp(reported("threshold", block)), level, 0.1 * level);
  }
  std::map<std::string, int> wrong;
  for (const Row& row : trials_["S01"]) {
    wrong[row.at("block.name")] += row.at("heard.correct") == "0" ? 1 : 0;
  }
  EXPECT_GT(wrong["hard"], wrong["easy"]) << "as the script has it";
}

TEST_F(EverydayTest, MassDiscrimination) {
  rehearse("mass_discrimination", 2);
  for (const auto& [of, threshold] : estimates()) {
    int right = 0, trials = 0;
    for (const Row& row : trials_[of.first]) {
      const bool own = row.at("track") == of.second;
      trials += own ? 1 : 0;
      right += own && row.at("heavier.correct") == "1" ? 1 : 0;
    }
    EXPECT_EQ(trials, 40);
    EXPECT_GT(right, 26) << "QUEST+ asks where most is right";
    EXPECT_GT(threshold, 0.03);
    EXPECT_LT(threshold, 0.4);
  }
}

TEST_F(EverydayTest, ForceMatching) {
  rehearse("force_matching", 2);
  for (const auto& [participant, rows] : trials_) {
    std::map<std::string, int> trials;
    for (const Row& row : rows) {
      ++trials[row.at("target")];
      EXPECT_NEAR(number_in(row, "match.1.s"), 3.0, 0.002);
    }
    EXPECT_THAT(trials, testing::SizeIs(4));
    EXPECT_THAT(trials, Each(testing::Pair(testing::_, 10)));
  }
  // The virtual hand presses with 1.3 N, whatever was felt.
  for (const json& quantity : results_.at("quantities")) {
    for (const json& condition : quantity.at("conditions")) {
      const double target = std::stod(condition.at("condition").get<std::string>());
      const std::string name = quantity.at("name");
      const double expected = name == "produced"         ? 1.3
                              : name == "constant_error" ? 1.3 - target
                              : name == "absolute_error" ? std::abs(1.3 - target)
                                                         : 0.03;
      EXPECT_NEAR(condition.at("mean").at("mean").get<double>(), expected, 0.04)
          << name << " of " << target;
    }
  }
  EXPECT_EQ(results_.at("quantities").size(), 4u);
}

/// Worth of an item in the choices of a participant, climbed along the likelihood's score and the
/// correction of its bias (Kosmidis and Firth 2009).
double worth_of(const std::vector<Row>& rows, char item) {
  Eigen::Matrix4d wins = Eigen::Matrix4d::Zero();
  for (const Row& row : rows) {
    const int one = row.at("first")[0] - 'A', other = row.at("second")[0] - 'A';
    wins(one, other) += row.at("stiffer.correct") == "1" ? 1.0 : 0.0;
    wins(other, one) += row.at("stiffer.correct") == "1" ? 0.0 : 1.0;
  }
  Eigen::Vector4d worth = Eigen::Vector4d::Zero();
  for (int step = 0; step < 4000; ++step) {
    Eigen::Matrix4d information = Eigen::Matrix4d::Ones();
    std::vector<std::pair<Eigen::Vector4d, double>> pairs;  // with their weights
    Eigen::Vector4d slope = Eigen::Vector4d::Zero();
    for (int i = 0; i < 4; ++i) {
      for (int k = 0; k < i; ++k) {
        const Eigen::Vector4d x = Eigen::Vector4d::Unit(i) - Eigen::Vector4d::Unit(k);
        const double d = x.dot(worth);
        const double density = std::exp(-0.5 * d * d) / std::sqrt(2.0 * M_PI);
        const double p = 0.5 * std::erfc(-d / std::sqrt(2.0)), q = 1.0 - p;
        const double weight = (wins(i, k) + wins(k, i)) * density * density / (p * q);
        information += weight * x * x.transpose();
        slope += (wins(i, k) / p - wins(k, i) / q) * density * x;
        pairs.emplace_back(x, weight);
      }
    }
    const Eigen::Matrix4d inverse = information.inverse();
    for (const auto& [x, weight] : pairs) {
      slope -= 0.5 * weight * x.dot(inverse * x) * x.dot(worth) * x;
    }
    worth += 0.01 * slope;
  }
  return worth[item - 'A'];
}

TEST_F(EverydayTest, StiffnessPairs) {
  rehearse("stiffness_pairs", 3);
  for (const char item : {'A', 'B', 'C', 'D'}) {
    const std::string name(1, item);
    EXPECT_NEAR(reported("worth", name),
                over_participants([&](const auto& rows) { return worth_of(rows, item); }), 1e-6);
    const auto share = [&](const std::vector<Row>& rows) {
      double met = 0.0, chosen = 0.0;
      for (const Row& row : rows) {
        const bool first = row.at("first") == name, second = row.at("second") == name;
        met += first || second ? 1.0 : 0.0;
        chosen += (first && row.at("stiffer.correct") == "1") ||
                          (second && row.at("stiffer.correct") == "0")
                      ? 1.0
                      : 0.0;
      }
      return chosen / met;
    };
    EXPECT_NEAR(reported("share_chosen", name), over_participants(share), 1e-12);
  }
  EXPECT_GT(reported("worth", "D"), reported("worth", "A"));
}

/// Each rendering is named by the error of its force; people who judge by that error choose the one
/// with less.
TEST_F(EverydayTest, RenderingRealism) {
  rehearse("rendering_realism", 3);
  const std::array<std::string, 4> by_error{"0.07 N (0.06; 8 of 100), friction that fits",
                                            "0.12 N (0.12; 98 of 100), half the friction",
                                            "0.22 N (0.22; 98 of 100), no friction",
                                            "0.41 N (0.41; 99 of 100), three times the friction"};
  for (std::size_t i = 1; i < by_error.size(); ++i) {
    EXPECT_GT(reported("worth", by_error[i - 1]), reported("worth", by_error[i])) << by_error[i];
  }
  const auto share = [&](const std::vector<Row>& rows) {
    double met = 0.0, chosen = 0.0;
    for (const Row& row : rows) {
      const bool first = row.at("first") == by_error[1], second = row.at("second") == by_error[1];
      met += first || second ? 1.0 : 0.0;
      chosen +=
          (first && row.at("real.correct") == "1") || (second && row.at("real.correct") == "0")
              ? 1.0
              : 0.0;
    }
    return chosen / met;
  };
  EXPECT_NEAR(reported("share_chosen", by_error[1]), over_participants(share), 1e-12);
}

/// No definition of the folder is without a test.
TEST(EverydayFolderTest, EveryDefinitionIsRehearsed) {
  std::string tests;
  for (const auto& entry :
       std::filesystem::directory_iterator(HAPTRIAL_SOURCE_DIR "/tests/experiments")) {
    if (entry.path().extension() == ".cpp") {
      tests += test::read_text(entry.path());
    }
  }
  for (const auto& entry : std::filesystem::directory_iterator(kFolder)) {
    if (entry.path().extension() == ".toml") {
      const std::string name = entry.path().stem().string();
      EXPECT_THAT(tests, testing::AnyOf(HasSubstr("rehearse(\"" + name + "\""),
                                        HasSubstr("everyday/" + name + ".toml")));
    }
  }
}

}  // namespace
}  // namespace haptrial::everyday_test
