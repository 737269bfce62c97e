#include "core/render/bone/bone_visibility.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/base/growth.h"

namespace haptrial::render {

bool faces(const bone::SurfaceVertex& vertex, std::span<const Eigen::Vector3d> eyes) {
  const Eigen::Vector3d place(vertex.place[0], vertex.place[1], vertex.place[2]);
  const Eigen::Vector3d normal(vertex.normal[0], vertex.normal[1], vertex.normal[2]);
  return std::any_of(eyes.begin(), eyes.end(),
                     [&](const Eigen::Vector3d& eye) { return normal.dot(eye - place) > 0.0; });
}

std::vector<std::uint8_t> facing(std::span<const bone::SurfaceVertex> vertices,
                                 std::span<const Eigen::Vector3d> eyes) {
  std::vector<std::uint8_t> facing(vertices.size());
  std::transform(vertices.begin(), vertices.end(), facing.begin(), [&](const auto& vertex) {
    return static_cast<std::uint8_t>(faces(vertex, eyes));
  });
  return facing;
}

std::vector<std::uint32_t> visible_triangles(std::span<const bone::SurfaceVertex> vertices,
                                             std::span<const bone::SurfaceTriangle> triangles,
                                             std::span<const Eigen::Vector3d> eyes) {
  return visible_triangles(facing(vertices, eyes), triangles);
}

std::vector<std::uint32_t> visible_triangles(std::span<const std::uint8_t> facing,
                                             std::span<const bone::SurfaceTriangle> triangles) {
  std::vector<std::uint32_t> visible;
  for (std::size_t slot = 0; slot < triangles.size(); ++slot) {
    const bone::SurfaceTriangle& t = triangles[slot];
    if (t[0] != t[1] && (facing[t[0]] | facing[t[1]] | facing[t[2]]) != 0) {
      visible.push_back(static_cast<std::uint32_t>(slot));
    }
  }
  return visible;
}

VisibilityWorker::VisibilityWorker() : thread_([this] { work(); }) {}

VisibilityWorker::~VisibilityWorker() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void VisibilityWorker::submit(VisibilityJob job) {
  {
    const std::lock_guard lock(mutex_);
    const auto older = std::find_if(jobs_.begin(), jobs_.end(),
                                    [&](const VisibilityJob& j) { return j.id == job.id; });
    if (older != jobs_.end()) {
      *older = std::move(job);
    } else {
      jobs_.push_back(std::move(job));
    }
  }
  changed_.notify_all();
}

std::vector<VisibilityResult> VisibilityWorker::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(results_, {});
}

void VisibilityWorker::wait() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return jobs_.empty() && !busy_; });
}

void VisibilityWorker::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stop_ || !jobs_.empty(); });
    if (stop_) {
      return;
    }
    const VisibilityJob job = std::move(jobs_.front());
    jobs_.erase(jobs_.begin());
    busy_ = true;
    lock.unlock();
    VisibilityResult result{job.id, job.generation, visible_triangles(job.facing, job.triangles)};
    lock.lock();
    busy_ = false;
    results_.push_back(std::move(result));
    changed_.notify_all();
  }
}

void VisibleArray::set(const bone::Surface& surface, std::span<const std::uint32_t> triangles) {
  slots_.assign(triangles.begin(), triangles.end());
  place_of_slot_.assign(surface.triangles().size(), -1);
  for (std::size_t place = 0; place < slots_.size(); ++place) {
    place_of_slot_[triangles[place]] = static_cast<std::int32_t>(place);
  }
  changed_.resize(slots_.size());
  std::iota(changed_.begin(), changed_.end(), 0U);
}

void VisibleArray::refresh(const bone::Surface& surface, std::int32_t quad,
                           std::span<const Eigen::Vector3d> eyes) {
  for (std::size_t half = 0; half < 2; ++half) {
    const std::size_t slot = 2 * static_cast<std::size_t>(quad) + half;
    const bone::SurfaceTriangle& t = surface.triangles()[slot];
    put(slot, t[0] != t[1] && std::any_of(t.begin(), t.end(), [&](std::uint32_t v) {
                return faces(surface.vertices()[v], eyes);
              }));
  }
}

void VisibleArray::put(std::size_t slot, bool visible) {
  if (slot >= place_of_slot_.size()) {
    resize_slowly(place_of_slot_, slot + 1, -1);
  }
  std::int32_t& place = place_of_slot_[slot];
  if (place < 0) {
    if (!visible) {
      return;
    }
    place = static_cast<std::int32_t>(slots_.size());
    resize_slowly(slots_, slots_.size() + 1);
  }
  slots_[static_cast<std::size_t>(place)] = visible ? static_cast<std::int32_t>(slot) : -1;
  changed_.push_back(static_cast<std::uint32_t>(place));
}

std::int32_t VisibleArray::place_of(std::size_t slot) const noexcept {
  const std::int32_t place = slot < place_of_slot_.size() ? place_of_slot_[slot] : -1;
  return place < 0 || slots_[static_cast<std::size_t>(place)] < 0 ? -1 : place;
}

std::vector<std::uint32_t> VisibleArray::take_changed() { return std::exchange(changed_, {}); }

}  // namespace haptrial::render
