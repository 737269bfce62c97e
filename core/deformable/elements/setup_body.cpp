#include "core/deformable/elements/setup_body.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/deformable/body/mesh_parts.h"
#include "core/geometry/files/mesh_io.h"
#include "core/geometry/mesh/mesh_size.h"
#include "core/geometry/volume/hanging_voxels.h"
#include "core/geometry/volume/voxelize.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;
using geometry::TetMesh;
using geometry::Tetrahedron;

/// Numbers of a text file, line by line, without empty lines and comments.
class NumberLines {
 public:
  explicit NumberLines(std::filesystem::path file)
      : file_(std::move(file)), text_(file_text(file_)) {}

  /// The numbers of the next line. @throws InputError at the end of the file, or for other words
  std::vector<double> next(std::size_t least) {
    std::vector<double> numbers;
    while (numbers.empty()) {
      if (at_ >= text_.size()) {
        throw InputError(
            fmt::format("{}: ends after line {}; there should be more", file_.string(), line_));
      }
      const std::size_t end = std::min(text_.find('\n', at_), text_.size());
      std::string_view line(text_.data() + at_, end - at_);
      at_ = end + 1;
      ++line_;
      read(line.substr(0, line.find('#')), numbers);
    }
    if (numbers.size() < least) {
      fail(fmt::format("{} numbers; {} or more are allowed", numbers.size(), least));
    }
    return numbers;
  }
  [[noreturn]] void fail(const std::string& found) const {
    throw InputError(fmt::format("{}:{}: {}", file_.string(), line_, found));
  }

 private:
  void read(std::string_view line, std::vector<double>& numbers) const {
    const char* at = line.data();
    const char* const end = at + line.size();
    while (true) {
      while (at < end && (*at == ' ' || *at == '\t' || *at == '\r' || *at == ',')) {
        ++at;
      }
      if (at == end) {
        return;
      }
      double number = 0;
      const auto [next, error] = std::from_chars(at, end, number);
      if (error != std::errc() || !std::isfinite(number)) {
        fail(fmt::format("'{}' is no finite number", std::string_view(at, end)));
      }
      numbers.push_back(number);
      at = next;
    }
  }
  std::filesystem::path file_;
  std::string text_;
  std::size_t at_{0};
  std::size_t line_{0};
};

std::size_t count_of(const NumberLines& lines, double number) {
  constexpr double kMost = 1e8;
  if (!(number >= 1.0 && number <= kMost)) {
    lines.fail(fmt::format("there are {} of them; 1 to 1e8 are allowed", number));
  }
  return static_cast<std::size_t>(number);
}

void drop_unused(TetMesh& mesh, TetgenColumns& columns) {
  std::vector<std::int32_t> number(mesh.vertices.size(), -1);
  for (const Tetrahedron& t : mesh.tetrahedra) {
    for (const std::int32_t v : t) {
      number[static_cast<std::size_t>(v)] = 0;
    }
  }
  std::int32_t kept = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] == 0) {
      mesh.vertices[static_cast<std::size_t>(kept)] = mesh.vertices[v];
      columns.nodes[static_cast<std::size_t>(kept)].swap(columns.nodes[v]);
      number[v] = kept++;
    }
  }
  mesh.vertices.resize(static_cast<std::size_t>(kept));
  columns.nodes.resize(static_cast<std::size_t>(kept));
  for (Tetrahedron& t : mesh.tetrahedra) {
    for (std::int32_t& v : t) {
      v = number[static_cast<std::size_t>(v)];
    }
  }
}

void mark_surface(TetMesh& mesh) {
  mesh.on_surface.resize(mesh.vertices.size());
  std::fill(mesh.on_surface.begin(), mesh.on_surface.end(), std::uint8_t{0});
  for (const Face& face : mesh_parts(mesh.tetrahedra).surface) {
    for (const std::int32_t v : face) {
      mesh.on_surface[static_cast<std::size_t>(v)] = 1;
    }
  }
}

TetMesh filled(const BodySource& source, const std::filesystem::path& file,
               const MemoryCheck& check) {
  geometry::Mesh mesh = geometry::read_mesh(file);
  for (Vector3d& p : mesh.vertices) {
    p *= source.scale;
  }
  const geometry::VoxelGrid grid = geometry::make_grid(geometry::bounds(mesh), source.resolution);
  const geometry::InsideRule rule = geometry::fitting_rule(mesh);
  if (check) {
    check(fmt::format("a grid of {} x {} x {} voxels", grid.size[0], grid.size[1], grid.size[2]),
          geometry::voxelizing_memory(mesh, grid, rule));
  }
  geometry::VoxelSolid solid = geometry::voxelize(mesh, grid, rule);
  geometry::drop_hanging_voxels(solid);
  const std::size_t inside = geometry::count_inside(solid);
  if (check) {
    check(fmt::format("{} tetrahedra", 5 * inside),
          geometry::tetrahedralizing_memory(grid, inside));
  }
  return geometry::tetrahedralize(solid);
}

}  // namespace

TetMesh read_tetgen(const std::filesystem::path& node_file, double scale, TetgenColumns* columns) {
  TetMesh mesh;
  TetgenColumns beside;
  NumberLines nodes(node_file);
  const std::size_t vertices = count_of(nodes, nodes.next(2)[0]);
  double first = 0;
  for (std::size_t v = 0; v < vertices; ++v) {
    const std::vector<double> row = nodes.next(4);
    if (v == 0) {
      first = row[0];
    }
    if (row[0] != first + static_cast<double>(v) || (first != 0 && first != 1)) {
      nodes.fail(
          fmt::format("the vertex has the number {}; they go from 0 or 1 on, one by one", row[0]));
    }
    mesh.vertices.push_back(scale * Vector3d(row[1], row[2], row[3]));
    beside.nodes.emplace_back(row.begin() + 4, row.end());
  }
  NumberLines elements(std::filesystem::path(node_file).replace_extension(".ele"));
  const std::vector<double> head = elements.next(2);
  const std::size_t tetrahedra = count_of(elements, head[0]);
  if (head[1] != 4) {
    elements.fail(fmt::format("tetrahedra of {} corners; 4 are allowed", head[1]));
  }
  std::size_t inverted = 0;
  for (std::size_t i = 0; i < tetrahedra; ++i) {
    const std::vector<double> row = elements.next(5);
    Tetrahedron t{};
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const double number = row[corner + 1] - first;
      if (!(number >= 0 && number < static_cast<double>(vertices)) ||
          number != std::floor(number)) {
        elements.fail(fmt::format("there is no vertex {}", row[corner + 1]));
      }
      t[corner] = static_cast<std::int32_t>(number);
    }
    inverted += six_volumes(mesh.vertices, t) < 0 ? 1 : 0;
    mesh.tetrahedra.push_back(t);
    beside.tetrahedra.emplace_back(row.begin() + 5, row.end());
  }
  if (inverted == tetrahedra) {  // the other convention
    for (Tetrahedron& t : mesh.tetrahedra) {
      std::swap(t[2], t[3]);
    }
  }
  drop_unused(mesh, beside);
  mark_surface(mesh);
  if (columns != nullptr) {
    *columns = std::move(beside);
  }
  return mesh;
}

TetMesh block_body(const Vector3d& size, int resolution) {
  geometry::VoxelSolid solid;
  const double spacing = size.maxCoeff() / resolution;
  solid.grid.spacing = spacing;
  solid.grid.origin = Vector3d::Constant(0.5 * spacing);
  constexpr double kWhole = 1e-9;  // of a side: a whole number of cubes
  Vector3d stretch = Vector3d::Ones();
  std::size_t count = 1;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const int cells = std::max(1, static_cast<int>(std::lround(size[axis] / spacing)));
    const double side = size[axis] / (cells * spacing);
    stretch[axis] = std::abs(side - 1.0) > kWhole ? side : 1.0;
    solid.grid.size[static_cast<std::size_t>(axis)] = cells;
    count *= static_cast<std::size_t>(cells);
  }
  solid.labels.assign(count, geometry::VoxelLabel::kInside);
  TetMesh mesh = geometry::tetrahedralize(solid);
  for (Vector3d& vertex : mesh.vertices) {
    vertex = vertex.cwiseProduct(stretch);
  }
  return mesh;
}

namespace {

TetMesh unmoved_body(const DeformSetup& setup, const MemoryCheck& check) {
  const BodySource& source = setup.source;
  if (source.block) {
    constexpr double kByCube = 1000;  // five tetrahedra, a vertex and their surface
    const Vector3d cubes = *source.block * source.resolution / source.block->maxCoeff();
    if (check) {
      check(fmt::format("a block of {:.0f} cubes", cubes.prod()), kByCube * cubes.prod());
    }
    return block_body(*source.block, source.resolution);
  }
  if (!source.tetrahedra.empty()) {
    const auto file = setup.path_of(source.tetrahedra);
    if (file.extension() != ".node") {
      throw InputError(
          fmt::format("{}: body.tetrahedra is of another kind; allowed: a file of "
                      "TetGen, .node with its .ele",
                      file.string()));
    }
    return read_tetgen(file, source.scale);
  }
  return filled(source, setup.path_of(source.mesh), check);
}

}  // namespace

TetMesh body_of(const DeformSetup& setup, const MemoryCheck& check) {
  TetMesh body = unmoved_body(setup, check);
  for (Vector3d& p : body.vertices) {
    p += setup.source.shift;
  }
  return body;
}

}  // namespace haptrial::deformable
