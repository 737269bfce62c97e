#include "core/questions/page.h"

#include <algorithm>
#include <stdexcept>

namespace haptrial::questions {

const Page& PagePlan::page(const std::string& name) const {
  const auto found =
      std::find_if(pages.begin(), pages.end(), [&](const Page& each) { return each.name == name; });
  if (found == pages.end()) {
    throw std::invalid_argument("PagePlan::page: there is no page \"" + name + "\"");
  }
  return *found;
}

}  // namespace haptrial::questions
