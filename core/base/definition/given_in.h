#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace haptrial {

class Table;

/// Trials in which a participant is given something that a study compares trials with and without,
/// or participants with and without it.
struct GivenIn {
  enum Trials : std::uint8_t { kAll, kNone, kEveryOther };
  Trials trials{kAll};
  std::vector<std::string> groups{};  // whose participants alone are given it; empty: everybody

  bool operator==(const GivenIn&) const = default;
};

/// Reads "all", "none", "every other" or an array of groups; a key that is left out says all.
GivenIn read_given_in(Table& table, std::string_view key);

/// A trial as far as it matters for what is given in it.
struct GivenPlace {
  int trial{1};              // from 1; practice: 0
  int participant{0};        // from 0
  std::string_view group{};  // of the participant; empty: none
};

/// Whether a trial has it. With every other trial, the first participant is given it in the first,
/// third, ... one, and the next participant in the others.
bool is_given(const GivenIn& in, const GivenPlace& place) noexcept;

/// Where it is given: "in every procedure", "in every other one", "in every procedure of the group
/// hints"; empty if nowhere. @param trial  what a trial is called, "procedure"
std::string given_text(const GivenIn& in, std::string_view trial);

/// A trial's condition: "monitor on". What is given is one word.
std::string given_word(std::string_view what, bool given);
/// The conditions that trials may have, those with it first.
/// @param paused  there are trials in which nothing at all is given
std::vector<std::string> given_words(std::string_view what, const GivenIn& in, bool paused = false);
/// Every pair of the conditions of two things, "monitor on, hints off"; of one if the other has
/// none.
std::vector<std::string> joined_words(const std::vector<std::string>& first,
                                      const std::vector<std::string>& second);
/// Whether a condition, of several things perhaps, says that one was not given.
bool says_off(std::string_view condition, std::string_view what) noexcept;

}  // namespace haptrial
