#pragma once

#include <cstdint>

#include "core/base/definition/schema_forward.h"
#include "core/subject/perceiver/felt.h"
#include "core/subject/perceiver/judgement.h"
#include "core/subject/population.h"

namespace haptrial::subject {

/// The keys of [observer] that describe senses and decisions. Each may be left out, which is the
/// default for everybody. bias_first, repetition and drift are shifts (population.h), and so is the
/// criterion of a judge that is not logarithmic.
const Schema<Population<SenseParameters>>& sense_schema();
const Schema<Population<JudgementParameters>>& judgement_schema(bool logarithmic);

/// How senses and decisions vary over people.
class PerceiverPopulation {
 public:
  /// @param logarithmic  whether evidence is the logarithm of a percept
  explicit PerceiverPopulation(Table& table, bool logarithmic = true);

  /// Whether any parameter differs between people.
  bool varies() const { return senses_.varies() || judgements_.varies(); }

  /// The person of a seed; each parameter has its own stream "observer KEY".
  SenseParameters draw_senses(std::uint64_t seed) const { return senses_.draw(seed); }
  JudgementParameters draw_judgement(std::uint64_t seed) const { return judgements_.draw(seed); }

 private:
  Population<SenseParameters> senses_;
  Population<JudgementParameters> judgements_;
};

}  // namespace haptrial::subject
