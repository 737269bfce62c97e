#include "protocols/psychophysics/definition/counterbalance.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

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

}  // namespace haptrial::protocols
