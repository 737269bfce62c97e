#include "core/record/rows/condition_label.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/base/utf8.h"
#include "core/record/table/schema.h"

namespace haptrial::record {

std::string condition_label(std::vector<std::string> levels) {
  constexpr std::string_view kBetween = ", ";
  const std::string whole = fmt::format("{}", fmt::join(levels, kBetween));
  if (whole.size() <= kConditionBytes) {
    return whole;
  }
  const std::size_t room = (kConditionBytes + kBetween.size()) / levels.size();
  const std::size_t share = room > kBetween.size() ? room - kBetween.size() : 1;
  for (std::string& level : levels) {
    level = cut_text(level, share);
  }
  return std::string(cut_text(fmt::format("{}", fmt::join(levels, kBetween)), kConditionBytes));
}

}  // namespace haptrial::record
