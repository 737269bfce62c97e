#include "analysis/contact/demo_study/ridge_drag.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace haptrial::evaluation {

double Ridge::foot() const { return -0.5 * top - height / std::tan(flank); }

geometry::Mesh ridge_mesh(const Ridge& r) {
  if (!(r.height > 0.0 && r.top > 0.0 && r.thickness > 0.0 && r.half_width > 0.0)) {
    throw std::invalid_argument("a ridge's height, top, thickness and half_width must be above 0");
  }
  if (!(r.flank > 0.0 && r.flank < 0.5 * std::numbers::pi && r.half_length > -r.foot())) {
    throw std::invalid_argument(
        "a ridge's flank must be inside (0, pi / 2), and half_length beyond its feet");
  }
  // The cross-section from above, anticlockwise seen from +z, and the front and back of it.
  const double foot = r.foot();
  const std::array<Eigen::Vector2d, 8> outline{{{-r.half_length, -r.thickness},
                                                {r.half_length, -r.thickness},
                                                {r.half_length, 0.0},
                                                {-foot, 0.0},
                                                {0.5 * r.top, r.height},
                                                {-0.5 * r.top, r.height},
                                                {foot, 0.0},
                                                {-r.half_length, 0.0}}};
  geometry::Mesh mesh;
  for (const double z : {r.half_width, -r.half_width}) {
    for (const Eigen::Vector2d& p : outline) {
      mesh.vertices.emplace_back(p.x(), p.y(), z);
    }
  }
  for (std::int32_t i = 0; i < 8; ++i) {
    const std::int32_t j = (i + 1) % 8;
    mesh.triangles.push_back({i, i + 8, j});
    mesh.triangles.push_back({j, i + 8, j + 8});
  }
  for (const geometry::Triangle& t :
       {geometry::Triangle{0, 6, 7}, geometry::Triangle{0, 1, 6}, geometry::Triangle{1, 3, 6},
        geometry::Triangle{1, 2, 3}, geometry::Triangle{3, 4, 6}, geometry::Triangle{4, 5, 6}}) {
    mesh.triangles.push_back(t);
    mesh.triangles.push_back({t[0] + 8, t[2] + 8, t[1] + 8});
  }
  return mesh;
}

namespace {

constexpr double kOnTop = 0.95;    // of the height
constexpr double kOffFoot = 0.05;  // of the height
constexpr double kTurn = 1e-4;     // a way back that counts [m]
constexpr int kChatter = 4;        // ways back
constexpr double kMargin = 0.001;  // of the law, near the end of the drag [m]
constexpr double kPeriod = 1e-3;   // [s]
constexpr int kLowering = 400;     // ticks
constexpr double kAbove = 0.001;   // of the plate, where it begins [m]

/// Course of the contact along the drag.
class Watch {
 public:
  void see(const Eigen::Vector3d& contact, bool force) {
    const double way = contact.x() - last_x_;
    if (std::abs(way) > kTurn) {
      back_ += way < 0.0 ? 1 : 0;
      last_x_ = contact.x();
    }
    lost_ = lost_ || !force;
    x_ = contact.x();
  }
  void begin(double x) { last_x_ = x_ = x; }
  bool lost() const { return lost_; }
  bool chatters() const { return back_ >= kChatter; }
  double x() const { return x_; }

 private:
  double last_x_{0.0}, x_{0.0};
  int back_{0};
  bool lost_{false};
};

}  // namespace

const char* name_of(RidgeOutcome outcome) {
  switch (outcome) {
    case RidgeOutcome::kRight:
      return "right";
    case RidgeOutcome::kSticks:
      return "sticks";
    case RidgeOutcome::kPassesUnder:
      return "passes under";
    case RidgeOutcome::kPopsThrough:
      return "pops through";
    case RidgeOutcome::kChatters:
      return "chatters";
  }
  return "";
}

RidgeLaw ridge_law(const Ridge& ridge, const RidgeDrag& drag) {
  const double sine = std::sin(ridge.flank), cosine = std::cos(ridge.flank);
  const double along = cosine - drag.friction * sine;
  if (!(along > 0.0)) {
    return {};
  }
  const double foot = ridge.foot() - drag.radius * std::tan(0.5 * ridge.flank);
  const double held = drag.depth * (sine + drag.friction * cosine) / along;
  return {foot + held, foot + held + ridge.height / sine / along};
}

RidgeResult drag_over(const Ridge& ridge, const RidgeDrag& drag, contact::Renderer& renderer) {
  const double begin = ridge.foot() - 0.01;
  const double above = drag.radius + kAbove, below = drag.radius - drag.depth;
  renderer.start({begin, above, 0.0});
  for (int i = 0; i <= kLowering; ++i) {
    const double y = above + (below - above) * i / kLowering;
    renderer.tick({begin, y, 0.0}, kPeriod);
  }
  RidgeResult result;
  Watch watch;
  watch.begin(begin);
  for (double x = begin; x < drag.reach; x += drag.step) {
    const contact::Contact& contact = renderer.tick({x, below, 0.0}, kPeriod);
    watch.see(contact.proxy, contact.force.norm() > 0.0);
    const double height = contact.proxy.y() - drag.radius;
    result.highest = std::max(result.highest, height);
    if (!result.left_foot && height > kOffFoot * ridge.height) {
      result.left_foot = x;
    }
  }
  const RidgeLaw law = ridge_law(ridge, drag);
  const bool climbs = law.on_top && *law.on_top < drag.reach - kMargin;
  // A sphere at the upper edge goes over it within a tick, from where the flank ends.
  const double top = kOnTop * ridge.height - drag.radius * (1.0 - std::cos(ridge.flank));
  const bool may_climb = law.on_top && *law.on_top < drag.reach + kMargin;
  if (watch.lost()) {
    result.outcome = RidgeOutcome::kPopsThrough;
  } else if (watch.chatters()) {
    result.outcome = RidgeOutcome::kChatters;
  } else if (climbs && result.highest < top) {
    result.outcome = watch.x() > -ridge.foot() ? RidgeOutcome::kPassesUnder : RidgeOutcome::kSticks;
  } else if (watch.x() > -ridge.foot() && (!may_climb || result.highest < top)) {
    result.outcome = RidgeOutcome::kPassesUnder;
  }
  return result;
}

}  // namespace haptrial::evaluation
