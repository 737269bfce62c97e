#include "analysis/contact/truth/check_truth.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace haptrial::evaluation {
namespace {

void require_truth(bool good, const char* sentence) {
  if (!good) {
    throw std::invalid_argument(sentence);
  }
}

bool is_length(double x) { return x > 0.0 && std::isfinite(x); }

void check(const TruePlane&) {}
void check(const TrueSphere& body) {
  require_truth(is_length(body.radius), "radius must be above 0");
}
void check(const TrueCylinder& body) {
  require_truth(is_length(body.radius), "radius must be above 0");
}
void check(const TrueTorus& body) {
  require_truth(
      is_length(body.radius) && is_length(body.tube_radius) && body.tube_radius < body.radius,
      "radii of a torus must be above 0, the tube's the smaller one");
}
void check_flank(double flank) {
  require_truth(flank > 0.0 && flank < 0.5 * std::numbers::pi, "flank must lie inside (0, pi / 2)");
}
void check(const TrueWedge& body) { check_flank(body.flank); }
void check(const TrueConcaveEdge& body) { check_flank(body.flank); }
void check(const TrueWavyPlate& body) {
  require_truth(is_length(body.height) && is_length(body.length),
                "height and length must be above 0");
}
void check(const TrueThinPlate& body) {
  require_truth(is_length(body.width) && is_length(body.thickness),
                "width and thickness must be above 0");
}

}  // namespace

void check_truth(const TrueBody& body, std::span<const Eigen::Vector3d> tool, double stiffness,
                 double friction) {
  std::visit([](const auto& one) { check(one); }, body);
  require_truth(is_length(stiffness), "stiffness must be above 0 and finite");
  require_truth(friction >= 0.0 && std::isfinite(friction), "friction must not be negative");
  for (const auto& p : tool) {
    require_truth(p.allFinite(), "tool positions must be finite");
  }
}

}  // namespace haptrial::evaluation
