#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

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

}  // namespace haptrial::protocols
