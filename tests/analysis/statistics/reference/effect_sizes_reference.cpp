#include <fmt/format.h>

#include "analysis/statistics/variance/anova.h"
#include "analysis/statistics/variance/effect_size.h"
#include "analysis/statistics/variance/repeated_anova.h"
#include "tests/analysis/statistics/reference/reference.h"

namespace haptrial::analysis::reference::effect_sizes_reference {
namespace {

using Values = std::vector<double>;

// The values behind an offset, which is exact for multiples of 1/64.
Values moved(Values values, double offset) {
  for (auto& value : values) {
    value += offset;
  }
  return values;
}

void compare_samples(Answers& r, const std::string& name, const Values& first,
                     const Values& second) {
  for (const double offset : {0.0, 1e12}) {
    const Values a = moved(first, offset);
    const Values b = moved(second, offset);
    for (const double level : {0.95, 0.9}) {
      const auto d = cohens_d(a, b, level);
      r.at("Cohen's d and interval", fmt::format("{} {:g}", name, level))
          .is("d", d->value)
          .is("low", d->low)
          .is("high", d->high);
    }
    r.at("Hedges' g", name).is("g", hedges_g(a, b)->value);
  }
}

void compare_pairs(Answers& r, const std::string& name, const DataSet& data) {
  for (const double offset : {0.0, 1e12}) {
    const auto d =
        cohens_dz(moved(data.numbers("first"), offset), moved(data.numbers("second"), offset));
    r.at("d_z and interval", name).is("d", d->value).is("low", d->low).is("high", d->high);
  }
}

void compare_shares(Answers& r, const std::string& name, double f, double n, double df) {
  for (const double level : {0.9, 0.95}) {
    const auto eta = partial_eta_squared(f, n, df, level);
    r.at("Eta squared (partial) and interval", fmt::format("{} {:g}", name, level))
        .is("eta", eta->value)
        .is("low", eta->low)
        .is("high", eta->high);
  }
}

void compare_designs(Answers& r) {
  for (const std::string name : {"unequal", "ties"}) {
    const auto anova = one_way_anova(DataSet(name).groups("value", "group"));
    r.at("Eta squared of one-way designs", name).is("eta", eta_squared(*anova)->value);
  }
  const auto times =
      repeated_measures_anova(DataSet("times").means("value", "subject", "condition"));
  r.at("Generalized eta squared", "times")
      .is("ges", *generalized_eta_squared(times->squares_condition,
                                          times->squares_participants + times->squares_error));
}

void compare(Answers& r) {
  const auto unequal = DataSet("unequal").groups("value", "group");
  const auto study = DataSet("study").groups("score", "condition");
  compare_samples(r, "a and b", unequal[0], unequal[1]);
  compare_samples(r, "b and d", unequal[1], unequal[3]);
  compare_samples(r, "study", study[1], study[0]);
  compare_pairs(r, "pairs", DataSet("pairs"));
  compare_pairs(r, "long pairs", DataSet("long_pairs"));
  compare_shares(r, "2 and 22", 8.65, 2, 22);
  compare_shares(r, "3 and 36", 1.354, 3, 36);
  compare_shares(r, "1 and 9", 0.2, 1, 9);
  compare_shares(r, "2 and 861", 40, 2, 861);
  compare_shares(r, "5 and 12.5", 300, 5, 12.5);
  compare_designs(r);
}

const Topic kTopic("effect_sizes", compare);

}  // namespace
}  // namespace haptrial::analysis::reference::effect_sizes_reference
