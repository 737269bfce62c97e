// Published experiments, as docs/worked/papers states them: each is valid, is rehearsed by virtual
// participants without a lost trial, and its report finds the law by which they answer.

#include <numbers>

#include "tests/experiments/everyday.h"

namespace haptrial::everyday_test {
namespace {

const std::filesystem::path kPapers = HAPTRIAL_SOURCE_DIR "/docs/worked/papers";

class PapersTest : public EverydayTest {
 protected:
  void rehearse_paper(const std::string& name, int participants) {
    rehearse(name, participants, kPapers);
  }
};

TEST_F(PapersTest, VibrationIntensity) {
  rehearse_paper("vibration_intensity", 2);
  expect_staircases({2, 4, 0.0}, 4);
  for (const char* standard : {"1", "4"}) {
    const double at_three_quarters = 0.6745 * std::numbers::sqrt2 * 1.5;
    EXPECT_NEAR(reported("threshold", standard), std::log(at_three_quarters), 0.45)
        << "the same number of decibels at each standard";
  }
}

TEST_F(PapersTest, SizeWeight) {
  rehearse_paper("size_weight", 3);
  EXPECT_NEAR(reported("exponent", "seen"), -0.3, 0.08);
  EXPECT_NEAR(reported("exponent", "unseen"), 0.0, 0.08);
  EXPECT_EQ(quantity("exponent")["tests"]["planned"].size(), 1U);
}

TEST_F(PapersTest, Hardness) {
  rehearse_paper("hardness", 3);
  EXPECT_NEAR(reported("exponent"), 0.8, 0.06);
  const auto softness = [](const std::vector<Row>& rows) {
    std::vector<double> levels, magnitudes;
    for (const Row& row : rows) {
      levels.push_back(std::log(number_in(row, "stiffness")));
      magnitudes.push_back(std::log(number_in(row, "softness")));
    }
    return slope_of(levels, magnitudes);
  };
  EXPECT_NEAR(over_participants(softness), -0.8, 0.06);
}

TEST_F(PapersTest, TactileSuppression) {
  rehearse_paper("tactile_suppression", 2);
  EXPECT_NEAR(reported("threshold", "rest"), 0.25, 0.06);
  EXPECT_NEAR(reported("threshold", "active"), 0.45, 0.06);
  EXPECT_NEAR(reported("threshold", "passive"), 0.45, 0.06);
  EXPECT_EQ(quantity("threshold")["tests"]["planned"].size(), 2U);
}

/// Forces are 0.693 apart on the logarithmic scale, the strongest two 0.511; the criteria are in
/// the middle between neighbours.
/// Entropy of the answers less that which is left where the stimulus is known, of 25 trials each.
double transferred(const json& answers) {
  std::vector<double> of_answer(5, 0.0);
  double left = 0.0, all = 0.0;
  for (std::size_t i = 0; i < 5; ++i) {
    for (std::size_t j = 0; j < 5; ++j) {
      const double p = answers[i][j].get<double>() / 25.0;
      of_answer[j] += p / 5.0;
      left -= p > 0.0 ? p * std::log2(p) / 5.0 : 0.0;
    }
  }
  for (const double p : of_answer) {
    all -= p > 0.0 ? p * std::log2(p) : 0.0;
  }
  return all - left;
}

TEST_F(PapersTest, ForceIdentification) {
  rehearse_paper("force_identification", 3);
  const auto beyond = [](double distance) {  // noise of 0.3 passes the middle to the neighbour
    return 0.5 * std::erfc(0.5 * distance / 0.3 / std::numbers::sqrt2);
  };
  const double apart = beyond(std::log(2.0)), last = beyond(std::log(4.0 / 2.4));
  const double right =
      ((1.0 - apart) + 2.0 * (1.0 - 2.0 * apart) + (1.0 - apart - last) + (1.0 - last)) / 5.0;
  EXPECT_NEAR(reported("share_right"), right, 0.07);
  double bits = 0.0;
  for (const json& participant : results_.at("identification")) {
    bits += transferred(participant["answers"]) / 3.0;
    for (std::size_t i = 0; i < 5; ++i) {
      int trials = 0;
      for (std::size_t j = 0; j < 5; ++j) {
        const int answers = participant["answers"][i][j];
        trials += answers;
        EXPECT_TRUE(answers == 0 || std::max(i, j) - std::min(i, j) < 2) << i << ", " << j;
      }
      EXPECT_EQ(trials, 25);
    }
  }
  EXPECT_NEAR(reported("information_transfer"), bits, 1e-9);
  EXPECT_GT(bits, 1.0);
}

/// The virtual hand stays where it begins, as often 20 mm to the left of the middle as to the
/// right.
TEST_F(PapersTest, LineBisection) {
  rehearse_paper("line_bisection", 2);
  for (const char* middle : {"-0.03", "0", "0.03"}) {
    EXPECT_NEAR(reported("produced", middle), std::stod(middle), 0.002);
    EXPECT_NEAR(reported("constant_error", middle), 0.0, 0.002);
    EXPECT_NEAR(reported("absolute_error", middle), 0.02, 0.002);
  }
}

/// Least-squares slope of the threshold over the width, on logarithms.
TEST_F(PapersTest, BumpHeight) {
  rehearse_paper("bump_height", 2);
  ASSERT_EQ(results_.at("surfaces").size(), 2U);
  for (const json& surface : results_["surfaces"]) {
    std::vector<double> widths, heights;
    for (const json& point : surface["threshold"]) {
      widths.push_back(point["first"]);
      heights.push_back(point["second"][0]);
    }
    EXPECT_NEAR(slope_of(widths, heights), 1.3, 0.35);
    const double middle = std::log(0.0001) + 1.3 * (mean_of(widths) - std::log(0.005));
    EXPECT_NEAR(mean_of(heights), middle, 0.4);
  }
}

/// Two-rate learning of Smith, Ghazizadeh and Shadmehr; errors count only outside of clamps.
class TwoRates {
 public:
  double state() const { return fast_ + slow_; }
  void learn(double error) {
    fast_ = 0.59 * fast_ + 0.21 * error;
    slow_ = 0.992 * slow_ + 0.02 * error;
  }

 private:
  double fast_{0.0}, slow_{0.0};
};

double field_in(const std::string& block) {
  return block == "adaptation" ? 1.0 : block == "opposite" ? -1.0 : 0.0;
}

/// Walls that give way let some be forgotten in clamps, so that less comes back than by the law.
TEST_F(PapersTest, SpontaneousRecovery) {
  rehearse_paper("spontaneous_recovery", 2);
  std::map<std::string, std::vector<double>> recovered, expected;
  std::map<std::string, TwoRates> people;
  for (const Row& row : table_of("reaches.csv")) {
    const std::string& who = row.at("participant");
    const bool clamped = row.at("kind") == "clamp";
    if (row.at("block") == "recovery") {
      EXPECT_TRUE(clamped);
      recovered[who].push_back(number_in(row, "force_compensation"));
      expected[who].push_back(people[who].state());
    }
    people[who].learn(clamped ? 0.0 : field_in(row.at("block")) - people[who].state());
  }
  EXPECT_EQ(recovered.size(), 2U);
  for (const auto& [who, found] : recovered) {
    ASSERT_EQ(found.size(), 60U);
    EXPECT_NEAR(found.front(), expected[who].front(), 0.06) << "the opposite field was learnt";
    for (std::size_t i = 10; i < 40; ++i) {
      EXPECT_GT(found[i], 0.01) << "the first field comes back, reach " << i;
      EXPECT_LT(found[i], expected[who][i] + 0.02);
    }
  }
  EXPECT_GT(reported("force_compensation", "recovery"), 0.02);
}

}  // namespace
}  // namespace haptrial::everyday_test
