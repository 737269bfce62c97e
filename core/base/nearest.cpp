#include "core/base/nearest.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>

namespace haptrial {
namespace {

char small(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

constexpr std::size_t kLongestWord = 100;  // nobody mistypes a longer one; bounds the time

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = small(a[i - 1]) == small(b[j - 1]);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same ? 0 : 1)});
      if (i > 1 && j > 1 && small(a[i - 1]) == small(b[j - 2]) &&
          small(a[i - 2]) == small(b[j - 1])) {
        row[j] = std::min(row[j], before[j - 2] + 1);
      }
    }
    before.swap(last);
    last.swap(row);
  }
  return last[b.size()];
}

std::optional<std::string> nearest(std::string_view word, const std::vector<std::string>& known) {
  std::optional<std::string> best;
  std::size_t least = 0;
  for (const std::string& candidate : known) {
    const std::size_t longer = std::max(word.size(), candidate.size());
    if (longer > kLongestWord) {
      continue;
    }
    const std::size_t distance = edit_distance(word, candidate);
    if (3 * distance < longer && (!best || distance < least)) {
      best = candidate;
      least = distance;
    }
  }
  return best;
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& known) {
  const auto best = nearest(word, known);
  return best ? "; did you mean " + *best + "?" : "";
}

std::string not_allowed(std::string_view what, std::string_view found,
                        const std::vector<std::string>& allowed) {
  std::string_view word = found;
  while (!word.empty() && (word.front() == '\'' || word.front() == '"')) {
    word.remove_prefix(1);
  }
  while (!word.empty() && (word.back() == '\'' || word.back() == '"')) {
    word.remove_suffix(1);
  }
  const std::string hint = did_you_mean(word, allowed);
  return fmt::format("{} is {}{} allowed: {}", what, found, hint.empty() ? ";" : hint,
                     fmt::join(allowed, ", "));
}

}  // namespace haptrial
