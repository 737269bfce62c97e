// Every suggestion of the published traces of QUEST+.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <vector>

#include "core/psychometric/procedure/psi_definition.h"
#include "core/psychometric/procedure/quest_plus.h"
#include "tests/support/shared_data.h"

namespace haptrial::psychometric {
namespace {

using Json = nlohmann::json;

/// [2, 3], or "2..5 step 1".
std::vector<double> values_of(const Json& domain) {
  if (domain.is_array()) {
    return domain.get<std::vector<double>>();
  }
  const auto text = domain.get<std::string>();
  const auto dots = text.find("..");
  const auto word = text.find(" step ");
  if (dots == std::string::npos || word == std::string::npos) {
    ADD_FAILURE() << text;
    return {};
  }
  const double first = std::stod(text.substr(0, dots));
  const double last = std::stod(text.substr(dots + 2, word - dots - 2));
  const double step = std::stod(text.substr(word + 6));
  std::vector<double> values;
  for (int i = 0; i <= std::lround((last - first) / step); ++i) {
    values.push_back(first + i * step);
  }
  return values;
}

/// The function as the file states it, on levels in dB.
QuestDefinition as_stated(const Json& domains) {
  QuestDefinition definition;
  definition.stimulus = {{"x", values_of(domains["x"]), {}, false}};
  for (const char* name : {"threshold", "slope", "guess", "lapse"}) {
    definition.parameters.push_back({name, values_of(domains[name]), {}, false});
  }
  definition.model = [](const double* x, const double* p, double* probabilities) {
    const double weibull = std::exp(-std::pow(10.0, p[1] * (x[0] - p[0]) / 20.0));
    probabilities[1] = 1.0 - p[3] - (1.0 - p[2] - p[3]) * weibull;
    probabilities[0] = 1.0 - probabilities[1];
  };
  return definition;
}

std::vector<double> from_decibel(std::vector<double> values) {
  for (double& value : values) {
    value = std::pow(10.0, value / 20.0);
  }
  return values;
}

/// The same through the project's psychometric function, levels not in dB.
QuestDefinition as_psi(const Json& domains) {
  PsiParameters p;
  p.function.sigmoid = sigmoid_named("weibull").sigmoid;
  p.function.axis = {Scale::kDecibel, 0.0};
  p.function.threshold = 1.0;
  p.function.share = 1.0 - std::exp(-1.0);
  p.levels = from_decibel(values_of(domains["x"]));
  p.threshold.values = from_decibel(values_of(domains["threshold"]));
  for (double shape : values_of(domains["slope"])) {
    p.width.values.push_back(width_of_rate(p.function.sigmoid, shape * std::numbers::ln10 / 20.0));
  }
  p.guess.values = values_of(domains["guess"]);
  p.lapse.values = values_of(domains["lapse"]);
  return psi_definition(p);
}

/// Follows a trace. @return how many suggestions are those of the trace
int followed(const Json& trace, const QuestDefinition& definition, bool decibel,
             std::unique_ptr<QuestPlus>& quest) {
  const auto suggested = trace["suggested"].get<std::vector<double>>();
  const auto responses = trace["responses"].get<std::vector<double>>();
  quest = std::make_unique<QuestPlus>(std::make_shared<QuestTables>(definition),
                                      QuestStop{static_cast<int>(suggested.size()), 0.0});
  int same = 0;
  for (std::size_t i = 0; i < suggested.size(); ++i) {
    const Level level = quest->next();
    const double x = decibel ? level[0] : std::round(20.0 * std::log10(level[0]));
    EXPECT_EQ(x, suggested[i]) << trace["problem"] << ", trial " << i + 1;
    same += x == suggested[i];
    quest->report(responses[i], level);
  }
  EXPECT_TRUE(quest->finished());
  return same;
}

class Traces : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto path = test::shared_data("psychometric/questplus_traces.json");
    if (!path) {
      GTEST_SKIP()
          << "neither HAPTRIAL_DATA nor ../shared/data holds psychometric/questplus_traces.json";
    }
    std::ifstream(*path) >> file_;
  }
  Json file_;
};

using QuestTraces = Traces;

TEST_F(QuestTraces, EverySuggestionIsThatOfTheTraces) {
  int same = 0;
  for (const Json& trace : file_["traces"]) {
    std::unique_ptr<QuestPlus> quest;
    same += followed(trace, as_stated(trace["domains"]), true, quest);
    for (const Estimate& estimate : quest->estimates()) {
      const auto comma = estimate.name.find(", mode");
      if (comma != std::string::npos) {
        EXPECT_EQ(estimate.value,
                  trace["posterior_mode"][estimate.name.substr(0, comma)].get<double>())
            << trace["problem"] << " " << estimate.name;
      }
    }
  }
  EXPECT_EQ(same, 224);
}

TEST_F(QuestTraces, ThePsychometricFunctionOfTheProjectGivesTheSame) {
  int same = 0;
  for (const Json& trace : file_["traces"]) {
    std::unique_ptr<QuestPlus> quest;
    same += followed(trace, as_psi(trace["domains"]), false, quest);
  }
  EXPECT_EQ(same, 224);
}

}  // namespace
}  // namespace haptrial::psychometric
