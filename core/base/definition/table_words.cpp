#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <sstream>

#include "core/base/definition/table_words_internal.h"
#include "core/base/definition/toml_text_internal.h"
#include "core/base/error.h"
#include "core/base/utf8.h"

namespace haptrial {
namespace {

/// At most `most` bytes of `text`, whole characters.
std::string shortened(std::string_view text, std::size_t most) {
  return text.size() <= most ? std::string(text) : std::string(cut_text(text, most - 3)) + "...";
}

}  // namespace

bool within(double x, const Bounds& b) {
  return std::isfinite(x) && (b.open_low ? x > b.low : x >= b.low) && x <= b.high;
}

std::string words(const Bounds& bounds, std::string_view unit) {
  const std::string in = unit.empty() ? "" : fmt::format(" [{}]", unit);
  const bool low = std::isfinite(bounds.low);
  const bool high = std::isfinite(bounds.high);
  if (low && high) {
    return fmt::format("a number {} {} and at most {}{}", bounds.open_low ? "above" : "of at least",
                       bounds.low, bounds.high, in);
  }
  if (low) {
    return fmt::format("a number {} {}{}", bounds.open_low ? "above" : "of at least", bounds.low,
                       in);
  }
  if (high) {
    return fmt::format("a number of at most {}{}", bounds.high, in);
  }
  return fmt::format("a finite number{}", in);
}

std::string shown(const toml::node& node) {
  if (node.is_table()) {
    return "a table";
  }
  std::ostringstream out;
  node.visit([&](const auto& value) {
    if constexpr (toml::is_array<decltype(value)>) {
      out << "an array of " << value.size();
    } else if constexpr (toml::is_floating_point<decltype(value)>) {
      const std::string digits = fmt::format("{}", value.get());
      const bool whole = digits.find_first_not_of("-0123456789") == std::string::npos;
      out << digits << (whole ? ".0" : "");  // 2.0 is no whole number in TOML
    } else if constexpr (!toml::is_table<decltype(value)>) {
      out << value;
    }
  });
  return shortened(out.str(), 60);
}

std::string shown_with_kind(const toml::node& node) {
  return node.is_string()
             ? fmt::format("the text \"{}\"", shortened(*node.value<std::string>(), 40))
             : shown(node);
}

std::string rewritten(const toml::node& node, std::string_view key, WantedKind wanted) {
  if (wanted == WantedKind::kText) {
    if (node.is_number() || node.is_boolean()) {
      const std::string value = shown(node);
      return fmt::format("write it in quotes: {} = \"{}\"", key, value);
    }
  } else if (node.is_string()) {
    const std::string text = *node.value<std::string>();
    try {
      const toml::table inside = parse_toml("x = " + text, "");
      const toml::node* value = inside.get("x");
      const bool fits = wanted == WantedKind::kTruth   ? value->is_boolean()
                        : wanted == WantedKind::kWhole ? value->is_integer()
                                                       : value->is_number();
      if (fits && inside.size() == 1 && text.find_first_of("#\n") == std::string::npos) {
        return fmt::format("write it without quotes: {} = {}", key, text);
      }
    } catch (const InputError&) {
      return "";
    }
  } else if (wanted == WantedKind::kWhole && node.is_floating_point()) {
    const double value = *node.value<double>();
    if (value == std::floor(value) && std::abs(value) < 1e15) {
      return fmt::format("write it without a decimal point: {} = {:.0f}", key, value);
    }
  }
  return "";
}

std::string joined(const std::vector<std::string>& items) {
  return fmt::format("{}", fmt::join(items, ", "));
}

}  // namespace haptrial
