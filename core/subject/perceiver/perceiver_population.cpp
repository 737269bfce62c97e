#include "core/subject/perceiver/perceiver_population.h"

#include "core/subject/population_schema.h"

namespace haptrial::subject {
namespace {

constexpr const char* kStreams = "observer ";
constexpr Bounds kSpread{0.0, 2.0};
constexpr Bounds kShift{-10.0, 10.0};

using S = SenseParameters;
using J = JudgementParameters;

Schema<Population<J>> make_judgement_schema(bool logarithmic) {
  // The criterion of a linear scale can be anywhere.
  const Bounds criterion = logarithmic ? kPositive : Bounds{};
  return make_population_schema<J>(
      kStreams, false,
      {{"decision_noise", &J::noise, kNonNegative, "",
        "Standard deviation of the evidence of each interval, beside the noise of the sense"},
       {"bias_first", &J::bias_first, kShift, "",
        "Evidence that is added to that of the first interval", true},
       {"repetition", &J::repetition, kShift, "",
        "Evidence that is added to that of the answer of the trial before", true},
       {"criterion", &J::criterion, criterion, "", "Percept above which the answer is yes",
        !logarithmic},
       {"drift", &J::drift, kShift, "", "Change of the criterion of a yes from trial to trial",
        true},
       {"lapse", &J::lapse, kFraction, "", "Probability of an answer at random"},
       {"exponent",
        &J::exponent,
        {0.0, 10.0, true},
        "",
        "Exponent of the power law by which a percept becomes a magnitude"},
       {"modulus", &J::modulus, kPositive, "", "Magnitude that is stated for a percept of 1"},
       {"magnitude_noise", &J::magnitude_noise, kSpread, "",
        "Standard deviation of a stated magnitude, as a logarithm"},
       {"tolerance", &J::tolerance, kNonNegative, "",
        "Largest difference of evidence with which an adjusted level counts as equal"}});
}

}  // namespace

const Schema<Population<SenseParameters>>& sense_schema() {
  static const auto schema = make_population_schema<S>(
      kStreams, false,
      {{"force_weber", &S::force_weber, kSpread, "",
        "Standard deviation of a felt force, as a share of the force"},
       {"force_floor",
        &S::force_floor,
        {0.0, 5.0},
        "N",
        "Standard deviation of a felt force that is zero"},
       {"displacement_bias",
        &S::displacement_bias,
        {0.0, 0.95},
        "",
        "Share of a change of deflection that is not felt"},
       {"displacement_weber", &S::displacement_weber, kSpread, "",
        "Standard deviation of a felt deflection, as a share of the deflection"},
       {"speed_weber", &S::speed_weber, kSpread, "",
        "Standard deviation of a felt speed, as a share of the speed"},
       {"extent_weber", &S::extent_weber, kSpread, "",
        "Standard deviation of a felt extent, as a share of the extent"},
       {"frequency_weber", &S::frequency_weber, kSpread, "",
        "Standard deviation of a felt frequency, as a share of the frequency"},
       {"mass_weber", &S::mass_weber, kSpread, "",
        "Standard deviation of a felt mass, as a share of the mass"},
       {"duration_weber", &S::duration_weber, kSpread, "",
        "Standard deviation of a felt duration, as a share of the duration"},
       {"usual_deflection",
        &S::usual_deflection,
        {0.0, 1.0, true},
        "m",
        "Deflection of a pressed surface that is felt as large as it is"},
       {"contact_force",
        &S::contact_force,
        {0.0, 5.0},
        "N",
        "Force above which the hand is felt to touch something"},
       {"moving_speed",
        &S::moving_speed,
        {0.0, 1.0, true},
        "m/s",
        "Speed above which the hand is felt to move"}});
  return schema;
}

const Schema<Population<JudgementParameters>>& judgement_schema(bool logarithmic) {
  static const auto of_logarithms = make_judgement_schema(true);
  static const auto of_percepts = make_judgement_schema(false);
  return logarithmic ? of_logarithms : of_percepts;
}

PerceiverPopulation::PerceiverPopulation(Table& table, bool logarithmic) {
  judgements_.everybody.logarithmic = logarithmic;
  sense_schema().read(table, senses_);
  judgement_schema(logarithmic).read(table, judgements_);
}

}  // namespace haptrial::subject
