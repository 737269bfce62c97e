#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace haptrial {
class RandomStream;
}

namespace haptrial::protocols {

/// How the levels of a factor come to participants or follow each other.
enum class Counterbalancing : std::uint8_t {
  kFixed,     // as listed, for everybody
  kLatin,     // cyclic Latin square: every level at every place equally often
  kWilliams,  // and after every other level equally often (Williams 1949)
  kFull,      // every order equally often: up to 8 levels
  kRandom,    // drawn for each participant
};

/// The balance that a definition names: "fixed", "latin", "williams", "full", "random".
/// @throws std::invalid_argument for another word
Counterbalancing balance_named(std::string_view word);

/// How many participants it takes until every order of `levels` >= 1 levels was used equally often;
/// 0 where orders are drawn. @throws std::invalid_argument where there are too many orders.
std::int64_t participants_for(Counterbalancing balance, int levels);

/// The order in which one participant meets the levels. Over as many consecutive participants as
/// participants_for() says, each order is used once; which comes to whom is drawn from the study's
/// seed, so that it does not follow the order of arrival.
/// @param participant   from 0
/// @param study_seed    the same for all participants
/// @param session_seed  of this participant
/// @returns (levels) values 0 .. levels - 1
std::vector<int> order_of_levels(Counterbalancing balance, int levels, int participant,
                                 std::uint64_t study_seed, std::uint64_t session_seed);

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
