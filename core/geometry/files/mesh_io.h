#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/geometry/mesh/mesh.h"
#include "core/geometry/mesh/work.h"

namespace haptrial::geometry {

enum class MeshFormat { kObj, kPly, kStl };

/// Format by the name's ending: .obj, .ply or .stl, in either case.
/// @throws InputError for any other.
MeshFormat mesh_format(const std::filesystem::path& file);

/// Coordinates beyond this are refused: squares and cubes of them must stay finite in floats.
inline constexpr double kMaxCoordinate = 1e12;

/// Reads a mesh. Faces with more than three corners, concave ones too, are cut into triangles
/// (FaceCutter); normals, colours, texture coordinates, names and materials are left out. OBJ and
/// PLY keep their vertices as they are, referenced or not; STL has none of its own, so corners
/// with equal coordinates become one vertex.
/// @param name  stands in messages for the file
/// @throws InputError with one sentence (file, line or byte, what was found, what is allowed) for
/// whatever is no such mesh: empty, truncated, not finite, an index without a vertex, a face that
/// crosses itself, no triangle.
/// What is read fits the file's size: no count in it is believed before the bytes are seen.
Mesh parse_mesh(std::string_view bytes, MeshFormat format, std::string_view name,
                const WorkReport& report = {});
/// The same from a file. @throws InputError also where it cannot be read.
Mesh read_mesh(const std::filesystem::path& file, const WorkReport& report = {});

/// The bytes of a file: text with round-trip doubles (OBJ), binary doubles (PLY), binary
/// floats without shared vertices (STL).
std::string encode_mesh(const Mesh& mesh, MeshFormat format);
/// Writes a file whole or not at all. @param overwrite  replace a file that is there.
/// @throws InputError where it cannot be written or is there; RunError when writing fails half-way.
void write_mesh(const std::filesystem::path& file, const Mesh& mesh, bool overwrite = false);

/// Largest memory that read_mesh needs for a file of this size, beside the file itself [bytes].
std::uint64_t reading_memory(std::uint64_t file_bytes, MeshFormat format);

}  // namespace haptrial::geometry
