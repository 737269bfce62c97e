#include "protocols/psychophysics/objects/look.h"

#include <algorithm>
#include <stdexcept>

#include "core/base/definition/schema.h"
#include "core/base/random.h"

namespace haptrial::protocols {
namespace {

constexpr Bounds kSize{0.0, 1.0, true};  // [m]
constexpr Bounds kCentre{-1.0, 1.0};     // [m]
constexpr Bounds kStep{0.0, 0.2};        // [m]
constexpr Bounds kNoise{0.0, 10.0};      // of the step
constexpr Bounds kDot{0.0, 0.05, true};  // [m]
constexpr long kFewestDots = 10, kMostDots = 20000;
constexpr double kNearest = 0.5;  // a dot comes no nearer than half-way to the eyes

const Schema<RandomDots>& random_dots_schema() {
  using D = RandomDots;
  static const auto schema =
      Schema<D>()
          .number("width", &D::width, kSize, "m", "Width of a bar of random dots")
          .required()
          .number("height", &D::height, kSize, "m", "Height of a bar of random dots")
          .required()
          .number("step", &D::step, kStep, "m",
                  "Depth of a bar of random dots before its background")
          .number("noise", &D::noise, kNoise, "",
                  "Standard deviation of a dot's depth, as a share of the step")
          .number("dot", &D::diameter, kDot, "m", "Diameter of a dot")
          .custom("centre", "Centre of a bar of random dots",
                  [](Table& table, const std::string& key, D& dots) {
                    const Eigen::Vector3d centre = read_vector(table, key, kCentre, "m");
                    dots.centre = {centre.x(), centre.y(), centre.z()};
                  })
          .otherwise("0, 0, 0")
          .integer("dots", &D::count, kFewestDots, kMostDots,
                   "Number of random dots on the whole screen");
  return schema;
}

Look read_look(Table& table, const std::string& name) {
  Look look{name, {}};
  table.describe({"type", "Kind of what is seen: a bar of random dots", "", true});
  table.choice("type", {"random_dots"});
  random_dots_schema().read(table, look.dots);
  return look;
}

}  // namespace

std::vector<Look> read_looks(Table& looks) {
  std::vector<Look> all;
  for (const std::string& name : looks.keys()) {
    Table table = looks.table(name);
    all.push_back(read_look(table, name));
  }
  return all;
}

std::vector<EyeDot> dots_for_eye(const RandomDots& dots, const Eigen::Vector2d& screen,
                                 const Eigen::Vector2d& centre, const TwoEyes& eyes, int side,
                                 std::uint64_t seed) {
  if (!(eyes.viewing_distance > 0.0) || !(eyes.eye_distance > 0.0)) {
    throw std::invalid_argument("dots_for_eye: eye and viewing distance must be above 0");
  }
  if (dots.count < 0 || !(dots.step >= 0.0) || !(dots.noise >= 0.0)) {
    throw std::invalid_argument("dots_for_eye: count, step and noise must be 0 or more");
  }
  RandomStream random(seed, "dots");
  const double distance = eyes.viewing_distance;
  const Eigen::Vector2d eye(0.5 * side * eyes.eye_distance, 0.0);
  std::vector<EyeDot> seen;
  seen.reserve(static_cast<std::size_t>(dots.count));
  for (std::int32_t i = 0; i < dots.count; ++i) {
    const Eigen::Vector2d p(random.uniform(-0.5, 0.5) * screen.x(),
                            random.uniform(-0.5, 0.5) * screen.y());
    const Eigen::Vector2d from = (p - centre).cwiseAbs();
    const bool on_bar = from.x() < 0.5 * dots.width && from.y() < 0.5 * dots.height;
    const double spread = dots.noise * dots.step * random.normal();
    const double z = std::min((on_bar ? dots.step : 0.0) + spread, kNearest * distance);
    seen.emplace_back(p + (p - eye) * (z / (distance - z)));
  }
  return seen;
}

}  // namespace haptrial::protocols
