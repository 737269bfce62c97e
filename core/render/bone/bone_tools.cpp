#include "core/render/bone/bone_tools.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/base/require.h"
#include "core/geometry/mesh/procedural.h"

namespace haptrial::render {
namespace {

constexpr int kAround = 32;                // sides of a round thing
constexpr double kHandleBegins = 0.55;     // of the length
constexpr double kThinnestShaft = 1.2e-3;  // of a burr that is thicker, diameter [m]
constexpr double kShaftShare = 0.4;        // of a thick burr's diameter
constexpr double kHandleThickness = 2.5;   // times the shaft's

/// A ring of vertices around z. @returns the first one's number
std::int32_t add_ring(geometry::Mesh& mesh, double radius, double z) {
  const auto first = static_cast<std::int32_t>(mesh.vertices.size());
  for (int i = 0; i < kAround; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kAround;
    mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
  }
  return first;
}

/// The band between two rings, seen from the right of the way from `from` to `to` around z.
void add_band(geometry::Mesh& mesh, std::int32_t from, std::int32_t to) {
  for (std::int32_t i = 0; i < kAround; ++i) {
    const std::int32_t next = (i + 1) % kAround;
    mesh.triangles.push_back({from + i, from + next, to + next});
    mesh.triangles.push_back({from + i, to + next, to + i});
  }
}

/// A closed body of revolution through (radius, z), from its lower end to its upper one, both on
/// the axis.
struct Station {
  double radius;
  double z;
};
void add_turned(geometry::Mesh& mesh, const std::vector<Station>& stations) {
  std::int32_t last = add_ring(mesh, stations.front().radius, stations.front().z);
  for (std::size_t s = 1; s < stations.size(); ++s) {
    const std::int32_t next = add_ring(mesh, stations[s].radius, stations[s].z);
    add_band(mesh, last, next);
    last = next;
  }
}

}  // namespace

double burr_shaft(double diameter) noexcept {
  return std::min(std::max(kThinnestShaft, kShaftShare * diameter), diameter);
}

namespace {

void check_burr(double diameter, double shaft_diameter, double length) {
  require(diameter > 0.0 && shaft_diameter > 0.0 && length > diameter,
          "burr_mesh: diameters above 0 and a length above the burr's are needed");
}

// Blades of a cutting burr: each falls from its sharp side to the groove before the next one.
constexpr int kBlades = 8;
constexpr int kStations = 12;  // from a blade to the next
constexpr double kGroove = 0.16;
constexpr double kTwist = 0.7;  // of a blade, over the radius along the axis [rad]
constexpr int kRound = kBlades * kStations;

/// Rest of the radius at a station around the axis, where grooves are as deep as can be.
double groove_at(int station, bool clockwise) {
  const double into = static_cast<double>(station % kStations) / (kStations - 1);
  return kGroove * (clockwise ? into : 1.0 - into);
}

/// The triangles between rings of kRound vertices that go down.
void add_rings(geometry::Mesh& mesh, int first, int rings) {
  for (int ring = 0; ring + 1 < rings; ++ring) {
    for (int i = 0; i < kRound; ++i) {
      const int next = (i + 1) % kRound;
      const int above = first + ring * kRound;
      const int below = above + kRound;
      mesh.triangles.push_back({above + i, below + i, below + next});
      mesh.triangles.push_back({above + i, below + next, above + next});
    }
  }
}

/// A ball with grooves along twisted meridians.
geometry::Mesh fluted_ball(double radius, bool clockwise) {
  constexpr int kRings = 24;  // from pole to pole
  geometry::Mesh mesh;
  for (int ring = 0; ring <= kRings; ++ring) {
    const double polar = std::numbers::pi * ring / kRings;
    for (int i = 0; i < kRound; ++i) {
      const double r = radius * (1.0 - groove_at(i, clockwise) * std::sin(polar));
      const double turn = 2.0 * std::numbers::pi * i / kRound + kTwist * std::cos(polar);
      mesh.vertices.emplace_back(r * std::sin(polar) * std::cos(turn),
                                 r * std::sin(polar) * std::sin(turn), r * std::cos(polar));
    }
  }
  add_rings(mesh, 0, kRings + 1);
  return mesh;
}

/// Any other shape, with vertices of its own for each smooth part. @param grooves  0: none, 1: all
geometry::Mesh turned_head(const bone::BurrShape& shape, bool clockwise, double grooves) {
  constexpr int kRings = 12;  // of a smooth part
  geometry::Mesh mesh;
  const double radius = 0.5 * shape.dimensions().diameter;
  for (std::vector<bone::BurrShape::OutlinePoint> part : shape.outline(kRings)) {
    if (part.size() == 2) {  // a line, along which blades wind
      const bone::BurrShape::OutlinePoint from = part.front();
      const bone::BurrShape::OutlinePoint to = part.back();
      part.clear();
      for (int n = 0; n <= kRings; ++n) {
        const double t = static_cast<double>(n) / kRings;
        part.push_back({from.radius + t * (to.radius - from.radius), from.z + t * (to.z - from.z),
                        from.lateral});
      }
    }
    const auto first = static_cast<int>(mesh.vertices.size());
    for (auto at = part.rbegin(); at != part.rend(); ++at) {
      for (int i = 0; i < kRound; ++i) {
        const double r = at->radius * (1.0 - grooves * groove_at(i, clockwise) * at->lateral);
        const double turn = 2.0 * std::numbers::pi * i / kRound + grooves * kTwist * at->z / radius;
        mesh.vertices.emplace_back(r * std::cos(turn), r * std::sin(turn), at->z);
      }
    }
    add_rings(mesh, first, static_cast<int>(part.size()));
  }
  return mesh;
}

/// Shaft and handle.
void add_handle(geometry::Mesh& mesh, double shaft_diameter, double length, double shaft_begins,
                double handle_begins) {
  const double shaft = 0.5 * shaft_diameter;
  const double handle = kHandleThickness * shaft;
  add_turned(mesh, {{0.0, shaft_begins},
                    {shaft, shaft_begins},
                    {shaft, handle_begins},
                    {handle, handle_begins + 2.0 * handle},
                    {handle, length},
                    {0.0, length}});
}

constexpr int kFrequency = 12;  // of a smooth ball

}  // namespace

geometry::Mesh burr_mesh(double diameter, double shaft_diameter, double length) {
  check_burr(diameter, shaft_diameter, length);
  geometry::Mesh mesh = geometry::make_sphere(0.5 * diameter, kFrequency);
  add_handle(mesh, shaft_diameter, length, 0.0, kHandleBegins * length);
  return mesh;
}

geometry::Mesh cutting_burr_mesh(double diameter, double shaft_diameter, double length,
                                 bool clockwise) {
  check_burr(diameter, shaft_diameter, length);
  geometry::Mesh mesh = fluted_ball(0.5 * diameter, clockwise);
  add_handle(mesh, shaft_diameter, length, 0.0, kHandleBegins * length);
  return mesh;
}

std::vector<Capsule> burr_shadow(double diameter, double shaft_diameter, double length) {
  const double shaft = 0.5 * shaft_diameter;
  const double handle = kHandleThickness * shaft;
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d begins = (kHandleBegins * length + 2.0 * handle) * up;
  return {{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 0.5 * diameter},
          {Eigen::Vector3d::Zero(), begins, shaft},
          {begins, length * up, handle}};
}

namespace {

/// Start of a burr's handle, which has room for it.
double handle_begins(const BurrLook& look, const bone::BurrShape& shape) {
  const double thick = kHandleThickness * look.shaft_diameter;  // twice its radius
  const double wanted = look.shaft_length > 0.0 ? shape.half_length() + look.shaft_length
                                                : kHandleBegins * look.length;
  return std::min(wanted, look.length - thick);
}

}  // namespace

geometry::Mesh burr_mesh(const BurrLook& look) {
  const bone::BurrShape shape(look.head);
  require(look.shaft_diameter > 0.0 && look.length > 2.0 * shape.half_length(),
          "burr_mesh: a shaft above 0 and a length above the burr's are needed");
  const double radius = 0.5 * look.head.diameter;
  geometry::Mesh mesh = !shape.is_ball()
                            ? turned_head(shape, look.clockwise, look.cutting ? 1.0 : 0.0)
                            : (look.cutting ? fluted_ball(radius, look.clockwise)
                                            : geometry::make_sphere(radius, kFrequency));
  add_handle(mesh, look.shaft_diameter, look.length, shape.is_ball() ? 0.0 : shape.half_length(),
             handle_begins(look, shape));
  return mesh;
}

std::vector<Capsule> burr_shadow(const BurrLook& look) {
  const bone::BurrShape shape(look.head);
  const double shaft = 0.5 * look.shaft_diameter;
  const double handle = kHandleThickness * shaft;
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d begins = (handle_begins(look, shape) + 2.0 * handle) * up;
  return {{shape.balls().front().z * up, shape.balls().back().z * up, 0.5 * look.head.diameter},
          {Eigen::Vector3d::Zero(), begins, shaft},
          {begins, look.length * up, handle}};
}

geometry::Mesh suction_mesh(double inner_diameter, double outer_diameter, double length) {
  require(inner_diameter > 0.0 && outer_diameter > inner_diameter && length > 0.0,
          "suction_mesh: an inner diameter above 0, an outer one above it and a length are needed");
  geometry::Mesh mesh;
  const double inner = 0.5 * inner_diameter;
  const double outer = 0.5 * outer_diameter;
  add_turned(mesh, {{inner, length}, {inner, 0.0}, {outer, 0.0}, {outer, length}, {inner, length}});
  return mesh;
}

namespace {

/// A flat body between y = -half and y = half over the quadrilateral of four corners (x, z), which
/// run anticlockwise seen from -y; vertices of their own for each side.
void add_slab(geometry::Mesh& mesh, const std::array<Eigen::Vector2d, 4>& corners, double half) {
  const auto quad = [&](const std::array<Eigen::Vector3d, 4>& points) {
    const auto first = static_cast<std::int32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), points.begin(), points.end());
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  };
  const auto at = [&](std::size_t corner, double y) {
    const Eigen::Vector2d& p = corners[corner % 4];
    return Eigen::Vector3d(p.x(), y, p.y());
  };
  quad({at(0, -half), at(1, -half), at(2, -half), at(3, -half)});
  quad({at(3, half), at(2, half), at(1, half), at(0, half)});
  for (std::size_t side = 0; side < 4; ++side) {
    quad({at(side + 1, -half), at(side, -half), at(side, half), at(side + 1, half)});
  }
}

}  // namespace

geometry::Mesh saw_mesh(const SawLook& look) {
  require(look.width > 0.0 && look.kerf > 0.0 && look.teeth > 0.0 && look.sheet > 0.0 &&
              look.thickness > 0.0 && look.length > look.teeth + look.sheet,
          "saw_mesh: sizes above 0 and a length above the blade's are needed");
  constexpr int kTeeth = 8;
  const double wide = 0.5 * look.width;
  const double front = -0.5 * look.teeth;
  const double root = 0.5 * look.teeth;
  const double end = root + look.sheet;
  geometry::Mesh mesh;
  add_slab(mesh, {{{-wide, root}, {wide, root}, {wide, end}, {-wide, end}}}, 0.5 * look.thickness);
  for (int tooth = 0; tooth < kTeeth; ++tooth) {
    const double left = -wide + look.width * tooth / kTeeth;
    const double right = left + look.width / kTeeth;
    const double middle = 0.5 * (left + right);
    const double point = 0.1 * look.width / kTeeth;
    add_slab(mesh,
             {{{middle - point, front}, {middle + point, front}, {right, root}, {left, root}}},
             0.5 * look.kerf);
  }
  add_handle(mesh, 0.4 * look.width, look.length, end, end);
  return mesh;
}

geometry::Mesh screw_mesh(double diameter, double length) {
  require(diameter > 0.0 && length > 0.0, "screw_mesh: a diameter and a length above 0 are needed");
  const double thread = 0.5 * diameter;
  const double head = 0.85 * diameter;
  geometry::Mesh mesh;
  add_turned(mesh, {{0.0, -length},
                    {thread, -length + thread},
                    {thread, 0.0},
                    {head, 0.0},
                    {0.7 * head, 0.5 * head},
                    {0.0, 0.5 * head}});
  return mesh;
}

geometry::Mesh plane_mesh(double width, double height) {
  require(width > 0.0 && height > 0.0, "plane_mesh: sides above 0 are needed");
  geometry::Mesh mesh;
  for (int side = 0; side < 2; ++side) {  // vertices of their own, for normals of their own
    for (const int corner : {0, 1, 2, 3}) {
      const double x = corner == 0 || corner == 3 ? -0.5 : 0.5;
      const double y = corner < 2 ? -0.5 : 0.5;
      mesh.vertices.emplace_back(x * width, y * height, 0.0);
    }
  }
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}};
  return mesh;
}

Eigen::Isometry3d pose_of(const ToolState& tool) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = tool.orientation.normalized().toRotationMatrix();
  pose.translation() = tool.tip.position;
  return pose;
}

}  // namespace haptrial::render
