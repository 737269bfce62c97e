#include "protocols/psychophysics/definition/constrained_order.h"

#include <fmt/format.h>

#include <numeric>
#include <stdexcept>
#include <utility>

#include "core/base/error.h"
#include "core/base/random.h"

namespace haptrial::protocols {
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
