#pragma once

#include <cmath>

#include "core/base/definition/schema.h"
#include "core/contact/field_renderers.h"
#include "core/contact/renderer_kinds.h"
#include "core/scene/read/field_kinds.h"
#include "core/scene/read/shape_kinds.h"

/// A shape, a ring for regions and fields, and a renderer, a spring to the nearest triangle of a
/// mesh that gives back only half of its force.
namespace own {

using namespace haptrial;
using Eigen::Vector3d;

struct Ring {
  Vector3d centre{Vector3d::Zero()};  // [m]
  double radius{0.03};                // of the circle around z in the tube's middle > tube [m]
  double tube{0.01};                  // radius > 0 [m]
};

class RingLaw final : public scene::ShapeLaw {
 public:
  explicit RingLaw(const Ring& ring) : ring_(ring) {}
  scene::SurfaceDistance distance(const Vector3d& p) const noexcept override {
    const Vector3d from = p - ring_.centre;
    const double aside = std::hypot(from.x(), from.y());
    const Vector3d outward =
        aside > 0.0 ? Vector3d(from.x() / aside, from.y() / aside, 0.0) : Vector3d::UnitX();
    const Vector3d off = from - ring_.radius * outward;
    const double size = off.norm();
    return {size - ring_.tube, size > 0.0 ? Vector3d(off / size) : Vector3d::UnitZ()};
  }
  double deepest() const noexcept override { return ring_.tube; }
  scene::ShapeBall ball() const override { return {ring_.centre, ring_.radius + ring_.tube}; }
  Vector3d inside() const override { return ring_.centre + ring_.radius * Vector3d::UnitX(); }

 private:
  Ring ring_;
};

/// type = "ring": centre, radius, tube [m]. Formulas may stand there.
inline scene::Shape read_ring(Table& table) {
  static const auto schema =
      Schema<Ring>()
          .vector("centre", &Ring::centre, scene::kPlaceBounds, "m", "Centre of the shape")
          .required()
          .number("radius", &Ring::radius, scene::kLengthBounds, "m", "Radius of the shape")
          .required()
          .number("tube", &Ring::tube, scene::kLengthBounds, "m", "Radius of a ring's tube")
          .required();
  return scene::RegisteredShape{std::make_shared<RingLaw>(schema.read(table))};
}

class LossyRenderer final : public contact::Renderer {
 public:
  LossyRenderer(const geometry::Mesh& mesh, const contact::ContactSurface& surface,
                const contact::RendererOptions& options)
      : spring_(mesh, surface, options) {}
  void start(const Vector3d& tool) noexcept override {
    spring_.start(tool);
    before_ = 0.0;
  }
  const contact::Contact& tick(const Vector3d& tool, double period) noexcept override {
    contact_ = spring_.tick(tool, period);
    if (contact_.depth < before_) {
      contact_.force *= 0.5;
    }
    before_ = contact_.depth;
    return contact_;
  }
  void set_damping_share(double share) noexcept override { spring_.set_damping_share(share); }
  const contact::Operations& operations() const noexcept override { return spring_.operations(); }

 private:
  contact::PenaltyRenderer spring_;
  contact::Contact contact_;
  double before_{0.0};  // depth a tick ago [m]
};

inline std::unique_ptr<contact::Renderer> make_lossy(const geometry::Mesh& mesh,
                                                     const contact::ContactSurface& surface,
                                                     const contact::RendererOptions& options) {
  return std::make_unique<LossyRenderer>(mesh, surface, options);
}

inline void add_ring() {
  scene::add_kind_of_shape({"ring", read_ring});
  contact::add_kind_of_renderer({.word = "lossy", .make = make_lossy});
}

}  // namespace own
