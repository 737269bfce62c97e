#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/deformable/body/mesh_parts.h"

namespace haptrial::deformable {

/// Frames that move with vertices of a deforming surface. x is the mean of the unit normals of the
/// triangles at the vertex, y what of one surface edge is perpendicular to it, z = x × y; each of
/// length 1. The edge is the first, by number of its other end, that is not nearly parallel to x at
/// rest.
/// Source: Morris 2006, §5.4.2.
class VertexFrames {
 public:
  /// Origin and axes, each with a fourth number that is 0.
  struct alignas(64) Frame {
    std::array<double, 4> origin{}, x{}, y{}, z{};
  };

  /// @param rest  positions of the simulation mesh (vertices) [m]
  /// @param surface  its outer faces, normals outwards
  VertexFrames(std::span<const Eigen::Vector3d> rest, std::span<const Face> surface);

  /// Vertices that have a frame: not those where normals cancel, as where two parts touch.
  std::span<const std::int32_t> vertices() const { return vertices_; }
  std::span<const Frame> frames() const { return frames_; }  // in the same order

  /// Keeps only these, in ascending order of numbers within vertices().
  void keep(std::span<const std::int32_t> numbers);

  /// Frames at `positions` (vertices of the simulation mesh) [m]. Where a surface is crushed so
  /// that it has no normal, or its edge no direction across it, the axes stay as they were.
  /// @returns for how many they stayed.
  /// No allocation, lock or throw (SkinTest.AnUpdateDoesNotAllocate).
  std::size_t update(std::span<const Eigen::Vector3d> positions) noexcept;

 private:
  bool turn(std::size_t number, std::span<const Eigen::Vector3d> positions) noexcept;

  std::vector<Face> surface_;
  std::vector<Eigen::Vector3d> normals_;  // of faces, at the last update
  std::vector<std::int32_t> vertices_;
  std::vector<std::int32_t> edge_end_;  // by frame: the other end of its edge
  std::vector<std::size_t> first_;      // by frame, and one more: its begin in faces_
  std::vector<std::int32_t> faces_;     // around vertices
  std::vector<Frame> frames_;
};

}  // namespace haptrial::deformable
