#include "core/bone/pieces/pieces_search.h"

#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <thread>

#include "core/bone/pieces/world.h"

namespace haptrial::bone {

struct PiecesSearch::Impl {
  std::mutex mutex;
  std::condition_variable_any wake;
  std::jthread thread;  // last: ends before what it waits on

  Impl(BoneWorld& world, std::chrono::milliseconds pause)
      : thread([this, &world, pause](const std::stop_token& stop) {
          while (!stop.stop_requested()) {
            world.search();
            std::unique_lock lock(mutex);
            wake.wait_for(lock, stop, pause, [] { return false; });
          }
        }) {}
};

PiecesSearch::PiecesSearch(BoneWorld& world, std::chrono::milliseconds pause)
    : impl_(std::make_unique<Impl>(world, pause)) {}

PiecesSearch::~PiecesSearch() = default;

}  // namespace haptrial::bone
