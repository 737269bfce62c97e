#include "core/geometry/files/tet_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <iterator>
#include <stdexcept>

#include "core/base/error.h"
#include "core/base/whole_file.h"
#include "core/geometry/files/hdf5_output.h"

namespace haptrial::geometry {
namespace fs = std::filesystem;
namespace {

static_assert(std::endian::native == std::endian::little);  // as the binary heads say

constexpr std::size_t kBatch = 1 << 16;  // rows between two writes

/// Calls take(first, last) for batches of `count` rows, and reports from `from` to `to`.
template <class Take>
void in_batches(std::size_t count, const WorkReport& report, double from, double to,
                const Take& take) {
  for (std::size_t first = 0; first < count; first += kBatch) {
    report_share(report,
                 from + (to - from) * static_cast<double>(first) / static_cast<double>(count));
    take(first, std::min(first + kBatch, count));
  }
}

void write_tetgen(fs::path file, const TetMesh& mesh, bool overwrite, const WorkReport& report) {
  WholeFile nodes(file.replace_extension(".node"), overwrite);
  WholeFile elements(file.replace_extension(".ele"), overwrite);
  fmt::memory_buffer text;
  const auto flush = [&](WholeFile& out) {
    out.write({text.data(), text.size()});
    text.clear();
  };
  // Number of vertices, dimension, attributes, boundary markers.
  fmt::format_to(std::back_inserter(text), "{} 3 0 1\n", mesh.vertices.size());
  in_batches(mesh.vertices.size(), report, 0.0, 0.3, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const Eigen::Vector3d& v = mesh.vertices[i];
      fmt::format_to(std::back_inserter(text), "{} {} {} {} {}\n", i, v.x(), v.y(), v.z(),
                     mesh.on_surface[i]);
    }
    flush(nodes);
  });
  // Number of tetrahedra, corners of each, attributes.
  fmt::format_to(std::back_inserter(text), "{} 4 0\n", mesh.tetrahedra.size());
  in_batches(mesh.tetrahedra.size(), report, 0.3, 1.0, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const Tetrahedron& t = mesh.tetrahedra[i];
      fmt::format_to(std::back_inserter(text), "{} {} {} {} {}\n", i, t[0], t[1], t[2], t[3]);
    }
    flush(elements);
  });
  nodes.finish();
  elements.finish();
}

/// One array of a .vtu file: its description in the head, its bytes behind all heads.
class VtuArrays {
 public:
  std::string describe(const char* type, const char* name, int components, std::uint64_t bytes) {
    std::string line = fmt::format(
        "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" "
        "offset=\"{}\"/>\n",
        type, name, components, offset_);
    offset_ += sizeof(std::uint64_t) + bytes;
    return line;
  }

 private:
  std::uint64_t offset_{0};
};

template <class T>
void append(WholeFile& out, std::span<const T> values) {
  const std::uint64_t bytes = values.size_bytes();
  out.write_all(std::span<const std::uint64_t>(&bytes, 1));
  out.write_all(values);
}

using Fields = std::vector<TetField>;

void check_fields(const Fields& fields, std::size_t count) {
  for (const TetField& field : fields) {
    if (field.values.size() != count * static_cast<std::size_t>(field.components)) {
      throw std::invalid_argument("a field has another length than the mesh");
    }
  }
}

std::string describe_fields(VtuArrays& arrays, const Fields& fields) {
  std::string lines;
  for (const TetField& field : fields) {
    lines += arrays.describe("Float64", field.name.c_str(), field.components,
                             sizeof(double) * field.values.size());
  }
  return lines;
}

std::string vtu_head(std::uint64_t points, std::uint64_t cells, const Fields& of_vertices,
                     const Fields& of_tetrahedra) {
  VtuArrays arrays;
  std::string head = fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
      "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n"
      "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<PointData Scalars=\"on_surface\">\n",
      points, cells);
  head += arrays.describe("UInt8", "on_surface", 1, points);
  head += describe_fields(arrays, of_vertices);
  head += "</PointData>\n";
  if (!of_tetrahedra.empty()) {
    head += "<CellData>\n" + describe_fields(arrays, of_tetrahedra) + "</CellData>\n";
  }
  head += "<Points>\n";
  head += arrays.describe("Float64", "Points", 3, 24 * points);
  head += "</Points>\n<Cells>\n";
  head += arrays.describe("Int32", "connectivity", 1, 16 * cells);
  head += arrays.describe("Int64", "offsets", 1, 8 * cells);
  head += arrays.describe("UInt8", "types", 1, cells);
  return head + "</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
}

void write_tet_hdf5(const fs::path& file, const TetMesh& mesh, bool overwrite,
                    const WorkReport& report) {
  WholeFile out(file, overwrite);
  out.close();
  h5::File content(out.part());
  content.write("vertices", h5::Number::kF64, {mesh.vertices.size(), 3}, mesh.vertices.data());
  content.put("vertices", "unit", "m");
  content.write("on_surface", h5::Number::kU8, {mesh.on_surface.size()}, mesh.on_surface.data());
  report_share(report, 0.3);
  content.write("tetrahedra", h5::Number::kI32, {mesh.tetrahedra.size(), 4},
                mesh.tetrahedra.data());
  content.close();
  report_share(report, 0.99);
  out.finish();
}

}  // namespace

void write_vtu(const fs::path& file, const TetMesh& mesh, const Fields& of_vertices,
               const Fields& of_tetrahedra, bool overwrite, const WorkReport& report) {
  constexpr std::uint8_t kTetrahedron = 10;  // VTK_TETRA
  check_fields(of_vertices, mesh.vertices.size());
  check_fields(of_tetrahedra, mesh.tetrahedra.size());
  const std::uint64_t cells = mesh.tetrahedra.size();
  WholeFile out(file, overwrite);
  out.write(vtu_head(mesh.vertices.size(), cells, of_vertices, of_tetrahedra));
  append(out, std::span<const std::uint8_t>(mesh.on_surface));
  for (const Fields* fields : {&of_vertices, &of_tetrahedra}) {
    for (const TetField& field : *fields) {
      append(out, std::span<const double>(field.values));
    }
  }
  append(out, std::span<const Eigen::Vector3d>(mesh.vertices));
  report_share(report, 0.3);
  append(out, std::span<const Tetrahedron>(mesh.tetrahedra));
  report_share(report, 0.7);
  const std::uint64_t offset_bytes = sizeof(std::int64_t) * cells;
  out.write_all(std::span<const std::uint64_t>(&offset_bytes, 1));
  std::vector<std::int64_t> ends;
  in_batches(cells, report, 0.7, 1.0, [&](std::size_t first, std::size_t last) {
    ends.clear();
    for (std::size_t i = first; i < last; ++i) {
      ends.push_back(4 * static_cast<std::int64_t>(i + 1));
    }
    out.write_all(std::span<const std::int64_t>(ends));
  });
  const std::vector<std::uint8_t> types(cells, kTetrahedron);
  append(out, std::span<const std::uint8_t>(types));
  out.write("\n</AppendedData>\n</VTKFile>\n");
  out.finish();
}

void check_tet_ending(const fs::path& file) {
  const std::string ending = file.extension().string();
  for (const char* known : {".node", ".ele", ".vtu", ".h5"}) {
    if (ending == known) {
      return;
    }
  }
  throw InputError(
      fmt::format("{}: ends in '{}'; allowed: .node, .ele, .vtu, .h5", file.string(), ending));
}

void write_tet_mesh(const fs::path& file, const TetMesh& mesh, bool overwrite,
                    const WorkReport& report) {
  check_tet_ending(file);
  const std::string ending = file.extension().string();
  if (ending == ".vtu") {
    write_vtu(file, mesh, {}, {}, overwrite, report);
  } else if (ending == ".h5") {
    write_tet_hdf5(file, mesh, overwrite, report);
  } else {
    write_tetgen(file, mesh, overwrite, report);
  }
}

}  // namespace haptrial::geometry
