#pragma once

#include <cstdint>

#include "core/subject/perceiver/felt.h"
#include "core/subject/perceiver/judgement.h"
#include "core/subject/variation.h"

namespace haptrial {
class Table;
}

namespace haptrial::subject {

/// How senses and decisions vary over people. Every key of a definition's table may be left out
/// (the default for everybody), a number, or { median = M, spread = S } (variation.h). Keys are the
/// names of the fields; bias_first, repetition and drift are shifts, and so is the criterion of a
/// judge that is not logarithmic.
class PerceiverPopulation {
 public:
  /// @param judge  what is not read: `logarithmic`, and the defaults
  explicit PerceiverPopulation(Table& table, const JudgementParameters& judge = {});

  /// Whether any parameter differs between people.
  bool varies() const;

  /// The person of a seed; each parameter has its own stream "observer KEY".
  SenseParameters draw_senses(std::uint64_t seed) const;
  JudgementParameters draw_judgement(std::uint64_t seed) const;

 private:
  static constexpr int kSenses = 9;
  static constexpr int kJudgements = 10;
  Variation senses_[kSenses];
  Variation judgements_[kJudgements];
  bool logarithmic_;
};

}  // namespace haptrial::subject
