#include "protocols/psychophysics/definition/names_pool.h"

#include <utility>

namespace haptrial::protocols {

std::unique_ptr<Names> NamesPool::take() {
  {
    const std::lock_guard lock(mutex_);
    if (!spare_.empty()) {
      std::unique_ptr<Names> names = std::move(spare_.back());
      spare_.pop_back();
      return names;
    }
  }
  return std::make_unique<Names>(original_);
}

void NamesPool::give_back(std::unique_ptr<Names> names) {
  names->forget_given();
  const std::lock_guard lock(mutex_);
  spare_.push_back(std::move(names));
}

}  // namespace haptrial::protocols
