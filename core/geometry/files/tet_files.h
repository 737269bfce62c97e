#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/geometry/mesh/work.h"
#include "core/geometry/volume/tetrahedralize.h"

namespace haptrial::geometry {

/// Writes a tetrahedral mesh whole or not at all, in the format of the name's ending; units are the
/// mesh's, [m]:
///
///     .node, .ele  TetGen: both files, numbers from 0, the surface as boundary marker
///     .vtu         VTK, for ParaView: binary, the surface as point data on_surface
///     .h5          HDF5: /vertices (n x 3), /tetrahedra (m x 4), /on_surface (n)
///
/// Source: Morris 2006, §5.2.3 (files for TetGen).
/// @param overwrite  replace files that are there
/// @throws InputError for another ending, or where the file is there or cannot be made; RunError
/// when writing fails; Cancelled.
void write_tet_mesh(const std::filesystem::path& file, const TetMesh& mesh, bool overwrite = false,
                    const WorkReport& report = {});

/// Numbers of each vertex, or of each tetrahedron, in a file for ParaView.
struct TetField {
  std::string name;
  int components{1};           // 3: a vector; 6: a symmetric tensor xx, yy, zz, xy, yz, xz
  std::vector<double> values;  // components for each, one after the other
};

/// A .vtu file with fields of the vertices and of the tetrahedra. @throws as write_tet_mesh();
/// std::invalid_argument for a field of another length
void write_vtu(const std::filesystem::path& file, const TetMesh& mesh,
               const std::vector<TetField>& of_vertices, const std::vector<TetField>& of_tetrahedra,
               bool overwrite = false, const WorkReport& report = {});

/// @throws InputError where write_tet_mesh() would not know the ending.
void check_tet_ending(const std::filesystem::path& file);

}  // namespace haptrial::geometry
