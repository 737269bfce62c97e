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

/// What a visibility pass looks at: a surface as it was at an instant.
struct VisibilityJob {
  std::uint32_t id{0};                // of the bone
  std::uint64_t generation{0};        // tells results of older jobs
  std::vector<Eigen::Vector3d> eyes;  // in B [m]
  std::vector<bone::SurfaceVertex> vertices;
  std::vector<bone::SurfaceTriangle> triangles;
};

struct VisibilityResult {
  std::uint32_t id{0};
  std::uint64_t generation{0};
  std::vector<std::uint32_t> triangles;  // slots, rising
};

/// Whether a vertex's normal is less than 90 degrees away from the direction to an eye [in B].
bool faces(const bone::SurfaceVertex& vertex, std::span<const Eigen::Vector3d> eyes);

/// The living triangles with a vertex that faces an eye, by slot. Any thread.
/// Source: Morris 2006, §3.2.7.
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
  /// What was finished since the last call.
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

/// The visible array of a bone: copies of the visible triangles, kept up to date while the surface
/// changes under an eye at rest.
class VisibleArray {
 public:
  /// @param triangles  slots, as visible_triangles() gives them
  void set(const bone::Surface& surface, std::span<const std::uint32_t> triangles);
  /// Takes over what changed in the triangles of a quad: what is gone no longer shows, what faces
  /// an eye is added.
  void refresh(const bone::Surface& surface, std::int32_t quad,
               std::span<const Eigen::Vector3d> eyes);

  std::span<const bone::SurfaceTriangle> triangles() const noexcept { return triangles_; }
  /// Where in triangles() the triangle of a slot is, for as long as it lives; -1: it does not show.
  std::int32_t place_of(std::size_t slot) const noexcept;
  /// Places in triangles() that changed since the last call; all after set().
  std::vector<std::uint32_t> take_changed();

 private:
  void put(std::size_t slot, const bone::SurfaceTriangle& triangle);

  std::vector<bone::SurfaceTriangle> triangles_;
  std::vector<std::int32_t> place_of_slot_;  // -1: not among them
  std::vector<std::uint32_t> changed_;
};

}  // namespace haptrial::render
