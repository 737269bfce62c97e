#include "analysis/psychophysics/data/word.h"

#include <array>
#include <atomic>
#include <mutex>
#include <shared_mutex>
#include <string>
#include <unordered_map>

namespace haptrial::analysis::trials {
namespace {

/// Words by number. Those that are there stay where they are while others are added, so that
/// looking at one takes no lock.
class TextStore {
 public:
  TextStore() { add({}); }

  std::uint32_t number_of(std::string_view text) {
    {
      const std::shared_lock reading(mutex_);
      if (const auto at = numbers_.find(text); at != numbers_.end()) {
        return at->second;
      }
    }
    const std::scoped_lock writing(mutex_);
    const auto at = numbers_.find(text);
    return at != numbers_.end() ? at->second : add(text);
  }

  const std::string& text(std::uint32_t number) const noexcept {
    return blocks_[number / kBlock].load(std::memory_order_acquire)[number % kBlock];
  }

 private:
  static constexpr std::uint32_t kBlock = 1024;

  std::uint32_t add(std::string_view text) {
    const std::uint32_t number = count_;
    auto& block = blocks_.at(number / kBlock);  // throws if there is no room
    if (number % kBlock == 0) {
      block.store(new std::string[kBlock], std::memory_order_release);  // lives as long as we do
    }
    std::string& kept = block.load(std::memory_order_relaxed)[number % kBlock];
    kept = text;
    numbers_.emplace(kept, number);
    count_ = number + 1;
    return number;
  }

  std::shared_mutex mutex_;
  std::uint32_t count_{0};
  std::array<std::atomic<std::string*>, 4096> blocks_{};
  std::unordered_map<std::string_view, std::uint32_t> numbers_;
};

TextStore& words() {
  static auto* const all = new TextStore;  // never gone: others look at it to the end
  return *all;
}

}  // namespace

std::uint32_t Word::number_of(std::string_view text) {
  return text.empty() ? 0 : words().number_of(text);
}

const std::string& Word::text() const noexcept { return words().text(number_); }

}  // namespace haptrial::analysis::trials
