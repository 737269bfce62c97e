// Every procedure against R's answers, and the table of docs that says how close they are.
#include "tests/analysis/statistics/reference/reference.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "tests/analysis/statistics/reference/nist.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::analysis::reference::reference_test {
namespace {

using testing::IsEmpty;

constexpr double kTolerance = 1e-8;  // relative; the table shows what is reached
constexpr double kFloor = 1e-13;     // R itself is not right to more digits everywhere
constexpr const char* kRewrite = "HAPTRIAL_WRITE_REFERENCES";  // writes answers and table anew

std::filesystem::path answers_of(const Topic& topic) { return folder() / (topic.name + ".csv"); }

Answers compared(const Topic& topic) {
  Answers answers(answers_of(topic));
  topic.compare(answers);
  return answers;
}

int run_r(const Topic& topic, const std::filesystem::path& output) {
  return std::system(fmt::format("cd '{}' && LC_ALL=C Rscript --vanilla {}.R '{}'",
                                 folder().string(), topic.name, output.string())
                         .c_str());
}

class Reference : public testing::TestWithParam<Topic> {};

TEST_P(Reference, EveryValueAgreesWithR) {
  const Answers answers = compared(GetParam());
  for (const auto& procedure : answers.procedures()) {
    EXPECT_GT(procedure.compared, 0u) << procedure.name;
    EXPECT_LE(procedure.largest_difference, kTolerance)
        << procedure.name << ": " << procedure.where;
  }
  EXPECT_THAT(answers.unused(), IsEmpty());
}

TEST_P(Reference, RStillGivesTheKeptAnswers) {
  const bool rewrite = std::getenv(kRewrite) != nullptr;
  const test::TemporaryFolder temporary;
  const auto file = rewrite ? answers_of(GetParam()) : temporary / "answers.csv";
  ASSERT_EQ(run_r(GetParam(), file), 0);
  const Answers fresh(file);
  const Answers kept(answers_of(GetParam()));
  ASSERT_EQ(fresh.values().size(), kept.values().size());
  for (const auto& [place, value] : kept.values()) {
    ASSERT_EQ(fresh.values().count(place), 1u) << place;
    EXPECT_LE(relative_difference(fresh.values().at(place), value), 0.1 * kTolerance) << place;
  }
}

INSTANTIATE_TEST_SUITE_P(R, Reference, testing::ValuesIn(topics()), [](const auto& param) {
  std::string name = param.param.name;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return std::isalnum(c) == 0; }, '_');
  return name;
});

TEST(ReferenceScripts, EachHaveATopic) {
  std::vector<std::string> scripts, names;
  for (const auto& entry : std::filesystem::directory_iterator(folder())) {
    if (entry.path().extension() == ".R" && entry.path().stem() != "reference") {
      scripts.push_back(entry.path().stem());
    }
  }
  for (const Topic& topic : topics()) {
    names.push_back(topic.name);
  }
  EXPECT_THAT(scripts, testing::UnorderedElementsAreArray(names));
}

// The next power of ten above a difference.
std::string bound(double difference) {
  const double decade = std::ceil(std::log10(std::max(difference, kFloor)) - 1e-9);
  return fmt::format("1e{:.0f}", decade);
}

std::vector<std::string> table_of_r(double scale) {
  std::vector<std::string> lines{"| procedure | in R | values | largest relative difference |",
                                 "| --- | --- | --- | --- |"};
  for (const Topic& topic : topics()) {
    const Answers answers = compared(topic);
    for (const auto& p : answers.procedures()) {
      lines.push_back(fmt::format("| {} | `{}` | {} | < {} |", p.name, p.call, p.compared,
                                  bound(scale * p.largest_difference)));
    }
  }
  return lines;
}

std::vector<std::string> table_of_nist() {
  std::vector<std::string> lines{"| set | F | cap | between | cap | within | cap |",
                                 "| --- | --- | --- | --- | --- | --- | --- |"};
  // Digits beyond what the certified values are printed with mean nothing.
  const auto digits = [](double d) { return fmt::format("{:.1f}", std::min(d, 15.0)); };
  for (const auto& cap : nist::caps()) {
    const auto d = nist::digits(cap.file);
    lines.push_back(fmt::format("| {} | {} | {} | {} | {} | {} | {} |",
                                std::filesystem::path(cap.file).stem().string(), digits(d.f),
                                digits(cap.f), digits(d.between), digits(cap.between),
                                digits(d.within), digits(cap.within)));
  }
  return lines;
}

// @param scale  of the differences from R: a table is right where a machine that rounds a little
//               differently could have made it.
std::vector<std::string> page(double scale) {
  std::vector<std::string> lines{
      "# Accuracy of the statistics",
      "",
      "The test `AccuracyTable` makes this page and fails if page and code disagree. "
      "With `HAPTRIAL_WRITE_REFERENCES=1` the tests write the page and R's answers "
      "again. Scripts, data and stored answers with R's version are in "
      "`tests/analysis/statistics/reference/`. The procedures themselves: "
      "[statistics](statistics.md).",
      "",
      "## Compared with R",
      "",
      fmt::format("The table gives the largest difference relative to R's value over all cases and "
                  "quantities, rounded up to a power of ten. Differences below {:.0e} are not "
                  "distinguished, because R itself is not always accurate to more digits. Stored "
                  "answers: {}.",
                  kFloor, Answers(answers_of(topics().front())).versions().front()),
      ""};
  const auto add = [&](const std::vector<std::string>& more) {
    lines.insert(lines.end(), more.begin(), more.end());
  };
  add(table_of_r(scale));
  add({"", "## Compared with NIST's certified values", "",
       "The table gives the correct digits (-log10 of the relative error, at most 15) of"
       " one-way ANOVA on the Statistical Reference Datasets. The cap is the number of "
       "correct digits that exact rational arithmetic reaches on the same data after "
       "they are read into doubles.",
       ""});
  add(table_of_nist());
  return lines;
}

TEST(AccuracyTable, IsWhatTheTestsMeasure) {
  const auto file =
      std::filesystem::path(HAPTRIAL_SOURCE_DIR) / "docs/algorithms/statistics-accuracy.md";
  if (std::getenv(kRewrite) != nullptr) {
    std::ofstream out(file);
    for (const auto& line : page(1.0)) {
      out << line << '\n';
    }
  }
  std::vector<std::string> committed;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    committed.push_back(line);
  }
  const auto low = page(1.0 / 3.0);
  const auto made = page(1.0);
  const auto high = page(3.0);
  ASSERT_EQ(committed.size(), made.size());
  for (std::size_t i = 0; i < made.size(); ++i) {
    EXPECT_THAT(committed[i], testing::AnyOf(made[i], low[i], high[i])) << "line " << i + 1;
  }
}

}  // namespace
}  // namespace haptrial::analysis::reference::reference_test
