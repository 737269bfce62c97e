#include "core/base/definition/labels.h"

#include <algorithm>

namespace haptrial {
namespace {

// Numbers of words lie where no quantity of an experiment does, so that a word never equals one.
constexpr double kFirstWord = 1e12;

}  // namespace

double Labels::number_of(std::string_view word) {
  const auto found = std::ranges::find(words_, word);
  const auto place = found - words_.begin();
  if (found == words_.end()) {
    words_.emplace_back(word);
  }
  return kFirstWord + static_cast<double>(place);
}

std::optional<std::string> Labels::word_of(double number) const {
  const double place = number - kFirstWord;
  if (!(place >= 0.0 && place < static_cast<double>(words_.size()))) {
    return std::nullopt;
  }
  return words_[static_cast<std::size_t>(place)];
}

}  // namespace haptrial
