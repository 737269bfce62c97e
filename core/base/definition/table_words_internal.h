#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <toml++/toml.h>

#include "core/base/definition/bounds.h"

namespace haptrial {

// The parts of a table's error sentences.

/// Whether a finite number lies within the bounds.
bool within(double x, const Bounds& bounds);

/// "a number above 0 [m/s]"
std::string words(const Bounds& bounds, std::string_view unit);

/// What stands in the file, short enough for a sentence.
std::string shown(const toml::node& node);

/// The same, with "the text" before a text.
std::string shown_with_kind(const toml::node& node);

enum class WantedKind { kNumber, kWhole, kTruth, kText };
template <class T>
constexpr WantedKind wanted() {
  return std::is_same_v<T, std::string>    ? WantedKind::kText
         : std::is_same_v<T, bool>         ? WantedKind::kTruth
         : std::is_same_v<T, std::int64_t> ? WantedKind::kWhole
                                           : WantedKind::kNumber;
}

/// "write it without quotes: rate = 1000", for a value that is good but for its quotes or its
/// decimal point; empty for others. @param key  "rate"
std::string rewritten(const toml::node& node, std::string_view key, WantedKind wanted);

/// The items with commas between them.
std::string joined(const std::vector<std::string>& items);

}  // namespace haptrial
