#include "tests/analysis/force_training/report/null_comparisons.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "analysis/force_training/report/comparison.h"
#include "core/base/random.h"

namespace haptrial::test {
namespace {

using analysis::TrialScore;

constexpr double kAlpha = 0.05;
using Key = std::pair<std::string, std::int32_t>;  // participant, block

/// Half of them, drawn at random.
template <class T>
void draw_half(std::vector<T> all, RandomStream& random, std::set<T>& drawn) {
  for (std::size_t i = all.size(); i > 1; --i) {
    std::swap(all[i - 1], all[random.below(i)]);
  }
  drawn.insert(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2));
}

std::set<Key> half_of_blocks(std::span<const TrialScore> scores, RandomStream& random) {
  std::map<std::pair<std::string, std::string>, std::set<Key>> blocks;
  for (const TrialScore& s : scores) {
    blocks[{s.subject, s.condition}].insert({s.subject, s.block});
  }
  std::set<Key> drawn;
  for (const auto& [whose, keys] : blocks) {
    draw_half(std::vector<Key>(keys.begin(), keys.end()), random, drawn);
  }
  return drawn;
}

std::set<std::string> half_of_participants(std::span<const TrialScore> scores,
                                           RandomStream& random) {
  std::set<std::string> all;
  for (const TrialScore& s : scores) {
    all.insert(s.subject);
  }
  std::set<std::string> drawn;
  draw_half(std::vector<std::string>(all.begin(), all.end()), random, drawn);
  return drawn;
}

analysis::StudyComparison split_study(std::span<const TrialScore> scores, NullSplit split,
                                      RandomStream& random) {
  analysis::ScoredStudy first;
  analysis::ScoredStudy second;
  first.name = "first";
  second.name = "second";
  const bool by_block = split == NullSplit::kBlocks;
  const auto blocks = by_block ? half_of_blocks(scores, random) : std::set<Key>{};
  const auto people = by_block ? std::set<std::string>{} : half_of_participants(scores, random);
  for (const TrialScore& s : scores) {
    const bool drawn =
        by_block ? blocks.contains({s.subject, s.block}) : people.contains(s.subject);
    (drawn ? first : second).scores.push_back(s);
  }
  for (auto* study : {&first, &second}) {
    std::set<std::string> own;
    for (const TrialScore& s : study->scores) {
      if (own.insert(s.subject).second) {
        study->people.push_back({s.subject});
      }
    }
  }
  return analysis::compare_studies(std::move(first), std::move(second));
}

NullLevels levels_of(const analysis::StudyComparison& comparison, bool paired) {
  NullLevels levels;
  bool any_paired = false;
  bool any_welch = false;
  for (const auto& c : comparison.conditions) {
    any_paired = any_paired || (c.paired_holm && *c.paired_holm < kAlpha);
    any_welch = any_welch || (c.welch_holm && *c.welch_holm < kAlpha);
    if (c.paired) {
      levels.note("one condition: paired t, not adjusted", false, c.paired->p < kAlpha);
    }
    if (c.welch) {
      levels.note("one condition: Welch's t, not adjusted", false, c.welch->p < kAlpha);
    }
  }
  if (paired) {
    levels.note("any condition: paired t after Holm", true, any_paired);
  }
  levels.note("any condition: Welch's t after Holm", !paired, any_welch);
  return levels;
}

/// The test that compare does not do: every trial counted as independent.
void note_pooled(NullLevels& levels, const analysis::StudyComparison& comparison) {
  for (const auto& c : comparison.conditions) {
    std::vector<double> values[2];
    for (const auto* study : {&comparison.first, &comparison.second}) {
      for (const TrialScore& s : study->scores) {
        if (s.condition == c.condition) {
          values[study == &comparison.second].push_back(s.score);
        }
      }
    }
    const auto t = analysis::welch_t_test(values[1], values[0], analysis::Tail::kTwoSided);
    levels.note("one condition: t over trials (not in the comparison)", false, t && t->p < kAlpha);
  }
}

}  // namespace

const char* name_of(NullSplit split) {
  return split == NullSplit::kBlocks ? "blocks split, the same participants" : "participants split";
}

std::vector<NullLevel> null_comparisons(std::span<const TrialScore> scores, NullSplit split,
                                        std::size_t replications, std::uint64_t seed, int threads) {
  return null_levels(replications, threads, [&](std::size_t i) {
    RandomStream random(seed, fmt::format("null comparison {} {}", name_of(split), i));
    const auto comparison = split_study(scores, split, random);
    NullLevels levels = levels_of(comparison, split == NullSplit::kBlocks);
    note_pooled(levels, comparison);
    return levels;
  });
}

}  // namespace haptrial::test
