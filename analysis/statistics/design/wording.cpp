#include "analysis/statistics/design/wording.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace haptrial::analysis {
namespace {

constexpr const char* kApproximate = " (approximate)";

std::string not_defined(const std::string& because) { return "not defined, because " + because; }

// Degrees of freedom are whole but for Welch's test.
std::string degrees(double df) {
  return df == std::floor(df) ? fmt::format("{:.0f}", df) : fmt::format("{:.1f}", df);
}

/// "was looked at after 6, 12 participants (planned: 6, 12, 24)".
std::string words_of_looks(const SequentialResult& result) {
  const std::string planned = fmt::format("{:g}", fmt::join(result.plan.looks, ", "));
  std::vector<std::size_t> taken;
  for (const SequentialLook& look : result.looks) {
    taken.push_back(look.participants);
  }
  if (taken.empty()) {
    return fmt::format("was not yet looked at (planned: after {} participants)", planned);
  }
  return fmt::format("was looked at after {} participants{}", fmt::join(taken, ", "),
                     taken.size() == result.plan.looks.size()
                         ? std::string()
                         : fmt::format(" (planned: {})", planned));
}

/// The rule by which a study may end before its last participant.
std::string words_of_rule(const SequentialResult& result, const std::string& of) {
  const SequentialPlan& plan = result.plan;
  if (plan.rule == StopRule::kBayesFactor) {
    return fmt::format(
        "The study could end after any participant from number {} on, if the Bayes factor of {} "
        "({}) reached "
        "{:g}{}: without an effect that happens with a probability of at most {:g} (Ville's "
        "inequality).",
        plan.fewest, text_of(result.test), of, 1.0 / plan.error,
        plan.none > 0.0 ? fmt::format(" for it or {:g} against it", plan.none) : "", plan.error);
  }
  return fmt::format(
      "The test {} ({}) {}; the bounds of z spend an error of {:g} over the planned looks as Lan "
      "and DeMets (1983) do, in {} way.",
      text_of(result.test), of, words_of_looks(result), plan.error,
      plan.spending == Spending::kPocock ? "Pocock's" : "O'Brien and Fleming's");
}

}  // namespace

std::string p_value(double p) {
  if (p < 0.001) {
    return "p < 0.001";
  }
  if (p >= 0.1) {
    return fmt::format("p = {:.2f}", p);
  }
  constexpr double kLevel = 0.05;
  constexpr int kMostDigits = 12;
  const auto text = [p](int digits) { return fmt::format("{:#.{}g}", p, digits); };
  int digits = 2;
  while (p != kLevel && digits < kMostDigits && std::stod(text(digits)) == kLevel) {
    ++digits;  // a p on one side of the level does not read as the level
  }
  return "p = " + text(digits);
}

std::string mean_with_interval(const Defined<MeanInterval>& interval) {
  if (!interval) {
    return not_defined(interval.because());
  }
  return fmt::format("{}, 95 % CI {} to {}",
                     number_within(interval->mean, interval->low, interval->high),
                     number(interval->low), number(interval->high));
}

std::string anova_result(const Defined<Anova>& anova) {
  if (!anova) {
    return not_defined(anova.because());
  }
  return fmt::format("F({}, {}) = {}, {}, η² = {:#.2g}", degrees(anova->df_between),
                     degrees(anova->df_within), number(anova->f), p_value(anova->p),
                     anova->eta_squared);
}

std::string anova_result(const Defined<RepeatedAnova>& anova) {
  if (!anova) {
    return not_defined(anova.because());
  }
  return fmt::format("F({}, {}) = {}, {}; Greenhouse–Geisser ε = {:.2f}, {}; partial η² = {:#.2g}",
                     degrees(anova->df_condition), degrees(anova->df_error), number(anova->f),
                     p_value(anova->p), anova->epsilon, p_value(anova->p_corrected),
                     anova->partial_eta_squared);
}

std::string t_result(const Defined<TTest>& test) {
  if (!test) {
    return not_defined(test.because());
  }
  return fmt::format("t({}) = {:.2f}, {}", degrees(test->df), test->t, p_value(test->p));
}

std::string rank_result(const Defined<RankAnova>& test) {
  if (!test) {
    return not_defined(test.because());
  }
  return fmt::format("χ²({}) = {}, {}{}", degrees(test->df), number(test->chi_squared),
                     p_value(test->p), test->exact ? "" : kApproximate);
}

std::string ranks_p(const SideTest& test) {
  return p_result(test.ranks_holm) + (test.ranks && !test.ranks->exact ? kApproximate : "");
}

std::string comparison_words(const DesignTests& tests) {
  const auto effect = std::ranges::find_if(tests.effects, [](const auto& e) { return bool(e); });
  return fmt::format(
      "Conditions were compared by {}, two conditions by paired t-tests if the same participants "
      "had "
      "both and by Welch's t-test otherwise, p values adjusted by Holm's method within each family "
      "of tests.",
      effect == tests.effects.end()
          ? std::string("the tests of the tables")
          : (*effect)->test + ((*effect)->epsilon ? " with Greenhouse and Geisser's "
                                                    "correction"
                                                  : ""));
}

std::vector<std::string> sentences_beside(const DesignTests& tests, const std::string& of) {
  std::vector<std::string> sentences;
  const SideTest none;
  const SideTest& test = tests.planned.tests.empty() ? none : tests.planned.tests.front();
  if (test.beside.bayes_factors) {
    sentences.emplace_back(
        "Bayes factors of planned tests are those of Rouder et al. (2009), with a Cauchy prior of "
        "scale 0.707 on the standardized effect, on one side if the test is directed.");
  }
  if (test.beside.equivalence > 0.0) {
    sentences.push_back(
        fmt::format("Whether a difference ({}) lies within ±{} was tested by two one-sided t-tests "
                    "(Schuirmann 1987).",
                    of, number(test.beside.equivalence)));
  }
  if (test.beside.trimmed > 0.0) {
    sentences.push_back(
        fmt::format("Means trimmed by {:.3g} % at each end were compared by Yuen's test (1974).",
                    100.0 * test.beside.trimmed));
  }
  if (!test.covariate.empty()) {
    sentences.push_back(fmt::format(
        "Different people were also compared by an analysis of covariance with {0} held; of "
        "conditions that the same people had, it tests whether differences follow {0}.",
        test.covariate));
  }
  if (tests.sequential) {
    sentences.push_back(words_of_rule(*tests.sequential, of));
  }
  return sentences;
}

std::string effect_result(const EffectTest& effect) {
  return fmt::format(
      "F({}, {}) = {}, {} ({}{}){}", degrees(effect.df_effect), degrees(effect.df_error),
      number(effect.f), p_value(effect.p), effect.test,
      effect.epsilon ? fmt::format(", Greenhouse–Geisser ε = {:.2f}", *effect.epsilon) : "",
      effect.size ? fmt::format(", partial η² = {:#.2g}", effect.size->value) : "");
}

namespace {

/// "8.37 for an effect", "3.2 against a < b" of 1 / 3.2: a directed test says nothing of an effect
/// in the other direction.
std::string bayes_result(const SideTest& test) {
  if (!test.bayes_factor) {
    return not_defined(test.bayes_factor.because());
  }
  const double factor = *test.bayes_factor;
  return fmt::format("{} {} {}", number(factor >= 1.0 ? factor : 1.0 / factor),
                     factor >= 1.0 ? "for" : "against",
                     test.sides.tail == Tail::kTwoSided ? "an effect" : text_of(test.sides));
}

std::string equivalence_result(const SideTest& test) {
  if (!test.equivalence) {
    return not_defined(test.equivalence.because());
  }
  return fmt::format("{} after Holm's adjustment, 90 % CI {} to {}",
                     p_result(test.equivalence_holm), number(test.equivalence->low),
                     number(test.equivalence->high));
}

std::string trimmed_result(const SideTest& test) {
  if (!test.trimmed) {
    return not_defined(test.trimmed.because());
  }
  const TTest& t = *test.trimmed;
  return fmt::format("difference {}, Yuen's t({}) = {:.2f}, {} after Holm's adjustment",
                     number(t.difference), degrees(t.df), t.t, p_result(test.trimmed_holm));
}

std::string adjusted_result(const SideTest& test) {
  if (!test.adjusted) {
    return not_defined(test.adjusted.because());
  }
  const TTest& t = *test.adjusted;
  return fmt::format("difference {}, 95 % CI {} to {}, t({}) = {:.2f}, {} after Holm's adjustment",
                     number(t.difference), number(t.low), number(t.high), degrees(t.df), t.t,
                     p_result(test.adjusted_holm));
}

/// The tests that were asked for beside the t-test.
std::string tests_beside(const SideTest& test) {
  std::string text;
  if (test.beside.bayes_factors) {
    text += ", Bayes factor " + bayes_result(test);
  }
  if (test.beside.equivalence > 0.0) {
    text += fmt::format("; a difference of less than {}: {}", number(test.beside.equivalence),
                        equivalence_result(test));
  }
  if (test.beside.trimmed > 0.0) {
    text += fmt::format("; means trimmed by {:.3g} %: {}", 100.0 * test.beside.trimmed,
                        trimmed_result(test));
  }
  if (!test.covariate.empty()) {
    text += fmt::format("; adjusted for {}: {}", test.covariate, adjusted_result(test));
  }
  return text;
}

}  // namespace

std::string side_result(const SideTest& test) {
  if (!test.t) {
    return not_defined(test.t.because());
  }
  return fmt::format(
      "difference {}, 95 % CI {} to {} (two-sided, not adjusted), {}({}) = {:.2f}, {} after Holm's "
      "adjustment, {}{}",
      number(test.t->difference), number(test.t->low), number(test.t->high), name_of_test(test),
      degrees(test.t->df), test.t->t, p_result(test.holm),
      test.sides.tail == Tail::kTwoSided ? "two-tailed" : "one-tailed", tests_beside(test));
}

std::string bootstrap_result(const SideTest& test) {
  if (!test.bootstrap) {
    return not_defined(test.bootstrap.because());
  }
  if (std::min(test.count_a, test.count_b) < kFewestForBootstrap) {
    return fmt::format("not given for fewer than {} participants", kFewestForBootstrap);
  }
  return fmt::format("{} to {}", number(test.bootstrap->low), number(test.bootstrap->high));
}

std::string p_result(const Defined<double>& p) {
  return p ? p_value(*p) : not_defined(p.because());
}

std::string effect(const Defined<EffectSize>& size) {
  if (!size) {
    return not_defined(size.because());
  }
  return fmt::format("{:.2f}, {:.0f} % CI {:.2f} to {:.2f}", size->value, 100.0 * size->level,
                     size->low, size->high);
}

std::string levene_result(const Defined<Anova>& test) {
  if (!test) {
    return not_defined(test.because());
  }
  return fmt::format("F({}, {}) = {}, {}", degrees(test->df_between), degrees(test->df_within),
                     number(test->f), p_value(test->p));
}

std::string normality_result(const Defined<ShapiroWilk>& test) {
  return test ? fmt::format("W = {:.3f}, {}", test->w, p_value(test->p))
              : not_defined(test.because());
}

std::string sphericity_result(const Defined<RepeatedAnova>& anova) {
  if (!anova) {
    return "Mauchly's test of sphericity is " + not_defined(anova.because()) + ".";
  }
  const auto& mauchly = anova->sphericity.mauchly;
  const std::string test = mauchly ? fmt::format("W = {:.3f}, {}", mauchly->w, p_value(mauchly->p))
                                   : not_defined(mauchly.because());
  const std::string huynh = anova->p_huynh_feldt ? p_value(*anova->p_huynh_feldt)
                                                 : not_defined(anova->p_huynh_feldt.because());
  return fmt::format("Sphericity, Mauchly's test: {}; corrected after Huynh and Feldt: {}.", test,
                     huynh);
}

std::string quantity(const Defined<double>& value, double factor, const std::string& unit) {
  if (!value) {
    return not_defined(value.because());
  }
  return number(*value * factor) + (unit.empty() ? "" : kNoBreak + unit);
}

std::string capitalized(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') {
    text[0] = static_cast<char>(text[0] - 'a' + 'A');
  }
  return text;
}

std::string counted(std::size_t count, const std::string& noun) {
  const char* plural = noun.ends_with("s") ? "es" : "s";
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : plural);
}

std::string interval_word(const Defined<MeanInterval>& m) {
  return m ? fmt::format("{} [{}, {}]", number(m->mean), number(m->low), number(m->high)) : "–";
}

std::string interval_word(const Mean& mean) {
  return mean.value && !mean.interval ? number(*mean.value) : interval_word(mean.interval);
}

std::string mean_with_interval(const Mean& mean) {
  return mean.value && !mean.interval ? number(*mean.value) : mean_with_interval(mean.interval);
}

}  // namespace haptrial::analysis
