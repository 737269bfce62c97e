#include "analysis/contact/evaluation/check_body.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <stdexcept>

namespace haptrial::evaluation {
namespace {

constexpr double kTooLarge = 1.5;  // of a path, over the body's diagonal
constexpr double kTooSmall = 0.005;

}  // namespace

void check_body(const contact::FeltBody& body) {
  if (body.facing == geometry::Facing::kInwards || body.facing == geometry::Facing::kMixed) {
    throw std::invalid_argument(
        fmt::format("{} look inwards; turn them with haptrial mesh repair MESH NEW_MESH",
                    body.facing == geometry::Facing::kInwards ? "its faces" : "some of its faces"));
  }
}

std::vector<std::string> body_remarks(const contact::FeltBody& body) {
  if (body.closed) {
    return {};
  }
  return {
      "The mesh is not closed: only the proxies are exact on it. Penalty, voxels and distance "
      "field "
      "need an inside, and may be wrong near its rims."};
}

double path_size(std::span<const Eigen::Vector3d> points) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : points) {
    box.extend(p);
  }
  return points.empty() ? 0.0 : box.diagonal().norm();
}

void check_size(const contact::FeltBody& body, std::span<const Eigen::Vector3d> contacts) {
  const double path = path_size(contacts);
  if (path > kTooLarge * body.size || path < kTooSmall * body.size) {
    throw std::invalid_argument(
        fmt::format("the contacts span {:.3g} m and the mesh {:.3g} m, which do not go together; "
                    "--units must be the unit of the mesh: m, cm or mm",
                    path, body.size));
  }
}

}  // namespace haptrial::evaluation
