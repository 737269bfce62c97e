#include "analysis/statistics/tests/t_tests.h"
#include "tests/analysis/statistics/reference/reference.h"

namespace haptrial::analysis::reference::t_tests_reference {
namespace {

using Values = std::vector<double>;
using Test = Defined<TTest>(std::span<const double>, std::span<const double>, Tail, double);

void compare_case(Answers& r, const std::string& procedure, const std::string& name, Test& test,
                  const Values& a, const Values& b) {
  r.at(procedure, name + " two.sided").is("p", test(a, b, Tail::kTwoSided, 0.95)->p);
  r.at(procedure, name + " less").is("p", test(a, b, Tail::kLess, 0.95)->p);
  r.at(procedure, name + " greater").is("p", test(a, b, Tail::kGreater, 0.95)->p);
  const auto t = test(a, b, Tail::kTwoSided, 0.95);
  r.at(procedure, name)
      .is("t", t->t)
      .is("df", t->df)
      .is("low", t->low)
      .is("high", t->high)
      .is("error", t->error)
      .is("difference", t->difference);
  const auto wide = test(a, b, Tail::kLess, 0.99);
  r.at(procedure, name + " 99 %").is("low", wide->low).is("high", wide->high);
}

// Compares both samples, also behind an offset, which is exact for multiples of 1/64.
void compare_both(Answers& r, const std::string& procedure, const std::string& name, Test& test,
                  Values a, Values b) {
  compare_case(r, procedure, name, test, a, b);
  for (auto* values : {&a, &b}) {
    for (auto& value : *values) {
      value += 1e12;
    }
  }
  compare_case(r, procedure, name, test, a, b);
}

void compare(Answers& r) {
  const auto unequal = DataSet("unequal").groups("value", "group");
  const auto study = DataSet("study").groups("score", "condition");
  const DataSet pairs("pairs"), long_pairs("long_pairs");
  compare_both(r, "Student's t", "a and d", student_t_test, unequal[0], unequal[3]);
  compare_both(r, "Student's t", "study", student_t_test, study[1], study[0]);
  compare_both(r, "Welch's t", "a and d", welch_t_test, unequal[0], unequal[3]);
  compare_both(r, "Welch's t", "study", welch_t_test, study[1], study[0]);
  compare_both(r, "Paired t", "pairs", paired_t_test, pairs.numbers("first"),
               pairs.numbers("second"));
  compare_both(r, "Paired t", "long pairs", paired_t_test, long_pairs.numbers("first"),
               long_pairs.numbers("second"));
}

const Topic kTopic("t_tests", compare);

}  // namespace
}  // namespace haptrial::analysis::reference::t_tests_reference
