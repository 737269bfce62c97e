#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>
#include <future>
#include <list>
#include <memory>
#include <mutex>

namespace haptrial {

/// Values that take long to be made, each made when it is first asked for and shared by all who ask
/// for the same: trials, participants, threads, pages of one definition while it is being written.
/// Those asked for last are kept. Any thread but the servo thread.
/// @tparam Key  everything that a value depends on, compared by ==; what it points to is constant
template <class Key, class Value>
class SharedCache {
 public:
  using Shared = std::shared_ptr<const Value>;

  /// @param most  that are kept >= 1
  explicit SharedCache(std::size_t most) : most_(most) {}

  /// @param make  called if there is none; what it throws, all get who asked for the same
  /// @returns the value, never null if make() returns none
  template <class Make>
  Shared get(const Key& key, const Make& make) {
    std::promise<Shared> promise;
    const std::shared_future<Shared> known = find_or_add(key, promise);
    if (known.valid()) {
      return known.get();
    }
    try {
      Shared value = make();
      promise.set_value(value);
      return value;
    } catch (...) {
      promise.set_exception(std::current_exception());
      throw;
    }
  }

 private:
  struct Entry {
    Key key;
    std::shared_future<Shared> made;
  };

  /// @returns not valid: it is to be made, and `promise` kept
  std::shared_future<Shared> find_or_add(const Key& key, std::promise<Shared>& promise) {
    const std::lock_guard lock(guard_);
    const auto found = std::ranges::find(entries_, key, &Entry::key);
    if (found != entries_.end()) {
      entries_.splice(entries_.begin(), entries_, found);
      return found->made;
    }
    entries_.push_front({key, promise.get_future().share()});
    if (entries_.size() > most_) {
      entries_.pop_back();
    }
    return {};
  }

  std::size_t most_;
  std::mutex guard_;
  std::list<Entry> entries_;  // those used last come first
};

}  // namespace haptrial
