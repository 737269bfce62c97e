#include "analysis/statistics/design/design_json.h"

#include <nlohmann/json.hpp>

#include "analysis/statistics/design/result_json_internal.h"

namespace haptrial::analysis {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(double value) { return value; }

Json to_json(const RankAnova& r) {
  return {{"chi_squared", r.chi_squared}, {"df", r.df}, {"p", r.p}, {"exact", r.exact}};
}

Json to_json(const RankTest& r) {
  return {{"statistic", r.statistic}, {"p", r.p}, {"exact", r.exact}};
}

Json to_json(const PermutationTest& t) {
  return {{"difference", t.difference},
          {"p", t.p},
          {"arrangements", t.arrangements},
          {"exact", t.exact}};
}

Json to_json(const BootstrapInterval& i) {
  return {{"estimate", i.estimate}, {"low", i.low}, {"high", i.high}, {"resamples", i.resamples}};
}

Json to_json(const EquivalenceTest& e) {
  return {{"bound", e.bound}, {"p", e.p}, {"low_90", e.low}, {"high_90", e.high}};
}

Json to_json(const EffectTest& e);

template <class T>
Json defined(const Defined<T>& value) {
  return value ? to_json(*value) : Json{{"not_defined", value.because()}};
}

Json to_json(const EffectTest& e) {
  Json json{{"factor", e.factor},       {"test", e.test},         {"f", e.f},
            {"df_effect", e.df_effect}, {"df_error", e.df_error}, {"p", e.p}};
  if (e.epsilon) {
    json["greenhouse_geisser_epsilon"] = *e.epsilon;
  }
  json["partial_eta_squared"] = defined(e.size);
  return json;
}

Json to_json(const SideTest& t) {
  Json json{{"test", text_of(t.sides)},
            {"tail", t.sides.tail == Tail::kTwoSided ? "two" : "one"},
            {"participants", {t.count_a, t.count_b}},
            {"t_test", t.paired ? "paired" : "Welch"},
            {"t", defined(t.t)},
            {"p_holm", defined(t.holm)},
            {t.paired ? "d_z" : "cohens_d", defined(t.size)},
            {t.paired ? "wilcoxon_signed_rank" : "mann_whitney", defined(t.ranks)},
            {"ranks_p_holm", defined(t.ranks_holm)},
            {"permutation", defined(t.permutation)},
            {"permutation_p_holm", defined(t.permutation_holm)},
            {"bootstrap_of_difference_95", defined(t.bootstrap)}};
  if (t.beside.bayes_factors) {
    json["bayes_factor"] = defined(t.bayes_factor);
  }
  if (t.beside.equivalence > 0.0) {
    json["equivalence"] = defined(t.equivalence);
    json["equivalence_p_holm"] = defined(t.equivalence_holm);
  }
  if (t.beside.trimmed > 0.0) {
    json["yuen"] = defined(t.trimmed);
    json["yuen_p_holm"] = defined(t.trimmed_holm);
  }
  if (!t.covariate.empty()) {
    json["covariate"] = t.covariate;
    json["adjusted"] = defined(t.adjusted);
    json["adjusted_p_holm"] = defined(t.adjusted_holm);
  }
  return json;
}

Json to_json(const TestFamily& family) {
  Json tests = Json::array();
  for (const SideTest& test : family.tests) {
    tests.push_back(to_json(test));
  }
  return {{"family", family.name}, {"tests", tests}};
}

Json to_json(const SequentialResult& result) {
  Json looks = Json::array();
  for (const SequentialLook& look : result.looks) {
    looks.push_back({{"participants", look.participants},
                     {result.plan.rule == StopRule::kBayesFactor ? "bayes_factor" : "z",
                      look.value ? Json(*look.value) : Json{{"not_defined", look.value.because()}}},
                     {"bound", look.bound}});
  }
  return {{"test", text_of(result.test)},
          {"error", result.plan.error},
          {"most_participants", result.most},
          {"looks", looks},
          {"ended", result.verdict != SequentialVerdict::kGoOn},
          {"effect", result.verdict == SequentialVerdict::kEffect},
          {"words", words_of(result)}};
}

}  // namespace

Json to_json(const DesignTests& tests) {
  Json effects = Json::array();
  for (const auto& effect : tests.effects) {
    effects.push_back(defined(effect));
  }
  Json families = Json::array();
  for (const TestFamily& family : tests.families) {
    families.push_back(to_json(family));
  }
  Json json{{"varied", tests.design},
            {"effects", effects},
            {"on_ranks", defined(tests.ranks)},
            {tests.planned.name, to_json(tests.planned).at("tests")},
            {"families", families},
            {"left_out", tests.incomplete}};
  if (tests.ends_by_rule) {
    json["ends_by_rule"] = true;  // no p value allows for that
  }
  if (tests.sequential) {
    json["sequential"] = to_json(*tests.sequential);
  }
  return json;
}

std::string design_json(const DesignTests& tests) { return to_json(tests).dump(2); }

}  // namespace haptrial::analysis
