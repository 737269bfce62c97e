#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "analysis/python/meshes.h"
#include "core/base/error.h"
#include "core/contact/renderer_kinds.h"
#include "core/deformable/touch/ball_touch.h"
#include "core/deformable/touch/prepared.h"

namespace haptrial::python {
namespace {

using contact::Contact;
using geometry::Mesh;

/// A rigid mesh with the renderer that it is felt by.
class MeshTouch {
 public:
  MeshTouch(const Mesh& mesh, const std::string& renderer, const contact::RendererOptions& options)
      : surface_(mesh),
        renderer_(make_renderer(contact::renderer_kind(renderer), mesh, surface_, options)) {}

  contact::Renderer& felt() { return *renderer_; }

 private:
  contact::ContactSurface surface_;
  std::unique_ptr<contact::Renderer> renderer_;
};

/// An elastic body with the ball that touches it.
class SoftTouch {
 public:
  SoftTouch(deformable::HapticMesh mesh, const deformable::Tissue& tissue,
            const deformable::TouchOptions& options)
      : body_(std::make_shared<deformable::Compliance>(
            std::make_shared<const deformable::HapticMesh>(std::move(mesh)), tissue)),
        ball_(body_, options) {}

  deformable::BallTouch& felt() { return ball_; }

  /// Present positions of the vertices that can be touched [m].
  std::vector<Eigen::Vector3d> vertices() const {
    std::vector<std::int32_t> place_of(body_->mesh().tets.vertices.size(), -1);
    std::vector<Eigen::Vector3d> at;
    for (std::size_t place = 0; place < body_->touched(); ++place) {
      const auto number = static_cast<std::int32_t>(place);
      place_of[static_cast<std::size_t>(body_->vertex(number))] = number;
      at.push_back(body_->rest(number));
    }
    for (const deformable::VertexForce& each : ball_.forces()) {
      const std::int32_t pressed = place_of[static_cast<std::size_t>(each.vertex)];
      for (std::size_t place = 0; place < at.size(); ++place) {
        const auto number = static_cast<std::int32_t>(place);
        at[place] += body_->response(number, pressed, each.force).cast<double>();
      }
    }
    return at;
  }

  std::vector<deformable::Face> triangles() const { return body_->faces(); }

 private:
  deformable::SharedCompliance body_;
  deformable::BallTouch ball_;
};

/// Forces on a tool along a way, tick by tick.
template <class Touch>
py::dict follow(Touch& touch, const Numbers& way, double period) {
  if (!(std::isfinite(period) && period > 0.0)) {
    throw InputError("period is " + std::to_string(period) + "; allowed: a number above 0 [s]");
  }
  const std::span<const Eigen::Vector3d> tools = points_of(way);
  std::vector<Eigen::Vector3d> force, proxy, normal;
  std::vector<double> depth;
  std::vector<std::int8_t> state;
  {
    const py::gil_scoped_release release;
    for (const Eigen::Vector3d& tool : tools) {
      const Contact& felt = touch.felt().tick(tool, period);
      force.push_back(felt.force);
      proxy.push_back(felt.proxy);
      normal.push_back(felt.normal);
      depth.push_back(felt.depth);
      state.push_back(static_cast<std::int8_t>(felt.state));
    }
  }
  const auto count = static_cast<py::ssize_t>(tools.size());
  py::dict result;
  result["force"] = array_of<double>(std::move(force), {count, 3});
  result["proxy"] = array_of<double>(std::move(proxy), {count, 3});
  result["normal"] = array_of<double>(std::move(normal), {count, 3});
  result["depth"] = array_of(std::move(depth));
  result["state"] = array_of(std::move(state));
  return result;
}

template <class Touch>
py::class_<Touch> touch_class(py::module_& module, const char* name) {
  return py::class_<Touch>(module, name)
      .def("start",
           [](Touch& touch, const Numbers& tool) {
             const auto points = points_of(tool);
             if (points.size() != 1) {
               throw InputError("a tool starts at one point; allowed: (1 x 3)");
             }
             touch.felt().start(points.front());
           })
      .def("follow", &follow<Touch>);
}

deformable::BodySide side_of(const std::string& name) {
  std::string allowed;
  for (int i = 0; i < 6; ++i) {
    const auto side = static_cast<deformable::BodySide>(i);
    if (name_of(side) == name) {
      return side;
    }
    allowed += (i > 0 ? ", " : "") + std::string(name_of(side));
  }
  throw InputError("'" + name + "' is no side of a body; allowed: " + allowed);
}

deformable::FeltSides sides_of(const std::vector<std::string>& fixed,
                               const std::vector<std::string>& felt) {
  deformable::FeltSides sides;
  sides.fixed.clear();
  for (const std::string& name : fixed) {
    sides.fixed.push_back(side_of(name));
  }
  for (const std::string& name : felt) {
    sides.felt.push_back(side_of(name));
  }
  return sides;
}

std::unique_ptr<MeshTouch> touched_mesh(const Numbers& vertices, const Corners& triangles,
                                        const std::string& renderer, double stiffness,
                                        double damping, double radius, double static_friction,
                                        double dynamic_friction, double crease_angle,
                                        int resolution) {
  const Mesh mesh = mesh_of(vertices, triangles);
  const py::gil_scoped_release release;
  return std::make_unique<MeshTouch>(mesh, renderer,
                                     contact::RendererOptions{stiffness,
                                                              damping,
                                                              radius,
                                                              {static_friction, dynamic_friction},
                                                              crease_angle,
                                                              resolution});
}

std::unique_ptr<SoftTouch> soft_body(deformable::HapticMesh mesh, double young, double poisson,
                                     double radius, double stiffness, double static_friction,
                                     double dynamic_friction) {
  deformable::check_memory(mesh);
  return std::make_unique<SoftTouch>(
      std::move(mesh), deformable::Tissue{young, poisson, 1000.0, {}},
      deformable::TouchOptions{radius, stiffness, {static_friction, dynamic_friction}});
}

std::unique_ptr<SoftTouch> soft_block(const Numbers& size, int cells,
                                      const std::vector<std::string>& fixed,
                                      const std::vector<std::string>& felt, double young,
                                      double poisson, double radius, double stiffness,
                                      double static_friction, double dynamic_friction) {
  const auto sides = points_of(size);
  const py::gil_scoped_release release;
  return soft_body(deformable::felt_block(sides.front(), cells, sides_of(fixed, felt), "the body"),
                   young, poisson, radius, stiffness, static_friction, dynamic_friction);
}

std::unique_ptr<SoftTouch> soft_solid(const Numbers& vertices, const Corners& triangles, int cells,
                                      const std::vector<std::string>& fixed,
                                      const std::vector<std::string>& felt, double young,
                                      double poisson, double radius, double stiffness,
                                      double static_friction, double dynamic_friction) {
  const Mesh mesh = mesh_of(vertices, triangles);
  const py::gil_scoped_release release;
  return soft_body(deformable::felt_solid(mesh, cells, sides_of(fixed, felt), "the body"), young,
                   poisson, radius, stiffness, static_friction, dynamic_friction);
}

}  // namespace

void bind_touch(py::module_& module) {
  touch_class<MeshTouch>(module, "MeshTouch");
  touch_class<SoftTouch>(module, "SoftTouch")
      .def("vertices", [](SoftTouch& body) { return rows_of<double>(body.vertices(), 3); })
      .def("triangles", [](SoftTouch& body) { return rows_of<std::int32_t>(body.triangles(), 3); });
  module.def("touched_mesh", &touched_mesh);
  module.def("soft_block", &soft_block);
  module.def("soft_solid", &soft_solid);
}

}  // namespace haptrial::python
