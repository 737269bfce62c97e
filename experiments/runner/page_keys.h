#pragma once

#include <mutex>
#include <utility>
#include <vector>

#include "core/render/gl/window.h"

namespace haptrial::experiments {

/// The keys of the participant's window on their way to a page: from the screen's thread to the
/// session's. While no page is open they are nobody's here.
class PageKeys {
 public:
  /// Screen's thread. @returns whether a page takes the key; Escape is never a page's
  bool take(const render::KeyPress& key) {
    const std::lock_guard lock(mutex_);
    if (!open_ || key.key == render::KeyPress::kEscape) {
      return false;
    }
    keys_.push_back(key);
    return true;
  }
  /// Session's thread.
  void set_open(bool open) {
    const std::lock_guard lock(mutex_);
    open_ = open;
    keys_.clear();
  }
  std::vector<render::KeyPress> pressed() {
    const std::lock_guard lock(mutex_);
    return std::exchange(keys_, {});
  }

 private:
  std::mutex mutex_;
  bool open_{false};
  std::vector<render::KeyPress> keys_;
};

}  // namespace haptrial::experiments
