#include "analysis/statistics/design/sequential_looks.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "analysis/statistics/base/distributions.h"
#include "analysis/statistics/design/compared_sides.h"

namespace haptrial::analysis {
namespace {

/// The table without those who are not among some participants.
DesignTable with_only(const DesignTable& table, std::span<const std::string> participants) {
  DesignTable some = table;
  some.subjects.clear();
  some.means.clear();
  for (std::size_t i = 0; i < table.subjects.size(); ++i) {
    if (std::ranges::find(participants, table.subjects[i]) != participants.end()) {
      some.subjects.push_back(table.subjects[i]);
      some.means.push_back(table.means[i]);
    }
  }
  return some;
}

/// The standard normal value with the t-test's probability; of a two-sided test without a sign.
Defined<double> z_of(const SideTest& test) {
  if (!test.t) {
    return Undefined{test.t.because()};
  }
  const double upper = test.sides.tail == Tail::kTwoSided ? test.t->p / 2.0 : test.t->p;
  const double least = std::numeric_limits<double>::min();
  return -normal_quantile(std::clamp(upper, least, 1.0 - 1e-16));
}

class Looks {
 public:
  Looks(const DesignTable& table, SequentialResult& result, std::span<const std::string> order)
      : table_(table),
        result_(result),
        order_(order),
        a_(cells_of(table, result.test.a)),
        b_(cells_of(table, result.test.b)) {}

  /// @returns whether the study goes on
  bool look(std::size_t participants, double bound) {
    TestsBeside beside;
    beside.bayes_factors = result_.plan.rule == StopRule::kBayesFactor;
    const SideTest test = compared(with_only(table_, order_.first(participants)), result_.test, a_,
                                   b_, Resampling{1, "", 0, 1}, beside);
    const SequentialLook look{participants, beside.bayes_factors ? test.bayes_factor : z_of(test),
                              bound};
    const double none = result_.plan.none;
    if (look.value && *look.value >= bound) {
      result_.verdict = SequentialVerdict::kEffect;
    } else if (look.value && none > 0.0 && *look.value <= 1.0 / none) {
      result_.verdict = SequentialVerdict::kNoEffect;
    }
    result_.looks.push_back(look);
    return result_.verdict == SequentialVerdict::kGoOn;
  }

 private:
  const DesignTable& table_;
  SequentialResult& result_;
  std::span<const std::string> order_;
  Cells a_, b_;
};

std::vector<double> bounds_of_looks(const SequentialPlan& plan, Tail tail) {
  std::vector<double> shares;
  for (const double look : plan.looks) {
    shares.push_back(look / plan.looks.back());
  }
  return spending_bounds(shares, plan.error, tail == Tail::kTwoSided, plan.spending);
}

std::vector<std::string> warnings_of_factor(const SequentialPlan& plan, int participants) {
  constexpr double kCautious = 6.0;
  std::vector<std::string> warnings;
  if (plan.fewest > participants) {
    warnings.push_back(fmt::format(
        "analysis.sequential.fewest is {}, but design.participants is {}: nobody looks before the "
        "study ends",
        plan.fewest, participants));
  }
  if (plan.none > 0.0 && plan.none < kCautious) {
    warnings.push_back(fmt::format(
        "analysis.sequential.none is {:g}: with 3, about one study in six whose effect is half a "
        "standard deviation ends without it, with 6 one in fifty",
        plan.none));
  }
  return warnings;
}

std::string value_words(const SequentialResult& result, const SequentialLook& look) {
  const char* name = result.plan.rule == StopRule::kBayesFactor ? "Bayes factor" : "z";
  return look.value ? fmt::format("{} {:.3g}, bound {:.4g}", name, *look.value, look.bound)
                    : fmt::format("{} {}", name, "not defined, because " + look.value.because());
}

}  // namespace

SequentialResult sequential_result(const DesignTable& table, const PlannedTest& test,
                                   const SequentialPlan& plan, std::span<const std::string> order,
                                   std::size_t most) {
  SequentialResult result{test, plan, most, {}, SequentialVerdict::kGoOn};
  Looks looks(table, result, order);
  bool goes_on = true;
  if (plan.rule == StopRule::kBayesFactor) {
    for (auto n = static_cast<std::size_t>(plan.fewest);
         goes_on && n <= std::min(order.size(), most); ++n) {
      goes_on = looks.look(n, 1.0 / plan.error);
    }
  } else {
    result.most = static_cast<std::size_t>(plan.looks.back());
    const std::vector<double> bounds = bounds_of_looks(plan, test.tail);
    for (std::size_t i = 0; goes_on && i < bounds.size(); ++i) {
      const auto n = static_cast<std::size_t>(plan.looks[i]);
      if (n > order.size()) {
        break;
      }
      goes_on = looks.look(n, bounds[i]);
    }
  }
  if (goes_on && order.size() >= result.most) {
    result.verdict = SequentialVerdict::kUndecided;
  }
  return result;
}

std::vector<std::string> sequential_warnings(const AnalysisPlan& plan, int participants) {
  if (!plan.sequential) {
    return {};
  }
  if (plan.sequential->rule == StopRule::kBayesFactor) {
    return warnings_of_factor(*plan.sequential, participants);
  }
  if (plan.sequential->looks.back() == participants) {
    return {};
  }
  return {fmt::format(
      "the last of analysis.sequential.looks is after {:g} participants, but design.participants "
      "is {}: the study then ends undecided with another error, or asks for more than are planned",
      plan.sequential->looks.back(), participants)};
}

std::string words_of(const SequentialResult& result) {
  const std::string test = text_of(result.test);
  constexpr const char* kUndecided =
      "; the study has ended undecided: no more participants may come.";
  if (result.looks.empty() && result.verdict == SequentialVerdict::kUndecided) {
    return test + ": fewer have come than a look takes" + kUndecided;
  }
  if (result.looks.empty()) {
    return fmt::format("{}: not looked at yet; go on, with at most {} participants.", test,
                       result.most);
  }
  const SequentialLook& last = result.looks.back();
  const std::string at = fmt::format("{}, after {} of at most {} participants: {}", test,
                                     last.participants, result.most, value_words(result, last));
  switch (result.verdict) {
    case SequentialVerdict::kEffect:
      return at + "; the study has ended: there is an effect.";
    case SequentialVerdict::kNoEffect:
      return at + (result.test.tail == Tail::kTwoSided
                       ? "; the study has ended without an effect."
                       : fmt::format("; the study has ended: {} is not supported.", test));
    case SequentialVerdict::kUndecided:
      return at + kUndecided;
    case SequentialVerdict::kGoOn:
      break;
  }
  return at + "; go on.";
}

}  // namespace haptrial::analysis
