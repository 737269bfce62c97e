#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/deformable/calibration/marker.h"
#include "core/deformable/elements/elastic_body.h"
#include "core/deformable/springs/spring_body.h"

namespace haptrial::experiments {

/// A table with a row for each vertex: vertex, its rest place and its displacement [m].
std::string displacements_csv(const geometry::TetMesh& mesh,
                              const std::vector<Eigen::Vector3d>& displacement);

/// Displacements of the vertices, by any program: columns ux_m, uy_m, uz_m and vertex (from 0), or
/// without vertex a row for each in their order.
/// @throws InputError naming file, line and what was found.
std::vector<Eigen::Vector3d> read_displacements(const std::filesystem::path& file,
                                                const geometry::TetMesh& mesh);

/// Whether a table of displacements says places instead of vertices.
bool has_markers(const std::filesystem::path& file);

/// Places that were measured: columns x_m, y_m, z_m at rest and ux_m, uy_m, uz_m.
/// @throws InputError naming file and what was found.
std::vector<deformable::Marker> read_markers(const std::filesystem::path& file,
                                             const geometry::TetMesh& mesh);

/// @throws InputError as deformable::parse_constants().
deformable::SpringConstants read_constants(const std::filesystem::path& file,
                                           const deformable::SpringBody& body);

/// The body for ParaView, moved: displacement of the vertices, and of elements their stress.
/// @param states  of the tetrahedra; empty: no stress
void write_state(const std::filesystem::path& file, const geometry::TetMesh& mesh,
                 const std::vector<Eigen::Vector3d>& displacement,
                 const std::vector<deformable::TetState>& states);

}  // namespace haptrial::experiments
