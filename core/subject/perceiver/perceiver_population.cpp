#include "core/subject/perceiver/perceiver_population.h"

#include <algorithm>
#include <iterator>
#include <string>

#include "core/base/definition/table.h"

namespace haptrial::subject {
namespace {

template <class Person>
struct Key {
  const char* name;
  double Person::*value;
  Bounds bounds;
  const char* unit;
  bool shifted{false};
};

constexpr Bounds kSpread{0.0, 2.0};
constexpr Bounds kShift{-10.0, 10.0};

using S = SenseParameters;
constexpr Key<S> kSenseKeys[] = {
    {"force_weber", &S::force_weber, kSpread, ""},
    {"force_floor", &S::force_floor, {0.0, 5.0}, "N"},
    {"displacement_bias", &S::displacement_bias, {0.0, 0.95}, ""},
    {"displacement_weber", &S::displacement_weber, kSpread, ""},
    {"speed_weber", &S::speed_weber, kSpread, ""},
    {"extent_weber", &S::extent_weber, kSpread, ""},
    {"usual_deflection", &S::usual_deflection, {0.0, 1.0, true}, "m"},
    {"contact_force", &S::contact_force, {0.0, 5.0}, "N"},
    {"moving_speed", &S::moving_speed, {0.0, 1.0, true}, "m/s"},
};

using J = JudgementParameters;
constexpr Key<J> kJudgementKeys[] = {
    {"decision_noise", &J::noise, kNonNegative, ""},
    {"bias_first", &J::bias_first, kShift, "", true},
    {"repetition", &J::repetition, kShift, "", true},
    {"criterion", &J::criterion, kPositive, ""},
    {"drift", &J::drift, kShift, "", true},
    {"lapse", &J::lapse, kFraction, ""},
    {"exponent", &J::exponent, {0.0, 10.0, true}, ""},
    {"modulus", &J::modulus, kPositive, ""},
    {"magnitude_noise", &J::magnitude_noise, kSpread, ""},
    {"tolerance", &J::tolerance, kNonNegative, ""},
};

/// The criterion of a linear scale can be anywhere.
Key<J> judgement_key(int i, bool logarithmic) {
  Key<J> key = kJudgementKeys[i];
  if (key.value == &J::criterion && !logarithmic) {
    key.bounds = {};
    key.shifted = true;
  }
  return key;
}

template <class Person>
Variation read_key(Table& table, const Key<Person>& key, const Person& defaults) {
  table.otherwise(key.name, defaults.*key.value);
  if (!table.has(key.name)) {
    return {defaults.*key.value, 0.0, key.shifted};
  }
  return key.shifted ? read_shift(table, key.name, key.bounds, key.unit)
                     : read_variation(table, key.name, key.bounds, key.unit);
}

template <class Person>
double draw_key(const Variation& variation, const Key<Person>& key, std::uint64_t seed) {
  return draw(variation, seed, std::string("observer ") + key.name, key.bounds);
}

}  // namespace

PerceiverPopulation::PerceiverPopulation(Table& table, const JudgementParameters& judge)
    : logarithmic_(judge.logarithmic) {
  static_assert(std::size(kSenseKeys) == kSenses && std::size(kJudgementKeys) == kJudgements);
  for (int i = 0; i < kSenses; ++i) {
    senses_[i] = read_key(table, kSenseKeys[i], SenseParameters{});
  }
  for (int i = 0; i < kJudgements; ++i) {
    judgements_[i] = read_key(table, judgement_key(i, logarithmic_), judge);
  }
}

bool PerceiverPopulation::varies() const {
  const auto spread = [](const Variation& each) { return each.spread > 0.0; };
  return std::ranges::any_of(senses_, spread) || std::ranges::any_of(judgements_, spread);
}

SenseParameters PerceiverPopulation::draw_senses(std::uint64_t seed) const {
  SenseParameters senses;
  for (int i = 0; i < kSenses; ++i) {
    senses.*kSenseKeys[i].value = draw_key(senses_[i], kSenseKeys[i], seed);
  }
  return senses;
}

JudgementParameters PerceiverPopulation::draw_judgement(std::uint64_t seed) const {
  JudgementParameters judge;
  judge.logarithmic = logarithmic_;
  for (int i = 0; i < kJudgements; ++i) {
    const Key<J> key = judgement_key(i, logarithmic_);
    judge.*key.value = draw_key(judgements_[i], key, seed);
  }
  return judge;
}

}  // namespace haptrial::subject
