#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace haptrial {

class Table;

/// Trials in which a participant is given something that a study compares trials with and without.
enum class GivenIn : std::uint8_t { kAll, kNone, kEveryOther };

/// Reads "all", "none" or "every other"; a key that is left out says all.
GivenIn read_given_in(Table& table, std::string_view key);

/// Whether a trial has it. With every other trial, the first participant is given it in the first,
/// third, ... one, and the next participant in the others. @param trial  from 1; practice: 0 @param
/// participant  from 0
bool is_given(GivenIn in, int trial, int participant) noexcept;

/// A trial's condition: "monitor on". What is given is one word.
std::string given_word(std::string_view what, bool given);
/// The conditions that trials may have, those with it first.
std::vector<std::string> given_words(std::string_view what, GivenIn in);
/// Every pair of the conditions of two things, "monitor on, hints off"; of one if the other has
/// none.
std::vector<std::string> joined_words(const std::vector<std::string>& first,
                                      const std::vector<std::string>& second);
/// Whether a condition, of several things perhaps, says that one was not given.
bool says_off(std::string_view condition, std::string_view what) noexcept;

}  // namespace haptrial
