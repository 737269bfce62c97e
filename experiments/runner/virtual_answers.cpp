#include "experiments/runner/virtual_answers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/random.h"

namespace haptrial::experiments {

using pages::ItemKind;

PageAnswer virtual_answer(const pages::Page& page, const pages::Item& item,
                          std::uint64_t session_seed, const std::string& occasion) {
  RandomStream random(session_seed, fmt::format("page {} {} {}", page.name, item.name, occasion));
  const double none = std::numeric_limits<double>::quiet_NaN();
  const auto take = [&](std::size_t index) {
    return PageAnswer{item.choices[index].number, item.choices[index].value};
  };
  switch (item.kind) {
    case ItemKind::kRead:
      return {none, ""};
    case ItemKind::kConsent:
      return take(0);
    case ItemKind::kChoice:
      if (page.kind == pages::PageKind::kEdinburgh) {
        constexpr std::size_t kRight = 3;  // "right", and "always right"
        return take(kRight + random.below(2));
      }
      return take(random.below(item.choices.size()));
    case ItemKind::kScale: {
      constexpr double kSpread = 0.2;  // of the scale
      const double steps = std::round((item.high - item.low) / item.step);
      const double at = std::round(steps * std::clamp(0.5 + kSpread * random.normal(), 0.0, 1.0));
      return {item.low + item.step * at, ""};
    }
    case ItemKind::kNumber:
      return {std::clamp(std::round(random.uniform(item.low, item.high)), item.low, item.high), ""};
    case ItemKind::kText:
      break;
  }
  return {none, "SIMULATED"};
}

}  // namespace haptrial::experiments
