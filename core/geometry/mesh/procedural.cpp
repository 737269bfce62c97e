#include "core/geometry/mesh/procedural.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "core/base/random.h"
#include "core/base/require.h"

namespace haptrial::geometry {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kMaxFrequency = 5000;  // 500 million triangles

bool is_positive(double value) { return std::isfinite(value) && value > 0.0; }

Mesh icosahedron() {
  const double g = std::numbers::phi;
  Mesh mesh;
  mesh.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                    {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                    {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                    {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  return mesh;
}

/// Splits every edge of a mesh in `parts`, each triangle in parts²; vertices on edges are shared.
class Subdivision {
 public:
  Subdivision(const Mesh& coarse, int parts) : coarse_(coarse), parts_(parts) {
    fine_.vertices = coarse.vertices;
  }

  Mesh run() && {
    for (const Triangle& face : coarse_.triangles) {
      subdivide(face);
    }
    return std::move(fine_);
  }

 private:
  void subdivide(const Triangle& face) {
    std::vector<std::vector<std::int32_t>> rows(parts_ +
                                                1);  // row i: i of `parts_` towards corner 1
    for (int i = 0; i <= parts_; ++i) {
      for (int j = 0; j <= parts_ - i; ++j) {
        rows[i].push_back(vertex(face, i, j));
      }
    }
    for (int i = 0; i < parts_; ++i) {
      for (int j = 0; j < parts_ - i; ++j) {
        fine_.triangles.push_back({rows[i][j], rows[i + 1][j], rows[i][j + 1]});
        if (j + 1 < parts_ - i) {
          fine_.triangles.push_back({rows[i + 1][j], rows[i + 1][j + 1], rows[i][j + 1]});
        }
      }
    }
  }

  /// The vertex i steps towards corner 1 and j towards corner 2 of a face.
  std::int32_t vertex(const Triangle& face, int i, int j) {
    const int k = parts_ - i - j;
    if (k == parts_ || i == parts_ || j == parts_) {
      return k == parts_ ? face[0] : i == parts_ ? face[1] : face[2];
    }
    if (j == 0) {
      return on_edge(face[0], face[1], i);
    }
    if (i == 0) {
      return on_edge(face[0], face[2], j);
    }
    if (k == 0) {
      return on_edge(face[1], face[2], j);
    }
    return add((k * coarse_.vertices[face[0]] + i * coarse_.vertices[face[1]] +
                j * coarse_.vertices[face[2]]) /
               parts_);
  }

  std::int32_t on_edge(std::int32_t from, std::int32_t to, int step) {
    if (from > to) {
      std::swap(from, to);
      step = parts_ - step;
    }
    auto [found, is_new] = edges_.try_emplace({from, to}, 0);
    if (is_new) {
      found->second = static_cast<std::int32_t>(fine_.vertices.size());
      const Eigen::Vector3d& start = coarse_.vertices[from];
      const Eigen::Vector3d along = coarse_.vertices[to] - start;
      for (int i = 1; i < parts_; ++i) {
        add(start + along * i / parts_);
      }
    }
    return found->second + step - 1;
  }

  std::int32_t add(const Eigen::Vector3d& point) {
    fine_.vertices.push_back(point);
    return static_cast<std::int32_t>(fine_.vertices.size() - 1);
  }

  const Mesh& coarse_;
  int parts_;
  Mesh fine_;
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> edges_;  // their first new vertex
};

/// Two triangles of a quadrilateral whose corners run anticlockwise.
void add_quad(Mesh& mesh, std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

/// A sum of plane waves over the unit sphere; each octave has half the amplitude of the one before.
class Roughness {
 public:
  explicit Roughness(RandomStream& random) {
    constexpr double kFirstWaves = 2.0;  // radians over one radius
    constexpr int kOctaves = 6;
    constexpr int kWavesPerOctave = 6;
    double number = kFirstWaves;
    double height = 0.08;
    for (int octave = 0; octave < kOctaves; ++octave, number *= 2.0, height *= 0.5) {
      for (int i = 0; i < kWavesPerOctave; ++i) {
        const Eigen::Vector3d any(random.normal(), random.normal(), random.normal());
        waves_.push_back({number * any.normalized(), random.uniform(0.0, 2.0 * kPi), height});
      }
    }
  }

  double operator()(const Eigen::Vector3d& unit) const {
    double sum = 0.0;
    for (const Wave& wave : waves_) {
      sum += wave.height * std::sin(wave.number.dot(unit) + wave.phase);
    }
    return sum;
  }

 private:
  struct Wave {
    Eigen::Vector3d number;  // [rad]
    double phase;            // [rad]
    double height;
  };
  std::vector<Wave> waves_;
};

/// The gear's outline seen from +z, anticlockwise.
std::vector<Eigen::Vector2d> gear_outline(const GearShape& shape) {
  const double pitch = 2.0 * kPi / shape.teeth;
  const std::array<std::pair<double, double>, 4> tooth{{{0.00, shape.root_radius},
                                                        {0.35, shape.root_radius},
                                                        {0.50, shape.tip_radius},
                                                        {0.85, shape.tip_radius}}};
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < shape.teeth; ++i) {
    for (const auto& [part, radius] : tooth) {
      const double angle = pitch * (i + part);
      points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
  }
  return points;
}

}  // namespace

Mesh make_sphere(double radius, int frequency) {
  require(is_positive(radius), "make_sphere: the radius must be above 0");
  require(frequency >= 1 && frequency <= kMaxFrequency,
          "make_sphere: the frequency must be from 1 to 5,000");
  Mesh mesh = Subdivision(icosahedron(), frequency).run();
  for (Eigen::Vector3d& vertex : mesh.vertices) {
    vertex *= radius / vertex.norm();
  }
  return mesh;
}

Mesh make_box(const Eigen::Vector3d& size) {
  require(is_positive(size.minCoeff()) && size.allFinite(), "make_box: sizes must be above 0");
  Mesh mesh;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d side(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5,
                               corner & 4 ? 0.5 : -0.5);
    mesh.vertices.emplace_back(side.cwiseProduct(size));
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

Mesh make_frustum(double radius, double top_radius, double length, int around) {
  require(
      is_positive(radius) && is_positive(length) && top_radius >= 0.0 && std::isfinite(top_radius),
      "make_frustum: radius and length must be above 0, top_radius at least 0");
  require(around >= 3, "make_frustum: around must be at least 3");
  const bool pointed = top_radius == 0.0;
  Mesh mesh;
  mesh.vertices = {{0.0, 0.0, -0.5 * length}, {0.0, 0.0, 0.5 * length}};
  const auto ring = [&](double r, double z) {
    for (int i = 0; i < around; ++i) {
      const double angle = 2.0 * kPi * i / around;
      mesh.vertices.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    }
  };
  ring(radius, -0.5 * length);
  if (!pointed) {
    ring(top_radius, 0.5 * length);
  }
  for (int i = 0; i < around; ++i) {
    const std::int32_t a = 2 + i, b = 2 + (i + 1) % around;
    mesh.triangles.push_back({0, b, a});
    if (pointed) {
      mesh.triangles.push_back({1, a, b});
      continue;
    }
    mesh.triangles.push_back({1, a + around, b + around});
    mesh.triangles.push_back({a, b, b + around});
    mesh.triangles.push_back({a, b + around, a + around});
  }
  return mesh;
}

Mesh make_torus(double radius, double tube_radius, int around, int across) {
  require(is_positive(tube_radius) && std::isfinite(radius) && tube_radius < radius,
          "make_torus: the tube's radius must be above 0 and below the torus's");
  require(around >= 3 && across >= 3 && 2.0 * around * across < 1e9,
          "make_torus: at least 3 parts each way, and fewer than a billion triangles");
  Mesh mesh;
  for (int i = 0; i < around; ++i) {
    const double u = 2.0 * kPi * i / around;
    for (int j = 0; j < across; ++j) {
      const double v = 2.0 * kPi * j / across;
      const double from_axis = radius + tube_radius * std::cos(v);
      mesh.vertices.emplace_back(from_axis * std::cos(u), from_axis * std::sin(u),
                                 tube_radius * std::sin(v));
    }
  }
  const auto at = [&](int i, int j) { return (i % around) * across + j % across; };
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      add_quad(mesh, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
  return mesh;
}

Mesh make_gear(const GearShape& shape) {
  require(shape.teeth >= 3 && shape.teeth <= 1000000, "make_gear: from 3 to 1,000,000 teeth");
  require(is_positive(shape.bore_radius) && shape.bore_radius < shape.root_radius &&
              shape.root_radius < shape.tip_radius && std::isfinite(shape.tip_radius),
          "make_gear: the radii must rise from bore to root to tip");
  require(is_positive(shape.thickness), "make_gear: the thickness must be above 0");
  const std::vector<Eigen::Vector2d> outline = gear_outline(shape);
  const auto count = static_cast<std::int32_t>(outline.size());
  const double half = 0.5 * shape.thickness;
  Mesh mesh;
  for (const Eigen::Vector2d& out : outline) {  // four vertices a point: out and in, low and high
    const Eigen::Vector2d in = shape.bore_radius * out.normalized();
    mesh.vertices.emplace_back(out.x(), out.y(), -half);
    mesh.vertices.emplace_back(out.x(), out.y(), half);
    mesh.vertices.emplace_back(in.x(), in.y(), -half);
    mesh.vertices.emplace_back(in.x(), in.y(), half);
  }
  for (std::int32_t i = 0; i < count; ++i) {
    const std::int32_t a = 4 * i;
    const std::int32_t b = 4 * ((i + 1) % count);
    add_quad(mesh, a, b, b + 1, a + 1);          // outside
    add_quad(mesh, b + 2, a + 2, a + 3, b + 3);  // bore
    add_quad(mesh, a + 1, b + 1, b + 3, a + 3);  // top
    add_quad(mesh, b, a, a + 2, b + 2);          // bottom
  }
  return mesh;
}

Mesh make_rough_solid(double length, int frequency, std::uint64_t seed) {
  require(is_positive(length), "make_rough_solid: the length must be above 0");
  RandomStream random(seed, "rough solid");
  const Roughness roughness(random);
  Mesh mesh = make_sphere(1.0, frequency);
  const Eigen::Vector3d half_axes = 0.5 * length * Eigen::Vector3d(1.0, 0.7, 0.5);
  for (Eigen::Vector3d& vertex : mesh.vertices) {
    // exp keeps the radius above 0, whatever the waves add up to.
    vertex = half_axes.cwiseProduct(std::exp(roughness(vertex)) * vertex);
  }
  return mesh;
}

}  // namespace haptrial::geometry
