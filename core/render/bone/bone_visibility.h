#pragma once

#include <Eigen/Core>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <thread>
#include <vector>

#include "core/bone/surface/surface.h"

namespace haptrial::render {

/// Input of a visibility pass: a surface as it was at an instant.
struct VisibilityJob {
  std::uint32_t id{0};               // of the bone
  std::uint64_t generation{0};       // tells results of older jobs
  std::vector<std::uint8_t> facing;  // by vertex: whether it faces an eye
  std::vector<bone::SurfaceTriangle> triangles;
};

struct VisibilityResult {
  std::uint32_t id{0};
  std::uint64_t generation{0};
  std::vector<std::uint32_t> triangles;  // slots, rising
};

/// Whether a vertex's normal is less than 90 degrees away from the direction to an eye [in B].
bool faces(const bone::SurfaceVertex& vertex, std::span<const Eigen::Vector3d> eyes);

/// Whether each vertex faces an eye. Any thread.
std::vector<std::uint8_t> facing(std::span<const bone::SurfaceVertex> vertices,
                                 std::span<const Eigen::Vector3d> eyes);

/// The living triangles with a vertex that faces an eye, by slot. Any thread.
/// Source: Morris 2006, §3.2.7.
std::vector<std::uint32_t> visible_triangles(std::span<const std::uint8_t> facing,
                                             std::span<const bone::SurfaceTriangle> triangles);
std::vector<std::uint32_t> visible_triangles(std::span<const bone::SurfaceVertex> vertices,
                                             std::span<const bone::SurfaceTriangle> triangles,
                                             std::span<const Eigen::Vector3d> eyes);

/// Does one visibility pass after the other on a thread of its own. One thread calls.
class VisibilityWorker {
 public:
  VisibilityWorker();
  ~VisibilityWorker();
  VisibilityWorker(const VisibilityWorker&) = delete;
  VisibilityWorker& operator=(const VisibilityWorker&) = delete;

  /// Does not wait for a pass; a job of the same bone that has not begun is replaced.
  void submit(VisibilityJob job);
  /// Results that were finished since the last call.
  std::vector<VisibilityResult> take();
  /// Waits until every job is finished.
  void wait();

 private:
  void work();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<VisibilityJob> jobs_;
  std::vector<VisibilityResult> results_;
  bool busy_{false};
  bool stop_{false};
  std::thread thread_;
};

/// The visible array of a bone: which triangle of the surface is at which place, kept up to date
/// while the surface changes under an eye at rest.
class VisibleArray {
 public:
  /// @param triangles  slots, as visible_triangles() gives them
  void set(const bone::Surface& surface, std::span<const std::uint32_t> triangles);
  /// Takes over what changed in the triangles of a quad: what is gone no longer shows, what faces
  /// an eye is added.
  void refresh(const bone::Surface& surface, std::int32_t quad,
               std::span<const Eigen::Vector3d> eyes);

  std::size_t size() const noexcept { return slots_.size(); }  // places
  /// The triangle at a place; one of three equal corners where none shows any more.
  /// @param surface  as it was last followed
  bone::SurfaceTriangle triangle(const bone::Surface& surface, std::size_t place) const noexcept {
    const std::int32_t slot = slots_[place];
    return slot < 0 ? bone::SurfaceTriangle{0, 0, 0}
                    : surface.triangles()[static_cast<std::size_t>(slot)];
  }
  /// The place of the triangle of a slot, for as long as it lives; -1: it does not show.
  std::int32_t place_of(std::size_t slot) const noexcept;
  /// Places that changed since the last call; all after set().
  std::vector<std::uint32_t> take_changed();

 private:
  void put(std::size_t slot, bool visible);

  std::vector<std::int32_t> slots_;          // by place; -1: it no longer shows
  std::vector<std::int32_t> place_of_slot_;  // -1: it never showed
  std::vector<std::uint32_t> changed_;
};

}  // namespace haptrial::render
