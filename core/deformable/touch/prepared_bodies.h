#pragma once

#include <algorithm>
#include <exception>
#include <future>
#include <list>
#include <memory>
#include <mutex>

#include "core/deformable/touch/haptic_mesh.h"

namespace haptrial::deformable {

inline constexpr std::size_t kMostPrepared = 128;

/// Bodies of tissues, each made when it is first asked for and shared by all who ask for the same:
/// trials, participants, threads. Those asked for last are kept, kMostPrepared of them. Any thread
/// but the servo thread.
template <class Tissue, class Body>
class PreparedBodies {
 public:
  using Shared = std::shared_ptr<const Body>;

  /// @param make  called if there is none; what it throws, all get who asked for the same
  template <class Make>
  Shared get(const SharedHapticMesh& mesh, const Tissue& tissue, const Make& make) {
    std::promise<Shared> promise;
    const std::shared_future<Shared> known = find_or_add(mesh, tissue, promise);
    if (known.valid()) {
      return known.get();
    }
    try {
      Shared body = make();
      promise.set_value(body);
      return body;
    } catch (...) {
      promise.set_exception(std::current_exception());
      throw;
    }
  }

 private:
  struct Entry {
    SharedHapticMesh mesh;
    Tissue tissue;
    std::shared_future<Shared> made;
  };

  /// @returns not valid: it is to be made, and `promise` kept
  std::shared_future<Shared> find_or_add(const SharedHapticMesh& mesh, const Tissue& tissue,
                                         std::promise<Shared>& promise) {
    const std::lock_guard lock(guard_);
    const auto found = std::ranges::find_if(entries_, [&](const Entry& entry) {
      return entry.tissue == tissue && (entry.mesh == mesh || same_mesh(*entry.mesh, *mesh));
    });
    if (found != entries_.end()) {
      entries_.splice(entries_.begin(), entries_, found);
      return found->made;
    }
    entries_.push_front({mesh, tissue, promise.get_future().share()});
    if (entries_.size() > kMostPrepared) {
      entries_.pop_back();
    }
    return {};
  }

  std::mutex guard_;
  std::list<Entry> entries_;  // those used last come first
};

}  // namespace haptrial::deformable
