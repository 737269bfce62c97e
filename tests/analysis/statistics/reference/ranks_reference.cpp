#include "analysis/statistics/tests/wilcoxon.h"
#include "analysis/statistics/variance/rank_anova.h"
#include "tests/analysis/statistics/reference/reference.h"

namespace haptrial::analysis::reference::ranks_reference {
namespace {

using Values = std::vector<double>;
using Table = std::vector<Values>;
using Test = Defined<RankTest>(std::span<const double>, std::span<const double>, Tail);

constexpr double kOffset = 1e12;  // exact: the values are multiples of 1/128 or more

Values shifted(Values values) {
  for (double& value : values) {
    value += kOffset;
  }
  return values;
}

std::string kind_of(bool exact) { return exact ? ": exact" : ": approximate"; }

void compare_test(Answers& r, const std::string& procedure, const std::string& name, Test& test,
                  const Values& a, const Values& b) {
  const std::string kind = kind_of(test(a, b, Tail::kLess)->exact) +
                           (name.find("tie") == std::string::npos ? "" : " with ties");
  for (const auto& [tail, tail_name] :
       {std::pair{Tail::kTwoSided, " two.sided"}, std::pair{Tail::kLess, " less"},
        std::pair{Tail::kGreater, " greater"}}) {
    const auto plain = test(a, b, tail);
    const auto offset = test(shifted(a), shifted(b), tail);
    r.at(procedure + kind, name + tail_name)
        .is("statistic", plain->statistic)
        .is("p", plain->p)
        .is("statistic", offset->statistic)
        .is("p", offset->p);
  }
}

void compare_signed_rank(Answers& r) {
  const auto compare = [&](const char* name, const Values& a, const Values& b) {
    compare_test(r, "Wilcoxon signed-rank", name, wilcoxon_signed_rank, a, b);
  };
  const auto pair = [](const char* file, std::size_t count) {
    const DataSet data(file);
    auto a = data.numbers("first");
    auto b = data.numbers("second");
    a.resize(std::min(count, a.size()));
    b.resize(a.size());
    return std::pair{a, b};
  };
  for (const auto& [name, file, count] :
       {std::tuple{"pairs", "pairs", 100}, std::tuple{"first five", "pairs", 5},
        std::tuple{"one", "pairs", 1}, std::tuple{"tied pairs", "tied_pairs", 100},
        std::tuple{"long pairs", "long_pairs", 100}}) {
    const auto [a, b] = pair(file, static_cast<std::size_t>(count));
    compare(name, a, b);
  }
  Values a, b;
  for (int i = 1; i <= 49; ++i) {
    a.push_back(i);
    b.push_back(i + 1.5078125 - 0.03125 * i);
  }
  compare("49", a, b);
}

void compare_mann_whitney(Answers& r) {
  const auto compare = [&](const char* name, const Values& a, const Values& b) {
    compare_test(r, "Mann-Whitney", name, mann_whitney, a, b);
  };
  const auto unequal = DataSet("unequal").groups("value", "group");
  const auto ties = DataSet("ties").groups("value", "group");
  const auto study = DataSet("study").groups("score", "condition");
  compare("a and d", unequal[0], unequal[3]);
  compare("c and b", unequal[2], unequal[1]);
  compare("one and one", {1}, {2});
  compare("ties", ties[0], ties[2]);
  compare("study", study[1], study[0]);
  Values a, b;
  for (int i = 1; i <= 49; ++i) {
    a.push_back(3.0 * i);
    b.push_back(2.0 * i + 0.5);
  }
  compare("49 and 49", a, b);
}

void compare_several(Answers& r, const std::string& procedure, const char* name,
                     Defined<RankAnova> (*test)(const Table&), Table table) {
  for (const bool offset : {false, true}) {
    for (auto& row : table) {
      row = offset ? shifted(row) : row;
    }
    const auto found = test(table);
    r.at(procedure + kind_of(found->exact), name)
        .is("chi", found->chi_squared)
        .is("df", found->df)
        .is("p", found->p);
  }
}

void compare(Answers& r) {
  compare_signed_rank(r);
  compare_mann_whitney(r);
  for (const char* name : {"unequal", "ties"}) {
    compare_several(r, "Kruskal-Wallis", name, kruskal_wallis,
                    DataSet(name).groups("value", "group"));
  }
  compare_several(r, "Kruskal-Wallis", "study", kruskal_wallis,
                  DataSet("study").groups("score", "condition"));
  compare_several(r, "Kruskal-Wallis", "few", kruskal_wallis,
                  {{1, 2, 2, 5}, {3, 4, 4, 7}, {5, 6, 8}});
  for (const char* name : {"times", "ratings"}) {
    compare_several(r, "Friedman", name, friedman,
                    DataSet(name).means("value", "subject", "condition"));
  }
  compare_several(r, "Friedman", "study", friedman,
                  DataSet("study").means("score", "subject", "condition"));
}

const Topic kTopic("ranks", compare);

}  // namespace
}  // namespace haptrial::analysis::reference::ranks_reference
