#include "core/contact/proxy_renderer.h"

namespace haptrial::contact {

using Eigen::Vector3d;

ProxyRenderer::ProxyRenderer(const ContactSurface& surface, const ProxyOptions& proxy,
                             const RendererOptions& options, std::unique_ptr<const Shading> shading)
    : proxy_(surface, proxy), spring_(options), shading_(std::move(shading)) {}

void ProxyRenderer::start(const Vector3d& tool) noexcept {
  proxy_.start(tool);
  spring_.start();
  contact_ = {};
  contact_.proxy = proxy_.state().position;
}

Vector3d ProxyRenderer::shaded(const ProxyState& state, const Vector3d& normal) const noexcept {
  Vector3d sum = Vector3d::Zero();
  for (int i = 0; i < state.planes; ++i) {
    sum += state.push[i] * shading_->normal(state.triangles[i], state.position, state.normals[i]);
  }
  const double length = sum.norm();
  return sum.dot(normal) > 0.0 ? Vector3d(sum / length) : normal;
}

const Contact& ProxyRenderer::tick(const Vector3d& tool, double period) noexcept {
  if (!tool.allFinite()) {
    contact_.force.setZero();
    return contact_;
  }
  const ProxyState& state = proxy_.follow(tool);
  contact_.proxy = state.position;
  contact_.state = state.state;
  contact_.settled = state.settled;
  contact_.depth = state.state == ContactState::kFree ? 0.0 : state.pushed.norm();
  const double force = spring_.force(contact_.depth, period);
  contact_.normal.setZero();
  contact_.force.setZero();
  if (contact_.depth > 0.0) {
    contact_.normal = state.pushed / contact_.depth;
    if (shading_) {
      contact_.normal = shaded(state, contact_.normal);
    }
    contact_.force = force * contact_.normal + spring_.stiffness() * state.dragged;
  }
  return contact_;
}

}  // namespace haptrial::contact
