#include "tests/analysis/force_training/study/null_reports.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "analysis/force_training/study/study_statistics.h"
#include "core/base/random.h"

namespace haptrial::test {
namespace {

using analysis::StudyStatistics;
using analysis::TrialScore;

constexpr double kAlpha = 0.05;
using Levels = std::vector<std::string>;
using Blocks = std::map<std::int32_t, std::vector<std::size_t>>;  // scores of each block

template <class T>
void shuffle(std::vector<T>& values, RandomStream& random) {
  for (std::size_t i = values.size(); i > 1; --i) {
    std::swap(values[i - 1], values[random.below(i)]);
  }
}

/// `count` labels, each of `kinds` as often as the others.
std::vector<Levels> dealt(const std::vector<Levels>& kinds, std::size_t count,
                          RandomStream& random) {
  std::vector<Levels> labels;
  for (std::size_t i = 0; i < count; ++i) {
    labels.push_back(kinds[i % kinds.size()]);
  }
  shuffle(labels, random);
  return labels;
}

std::map<std::string, Blocks> blocks_of(std::span<const TrialScore> scores) {
  std::map<std::string, Blocks> blocks;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    blocks[scores[i].subject][scores[i].block].push_back(i);
  }
  return blocks;
}

void set(TrialScore& score, const Levels& levels) {
  score.levels = levels;
  score.condition = levels[0];
  for (std::size_t i = 1; i < levels.size(); ++i) {
    score.condition += ", " + levels[i];
  }
}

/// Labels over the blocks of each participant, behind a level of their own where there is one.
void over_blocks(std::vector<TrialScore>& scores, const std::vector<Levels>& kinds,
                 const std::vector<Levels>& own, RandomStream& random) {
  const auto blocks = blocks_of(scores);
  const auto groups = own.empty() ? own : dealt(own, blocks.size(), random);
  std::size_t participant = 0;
  for (const auto& [subject, of_subject] : blocks) {
    const auto labels = dealt(kinds, of_subject.size(), random);
    std::size_t place = 0;
    for (const auto& [block, members] : of_subject) {
      Levels levels = own.empty() ? Levels{} : groups[participant];
      levels.insert(levels.end(), labels[place].begin(), labels[place].end());
      for (const std::size_t i : members) {
        set(scores[i], levels);
      }
      ++place;
    }
    ++participant;
  }
}

void by_participant(std::vector<TrialScore>& scores, RandomStream& random) {
  for (const auto& [subject, blocks] : blocks_of(scores)) {
    std::vector<std::string> names{"haptic", "visual", "visuohaptic"};
    const std::vector<std::string> before = names;
    shuffle(names, random);
    for (const auto& [block, members] : blocks) {
      for (const std::size_t i : members) {
        const auto at = std::find(before.begin(), before.end(), scores[i].condition);
        set(scores[i], {names[static_cast<std::size_t>(at - before.begin())]});
      }
    }
  }
}

void between(std::vector<TrialScore>& scores, const std::vector<Levels>& kinds,
             RandomStream& random) {
  const auto blocks = blocks_of(scores);
  const auto labels = dealt(kinds, blocks.size(), random);
  std::size_t participant = 0;
  for (const auto& [subject, of_subject] : blocks) {
    for (const auto& [block, members] : of_subject) {
      for (const std::size_t i : members) {
        set(scores[i], labels[participant]);
      }
    }
    ++participant;
  }
}

const std::vector<Levels> kThree{{"haptic"}, {"visual"}, {"visuohaptic"}};
const std::vector<Levels> kFour{{"now", "x"}, {"now", "y"}, {"soon", "x"}, {"soon", "y"}};

std::vector<std::string> relabel(std::vector<TrialScore>& scores, NullDesign design,
                                 RandomStream& random) {
  switch (design) {
    case NullDesign::kOverBlocks:
      over_blocks(scores, kThree, {}, random);
      return {"condition"};
    case NullDesign::kByParticipant:
      by_participant(scores, random);
      return {"condition"};
    case NullDesign::kBetween:
      between(scores, kThree, random);
      return {"condition"};
    case NullDesign::kMixed:
      over_blocks(scores, kThree, {{"expert"}, {"novice"}}, random);
      return {"group", "condition"};
    case NullDesign::kTwoWithin:
      over_blocks(scores, kFour, {}, random);
      return {"delay", "shape"};
    case NullDesign::kTwoBetween:
      between(scores, kFour, random);
      return {"delay", "shape"};
  }
  return {};
}

/// Any p of a family: what Holm promises to keep.
template <class Member>
bool any_below(const analysis::TestFamily& family, Member member) {
  return std::any_of(family.tests.begin(), family.tests.end(),
                     [&](const auto& test) { return test.*member && *(test.*member) < kAlpha; });
}

void note_family(NullLevels& notes, const analysis::TestFamily& family, bool leads) {
  using analysis::SideTest;
  const std::string name = family.name + ", ";
  notes.note(name + "t-tests after Holm", leads, any_below(family, &SideTest::holm));
  notes.note(name + "rank tests after Holm", false, any_below(family, &SideTest::ranks_holm));
  notes.note(name + "permutation tests after Holm", false,
             any_below(family, &SideTest::permutation_holm));
}

NullLevels notes_of(const StudyStatistics& study) {
  NullLevels notes;
  for (const auto& effect : study.tests.effects) {
    if (effect) {
      notes.note(effect->factor + ", " + effect->test, true, effect->p < kAlpha);
    }
  }
  if (study.tests.ranks) {
    notes.note("Friedman or Kruskal-Wallis", false, study.tests.ranks->p < kAlpha);
  }
  note_family(notes, study.tests.planned, true);
  for (const auto& family : study.tests.families) {
    note_family(notes, family, false);
  }
  for (const auto& test : study.tests.planned.tests) {
    if (test.bootstrap) {
      notes.note("bootstrap 95 % CI without 0", false,
                 test.bootstrap->low > 0.0 || test.bootstrap->high < 0.0);
    }
  }
  if (study.mixed.omnibus) {
    notes.note("mixed model, all conditions", false, study.mixed.omnibus->p < kAlpha);
  }
  if (study.anova) {
    notes.note("as published: pooled analysis of variance", false, study.anova->p < kAlpha);
  }
  for (const auto& test : study.comparisons) {
    if (test.student) {
      notes.note("as published: pooled t-test", false, test.student->p < kAlpha);
    }
  }
  return notes;
}

NullLevels report_of(std::span<const TrialScore> scores, NullDesign design, std::size_t replication,
                     std::uint64_t seed) {
  RandomStream random(seed, fmt::format("null {} {}", name_of(design), replication));
  std::vector<TrialScore> relabelled(scores.begin(), scores.end());
  analysis::StudyQuestions questions;
  questions.factors = relabel(relabelled, design, random);
  using analysis::Tail;
  const bool three = questions.factors.size() == 1 || design == NullDesign::kMixed;
  if (three) {
    questions.plan.tests = {{"visual", "haptic", Tail::kLess},
                            {"visuohaptic", "visual", Tail::kLess}};
  } else {
    questions.plan.tests = {{"now", "soon", Tail::kLess}, {"x", "y", Tail::kTwoSided}};
  }
  questions.resampling = {replication, "", 999, 1};
  return notes_of(study_statistics(relabelled, questions));
}

}  // namespace

const char* name_of(NullDesign design) {
  switch (design) {
    case NullDesign::kOverBlocks:
      return "within participants, labels permuted over blocks";
    case NullDesign::kByParticipant:
      return "within participants, labels permuted by participant";
    case NullDesign::kBetween:
      return "between participants, three groups";
    case NullDesign::kMixed:
      return "mixed, two groups by three conditions";
    case NullDesign::kTwoWithin:
      return "two factors within participants";
    case NullDesign::kTwoBetween:
      return "two factors between participants";
  }
  return "";
}

std::vector<NullLevel> null_reports(std::span<const TrialScore> scores, NullDesign design,
                                    std::size_t replications, std::uint64_t seed, int threads) {
  return null_levels(replications, threads,
                     [&](std::size_t i) { return report_of(scores, design, i, seed); });
}

}  // namespace haptrial::test
