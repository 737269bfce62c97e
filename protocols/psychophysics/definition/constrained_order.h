#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace haptrial {
class RandomStream;
}

namespace haptrial::protocols {

/// A rule that an order of trials must keep to.
struct OrderRule {
  std::string what;           // for messages: "condition", "catch"
  std::vector<int> values;    // (trials) of each trial, before it gets its place
  int most_in_a_row{2};       // trials of one value that may follow each other >= 1
  int of_value{-1};           // the value that the rule is about; -1: every value
  std::size_t not_before{0};  // place at which a trial of `of_value` may come first
};

/// A random order of the trials 0 .. count - 1 that keeps every rule. Every order that keeps them
/// can come; with a single rule or none that binds little, each about equally often.
/// @throws InputError naming the rules when none was found: there may be none
std::vector<std::size_t> constrained_order(std::size_t count, std::span<const OrderRule> rules,
                                           RandomStream& random);

/// How many places break a rule.
std::size_t broken(const OrderRule& rule, std::span<const std::size_t> order);

}  // namespace haptrial::protocols
