#include "analysis/statistics/tests/permutation.h"
#include "tests/analysis/statistics/reference/reference.h"

namespace haptrial::analysis::reference::permutation_reference {
namespace {

using Values = std::vector<double>;
using Test = Defined<PermutationTest>(std::span<const double>, std::span<const double>, Tail,
                                      const Resampling&);

Values moved(Values values, double offset) {
  for (auto& value : values) {
    value += offset;
  }
  return values;
}

// The offset leaves half a hundredth of the values' steps as rounding: ties must stay ties.
void compare_case(Answers& r, const std::string& procedure, const std::string& name, Test& test,
                  const Values& first, const Values& second) {
  for (const double offset : {0.0, 1e12}) {
    const Values a = moved(first, offset);
    const Values b = moved(second, offset);
    Values p;
    for (const Tail tail : {Tail::kTwoSided, Tail::kLess, Tail::kGreater}) {
      p.push_back(test(a, b, tail, {})->p);
    }
    r.at(procedure, name)
        .are("p", p)
        .is("arrangements", static_cast<double>(test(a, b, Tail::kTwoSided, {})->arrangements));
  }
}

void compare(Answers& r) {
  const auto unequal = DataSet("unequal").groups("value", "group");
  const auto ties = DataSet("ties").groups("value", "group");
  const DataSet pairs("pairs"), tied("tied_pairs");
  const char* const two = "Permutation test of two samples";
  compare_case(r, two, "a and d", permutation_test, unequal[0], unequal[3]);
  compare_case(r, two, "b and c", permutation_test, unequal[1], unequal[2]);
  compare_case(r, two, "ties", permutation_test, ties[0], ties[1]);
  const char* const signs = "Sign-flip test of pairs";
  compare_case(r, signs, "pairs", sign_flip_test, pairs.numbers("first"), pairs.numbers("second"));
  Values first = tied.numbers("first");
  Values second = tied.numbers("second");
  first.resize(13);
  second.resize(13);
  compare_case(r, signs, "ties", sign_flip_test, first, second);
}

const Topic kTopic("permutation", compare);

}  // namespace
}  // namespace haptrial::analysis::reference::permutation_reference
