// Certified one-way analyses of variance of the NIST Statistical Reference Datasets (public
// domain).
#include "tests/analysis/statistics/reference/nist.h"

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>

#include "analysis/statistics/variance/anova.h"

namespace haptrial::analysis::nist {
namespace {

struct Certified {
  std::vector<std::vector<double>> groups;
  double df_between{0.0}, squares_between{0.0}, f{0.0};
  double df_within{0.0}, squares_within{0.0};
  double r_squared{0.0};
};

// The layout is fixed: certified values in lines 41 to 47, data from line 61 on.
Certified load(const std::string& name) {
  std::ifstream file(std::string(HAPTRIAL_SOURCE_DIR) +
                     "/tests/analysis/statistics/reference/nist/" + name);
  if (!file) {
    throw std::runtime_error(name + " cannot be read");
  }
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

}  // namespace

const std::vector<Cap>& caps() {
  static const std::vector<Cap> all{
      {"SiRstv.dat", 13.058, 14.026, 13.118},  {"SmLs01.dat", 16.152, 15.212, 15.265},
      {"SmLs02.dat", 15.929, 15.180, 15.265},  {"SmLs03.dat", 15.911, 15.177, 15.265},
      {"AtmWtAg.dat", 10.155, 10.240, 10.904}, {"SmLs04.dat", 10.432, 10.052, 10.286},
      {"SmLs05.dat", 10.209, 9.945, 10.286},   {"SmLs06.dat", 10.191, 9.935, 10.286},
      {"SmLs07.dat", 4.413, 4.031, 4.265},     {"SmLs08.dat", 4.189, 3.924, 4.265},
      {"SmLs09.dat", 4.171, 3.914, 4.265}};
  return all;
}

Digits digits(const char* file) {
  const Certified c = load(file);
  const auto found = one_way_anova(c.groups);
  if (!found) {
    throw std::runtime_error(std::string(file) + ": not defined, because " + found.because());
  }
  return {correct_digits(found->f, c.f), correct_digits(found->squares_between, c.squares_between),
          correct_digits(found->squares_within, c.squares_within),
          correct_digits(found->eta_squared, c.r_squared),
          found->df_between == c.df_between && found->df_within == c.df_within};
}

}  // namespace haptrial::analysis::nist
