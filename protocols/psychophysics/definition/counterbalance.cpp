#include "protocols/psychophysics/definition/counterbalance.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "core/base/error.h"
#include "core/base/random.h"
#include "protocols/definition/schedule.h"

namespace haptrial::protocols {
namespace {

constexpr int kMostForFull = 8;

constexpr std::array<std::pair<std::string_view, Counterbalancing>, 5> kNames{
    {{"fixed", Counterbalancing::kFixed},
     {"latin", Counterbalancing::kLatin},
     {"williams", Counterbalancing::kWilliams},
     {"full", Counterbalancing::kFull},
     {"random", Counterbalancing::kRandom}}};

std::vector<int> as_listed(int levels) {
  std::vector<int> order(static_cast<std::size_t>(levels));
  std::iota(order.begin(), order.end(), 0);
  return order;
}

void shuffle_levels(std::vector<int>& order, RandomStream& random) {
  for (std::size_t k = order.size(); k > 1; --k) {
    std::swap(order[k - 1], order[random.below(k)]);
  }
}

std::int64_t factorial(int n) { return n <= 1 ? 1 : n * factorial(n - 1); }

/// The permutation of this number in lexical order.
std::vector<int> permutation(int levels, std::int64_t number) {
  std::vector<int> left = as_listed(levels);
  std::vector<int> order;
  for (int n = levels; n > 0; --n) {
    const std::int64_t rest = factorial(n - 1);
    const auto at = left.begin() + static_cast<std::ptrdiff_t>(number / rest);
    order.push_back(*at);
    left.erase(at);
    number %= rest;
  }
  return order;
}

/// The row of a balanced set that a participant gets: a shuffled round of all rows after another.
std::int64_t row_of_participant(std::int64_t rows, int participant, std::uint64_t study_seed) {
  const std::int64_t round = participant / rows;
  RandomStream random(study_seed, "orders of levels " + std::to_string(round));
  std::vector<int> shuffled = as_listed(static_cast<int>(rows));
  shuffle_levels(shuffled, random);
  return shuffled[static_cast<std::size_t>(participant % rows)];
}

}  // namespace

Counterbalancing balance_named(std::string_view word) {
  const auto found = std::ranges::find(kNames, word, [](const auto& name) { return name.first; });
  if (found == kNames.end()) {
    throw std::invalid_argument("'" + std::string(word) +
                                "' is no order of levels; allowed: fixed, latin, williams, full, "
                                "random");
  }
  return found->second;
}

std::int64_t participants_for(Counterbalancing balance, int levels) {
  if (levels < 1) {
    throw std::invalid_argument("participants_for: there must be a level");
  }
  switch (balance) {
    case Counterbalancing::kFixed:
      return 1;
    case Counterbalancing::kLatin:
      return levels;
    case Counterbalancing::kWilliams:
      return static_cast<std::int64_t>(williams_rows(levels).size());
    case Counterbalancing::kFull:
      if (levels > kMostForFull) {
        throw std::invalid_argument("every order of " + std::to_string(levels) +
                                    " levels are too many; choose latin or williams, or up to 8");
      }
      return factorial(levels);
    case Counterbalancing::kRandom:
      break;
  }
  return 0;
}

std::vector<int> order_of_levels(Counterbalancing balance, int levels, int participant,
                                 std::uint64_t study_seed, std::uint64_t session_seed) {
  const std::int64_t rows = participants_for(balance, levels);
  if (rows == 0) {
    RandomStream random(session_seed, "order of levels");
    std::vector<int> order = as_listed(levels);
    shuffle_levels(order, random);
    return order;
  }
  const std::int64_t row = row_of_participant(rows, participant, study_seed);
  switch (balance) {
    case Counterbalancing::kLatin: {
      std::vector<int> order = as_listed(levels);
      std::ranges::rotate(order, order.begin() + row);
      return order;
    }
    case Counterbalancing::kWilliams:
      return williams_rows(levels)[static_cast<std::size_t>(row)];
    case Counterbalancing::kFull:
      return permutation(levels, row);
    default:
      return as_listed(levels);
  }
}

namespace {

constexpr int kAttempts = 200;       // whole shuffles
constexpr int kSwapsPerTrial = 200;  // that mend one of them

std::vector<std::size_t> shuffled(std::size_t count, RandomStream& random) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t k = count; k > 1; --k) {
    std::swap(order[k - 1], order[random.below(k)]);
  }
  return order;
}

std::size_t all_broken(std::span<const OrderRule> rules, std::span<const std::size_t> order) {
  std::size_t sum = 0;
  for (const OrderRule& rule : rules) {
    sum += broken(rule, order);
  }
  return sum;
}

/// Swaps places at random as long as no more rules are broken than before. @returns whether all are
/// kept
bool mend(std::span<const OrderRule> rules, std::vector<std::size_t>& order, RandomStream& random) {
  std::size_t now = all_broken(rules, order);
  const std::size_t swaps = kSwapsPerTrial * order.size();
  for (std::size_t k = 0; k < swaps && now > 0; ++k) {
    const std::size_t a = random.below(order.size());
    const std::size_t b = random.below(order.size());
    std::swap(order[a], order[b]);
    const std::size_t then = all_broken(rules, order);
    if (then > now) {
      std::swap(order[a], order[b]);
    } else {
      now = then;
    }
  }
  return now == 0;
}

}  // namespace

std::size_t broken(const OrderRule& rule, std::span<const std::size_t> order) {
  std::size_t count = 0;
  int run = 0;
  for (std::size_t place = 0; place < order.size(); ++place) {
    const int value = rule.values[order[place]];
    const bool bound = rule.of_value < 0 || value == rule.of_value;
    const bool goes_on = place > 0 && rule.values[order[place - 1]] == value;
    run = goes_on ? run + 1 : 1;
    count += bound && run > rule.most_in_a_row ? 1 : 0;
    count += rule.of_value >= 0 && bound && place < rule.not_before ? 1 : 0;
  }
  return count;
}

std::vector<std::size_t> constrained_order(std::size_t count, std::span<const OrderRule> rules,
                                           RandomStream& random) {
  for (const OrderRule& rule : rules) {
    if (rule.values.size() != count || rule.most_in_a_row < 1) {
      throw std::invalid_argument("constrained_order: the rule about " + rule.what +
                                  " does not fit the trials");
    }
  }
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    std::vector<std::size_t> order = shuffled(count, random);
    if (all_broken(rules, order) == 0 || mend(rules, order, random)) {
      return order;
    }
  }
  std::string names;
  for (const OrderRule& rule : rules) {
    names += (names.empty() ? "" : ", ") + rule.what;
  }
  throw InputError(fmt::format(
      "no order of {} trials was found that keeps the rules about {}; loosen one of them", count,
      names));
}

}  // namespace haptrial::protocols
