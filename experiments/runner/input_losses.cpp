#include "experiments/runner/input_losses.h"

#include <fmt/format.h>

namespace haptrial::experiments {

std::vector<InputNews> InputLosses::take(const std::string& input,
                                         const std::vector<device::InputChange>& changes) {
  std::vector<InputNews> all;
  for (const device::InputChange& change : changes) {
    if (change.back) {
      all.push_back({what_ + "_back", input, ""});
      continue;
    }
    ++losses_;
    const std::string notice = fmt::format(
        "the {0} {1} is lost ({2}): it {3} until it is connected again; events {4}_lost "
        "and {4}_back say when",
        name_, input, change.why, meanwhile_, what_);
    all.push_back(
        {what_ + "_lost", fmt::format("{}: {}", input, change.why), losses_ > 1 ? "" : notice});
  }
  return all;
}

std::string InputLosses::sentence(const std::string& input) const {
  return losses_ < 2
             ? ""
             : fmt::format("the {0} {1} was lost {2} times; events {3}_lost and {3}_back say when",
                           name_, input, losses_, what_);
}

}  // namespace haptrial::experiments
