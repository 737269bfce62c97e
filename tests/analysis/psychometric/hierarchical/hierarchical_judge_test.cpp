#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

#include "analysis/psychometric/hierarchical/hierarchical_fit.h"
#include "tests/support/shared_data.h"

namespace haptrial::analysis::hierarchical {
namespace {

/// Nine people, tactile speed without and with vibration: "faster" as answer 1.
std::vector<PersonAnswers> speed_answers(std::istream& file) {
  std::map<std::pair<std::string, std::string>, std::vector<TrialBlock>> series;
  std::string line;
  for (std::getline(file, line); std::getline(file, line);) {
    std::istringstream cells(line);
    std::vector<std::string> fields;
    for (std::string cell; std::getline(cells, cell, ',');) {
      std::erase(cell, '"');
      fields.push_back(cell);
    }
    const int faster = std::stoi(fields[2]);
    series[{fields[4], fields[1]}].push_back(
        {std::stod(fields[0]), faster, faster + std::stoi(fields[3])});
  }
  std::vector<PersonAnswers> answers;
  std::string before;
  std::size_t people = 0;
  for (const auto& [key, blocks] : series) {
    people += key.first != before ? 1 : 0;
    before = key.first;
    answers.push_back({people - 1, key.second == "0" ? 0U : 1U, blocks});
  }
  return answers;
}

void expect_interval(const Posterior& p, double median, double low, double high) {
  const double deviation = (high - low) / 3.92;
  EXPECT_NEAR(p.median, median, 0.3 * deviation);
  EXPECT_NEAR(p.low, low, 0.6 * deviation);
  EXPECT_NEAR(p.high, high, 0.6 * deviation);
}

// JAGS 4.3, reference/hierarchical.R with the answers of this file.
TEST(HierarchicalJudgeTest, GivesTheAnswersOfJagsForSpeedAndVibration) {
  const auto path = test::shared_data("psychometric/vibro_exp3.csv");
  if (!path) {
    GTEST_SKIP() << "neither HAPTRIAL_DATA nor ../shared/data holds psychometric/vibro_exp3.csv";
  }
  std::ifstream file(*path);
  LikelihoodOptions options{.function = psychometric::parameters_named("norm"),
                            .task = Task::kYesNo,
                            .lapse = {0.0, 0.2},
                            .guess = {0.0, 0.0}};
  const HierarchicalFit fit = hierarchical_fit(Model(speed_answers(file), options), Sampling{});
  ASSERT_TRUE(fit.converged);
  expect_interval(fit.conditions[0].threshold, 8.290, 7.906, 8.650);
  expect_interval(fit.conditions[1].threshold, 8.164, 7.757, 8.551);
  expect_interval(fit.differences[0].threshold, -0.133, -0.545, 0.299);
  expect_interval(fit.conditions[0].width, 12.95, 10.37, 16.02);
  expect_interval(fit.conditions[1].width, 16.44, 13.25, 20.21);
  expect_interval(fit.differences[0].width_ratio, 1.267, 1.109, 1.464);
  expect_interval(fit.log_widths.between, 0.269, 0.159, 0.501);
  expect_interval(fit.lapse, 0.0229, 0.0072, 0.0464);
}

}  // namespace
}  // namespace haptrial::analysis::hierarchical
