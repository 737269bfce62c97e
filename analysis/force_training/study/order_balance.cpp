#include "analysis/force_training/study/order_balance.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

namespace haptrial::analysis {
namespace {

using Sequence = std::vector<std::size_t>;  // conditions of a participant's blocks, in order

struct Block {
  std::int32_t first_trial{0};
  std::set<std::size_t> conditions;
};

/// Sequences by subject; nothing if a block holds several conditions.
std::optional<std::map<std::string, Sequence>> sequences(
    std::span<const TrialScore> scores, const std::vector<std::string>& conditions) {
  std::map<std::string, std::map<std::int32_t, Block>> blocks;
  for (const TrialScore& s : scores) {
    const auto [at, is_new] = blocks[s.subject].try_emplace(s.block, Block{s.trial, {}});
    Block& block = at->second;
    block.first_trial = std::min(block.first_trial, s.trial);
    const auto condition = std::find(conditions.begin(), conditions.end(), s.condition);
    block.conditions.insert(static_cast<std::size_t>(condition - conditions.begin()));
  }
  std::map<std::string, Sequence> result;
  for (const auto& [subject, of_subject] : blocks) {
    std::vector<Block> ordered;
    for (const auto& [number, block] : of_subject) {
      if (block.conditions.size() > 1) {
        return std::nullopt;
      }
      ordered.push_back(block);
    }
    std::stable_sort(ordered.begin(), ordered.end(),
                     [](const Block& a, const Block& b) { return a.first_trial < b.first_trial; });
    for (const Block& block : ordered) {
      result[subject].push_back(*block.conditions.begin());
    }
  }
  return result;
}

/// Whole groups of `size`, each with every condition once; a last part of a group is left out.
bool in_groups(const Sequence& sequence, std::size_t size) {
  for (std::size_t begin = 0; begin + size <= sequence.size(); begin += size) {
    const auto at = sequence.begin() + static_cast<std::ptrdiff_t>(begin);
    if (std::set<std::size_t>(at, at + static_cast<std::ptrdiff_t>(size)).size() < size) {
      return false;
    }
  }
  return sequence.size() >= size;
}

void count(OrderBalance& balance, const Sequence& sequence) {
  const std::size_t size = balance.conditions.size();
  for (std::size_t i = 0; i < sequence.size() / size * size; ++i) {
    ++balance.at_place[sequence[i]][i % size];
    if (i % size > 0) {
      ++balance.after[sequence[i]][sequence[i - 1]];
    }
  }
}

}  // namespace

bool OrderBalance::places_balanced() const {
  return grouped && std::all_of(at_place.begin(), at_place.end(), [&](const auto& row) {
           return std::all_of(row.begin(), row.end(),
                              [&](std::size_t n) { return n == at_place.front().front(); });
         });
}

bool OrderBalance::sequences_balanced() const {
  if (!grouped) {
    return false;
  }
  for (std::size_t a = 0; a < after.size(); ++a) {
    for (std::size_t b = 0; b < after.size(); ++b) {
      if (a != b && after[a][b] != after[0][1]) {
        return false;
      }
    }
  }
  return true;
}

OrderBalance order_balance(std::span<const TrialScore> scores,
                           const std::vector<std::string>& conditions) {
  OrderBalance balance;
  const std::size_t size = conditions.size();
  const auto found = size > 1 ? sequences(scores, conditions) : std::nullopt;
  if (!found || found->empty() || !std::all_of(found->begin(), found->end(), [&](const auto& each) {
        return in_groups(each.second, size);
      })) {
    return balance;
  }
  balance.grouped = true;
  balance.conditions = conditions;
  balance.at_place.assign(size, std::vector<std::size_t>(size, 0));
  balance.after = balance.at_place;
  for (const auto& [subject, sequence] : *found) {
    count(balance, sequence);
  }
  return balance;
}

std::string sentence_of(const OrderBalance& balance) {
  if (!balance.grouped) {
    return "The order of conditions cannot be checked: blocks do not come in groups that hold each "
           "condition once.";
  }
  if (balance.places_balanced()) {
    return fmt::format(
        "Order is balanced: in groups of {} blocks each condition came {} times at each place{}.",
        balance.conditions.size(), balance.at_place.front().front(),
        balance.sequences_balanced()
            ? fmt::format(" and {} times directly after each other condition", balance.after[0][1])
            : "; which condition follows which is not balanced");
  }
  std::string counts;
  for (std::size_t c = 0; c < balance.conditions.size(); ++c) {
    counts += fmt::format("{}{} {}", c > 0 ? "; " : "", balance.conditions[c],
                          fmt::join(balance.at_place[c], ", "));
  }
  return fmt::format(
      "Order is not balanced, so an effect of practice or fatigue can look like one of the "
      "condition. Times at place 1 to {} of a group of blocks: {}.",
      balance.conditions.size(), counts);
}

}  // namespace haptrial::analysis
