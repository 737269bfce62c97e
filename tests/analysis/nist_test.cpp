// Certified one-way analyses of variance of the NIST Statistical Reference Datasets (public
// domain).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "analysis/anova.h"

namespace haptrial::analysis {
namespace {

struct Certified {
  std::vector<std::vector<double>> groups;
  double df_between{0.0}, squares_between{0.0}, f{0.0};
  double df_within{0.0}, squares_within{0.0};
  double r_squared{0.0};
};

// The layout is fixed: certified values in lines 41 to 47, data from line 61 on.
Certified load(const std::string& name) {
  std::ifstream file(std::string(HAPTRIAL_SOURCE_DIR) + "/tests/analysis/data/nist/" + name);
  EXPECT_TRUE(file) << name;
  Certified result;
  std::map<std::string, std::vector<double>> groups;
  std::string line, word;
  for (int number = 1; std::getline(file, line); ++number) {
    std::istringstream words(line);
    double mean_square = 0.0;
    if (number <= 60 && words >> word) {
      if (word == "Between") {
        words >> word >> result.df_between >> result.squares_between >> mean_square >> result.f;
      } else if (word == "Within") {
        words >> word >> result.df_within >> result.squares_within;
      } else if (line.find("Certified R-Squared") != std::string::npos) {
        words >> word >> result.r_squared;
      }
    } else if (double value = 0.0; number > 60 && words >> word >> value) {
      groups[word].push_back(value);
    }
  }
  for (auto& [label, values] : groups) {
    result.groups.push_back(std::move(values));
  }
  return result;
}

double correct_digits(double found, double certified) {
  return found == certified ? 15.95 : -std::log10(std::abs(found - certified) / certified);
}

struct Case {
  const char* file;
  // Correct digits of F, between and within squares that exact rational arithmetic reaches on the
  // data as read into doubles: no program that takes doubles does better but by luck.
  double f, between, within;
};

class NistAnova : public testing::TestWithParam<Case> {};

TEST_P(NistAnova, ReachesTheCapOfTheData) {
  const Certified c = load(GetParam().file);
  const auto found = one_way_anova(c.groups);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->df_between, c.df_between);
  EXPECT_EQ(found->df_within, c.df_within);
  // Full precision where the data allow it, the cap of the data where they do not.
  const auto reached = [](double digits, double cap) {
    return digits >= std::min(cap, 14.5) - 0.01;
  };
  const Case& cap = GetParam();
  const double f = correct_digits(found->f, c.f);
  const double between = correct_digits(found->squares_between, c.squares_between);
  const double within = correct_digits(found->squares_within, c.squares_within);
  RecordProperty("digits_of_f", std::to_string(f));
  EXPECT_PRED2(reached, f, cap.f);
  EXPECT_PRED2(reached, between, cap.between);
  EXPECT_PRED2(reached, within, cap.within);
  EXPECT_PRED2(reached, correct_digits(found->eta_squared, c.r_squared),
               std::min(cap.between, cap.within));
}

INSTANTIATE_TEST_SUITE_P(
    StRD, NistAnova,
    testing::Values(
        Case{"AtmWtAg.dat", 10.155, 10.240, 10.904}, Case{"SiRstv.dat", 13.058, 14.026, 13.118},
        Case{"SmLs01.dat", 16.152, 15.212, 15.265}, Case{"SmLs02.dat", 15.929, 15.180, 15.265},
        Case{"SmLs03.dat", 15.911, 15.177, 15.265}, Case{"SmLs04.dat", 10.432, 10.052, 10.286},
        Case{"SmLs05.dat", 10.209, 9.945, 10.286}, Case{"SmLs06.dat", 10.191, 9.935, 10.286},
        Case{"SmLs07.dat", 4.413, 4.031, 4.265}, Case{"SmLs08.dat", 4.189, 3.924, 4.265},
        Case{"SmLs09.dat", 4.171, 3.914, 4.265}),
    [](const auto& param) { return std::string(param.param.file).substr(0, 6); });

}  // namespace
}  // namespace haptrial::analysis
