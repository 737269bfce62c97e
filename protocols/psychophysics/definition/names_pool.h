#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "protocols/psychophysics/definition/names.h"

namespace haptrial::protocols {

/// Copies of the names of a definition for those who ask one after the other: a copy reads its
/// formulas once, not for every participant. Any thread.
class NamesPool {
 public:
  explicit NamesPool(Names original) : original_(std::move(original)) {}

  /// Nothing of it is given.
  std::unique_ptr<Names> take();
  void give_back(std::unique_ptr<Names> names);

 private:
  const Names original_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Names>> spare_;
};

}  // namespace haptrial::protocols
