#pragma once

#include <memory>

#include "core/contact/normal_spring.h"
#include "core/contact/renderer.h"
#include "core/contact/shading.h"

namespace haptrial::contact {

/// Springs between the tool and its proxy: along the normal with a damper, and along the surface
/// what friction holds.
///
///     f = max(0, k |pushed| + b d|pushed| / dt) n + k dragged
///
/// With shading n is the interpolated normal, weighted by what each active plane pushes with.
class ProxyRenderer final : public Renderer {
 public:
  /// @param shading  may be none
  ProxyRenderer(const ContactSurface& surface, const ProxyOptions& proxy,
                const RendererOptions& options, std::unique_ptr<const Shading> shading);

  void start(const Eigen::Vector3d& tool) noexcept override;
  const Contact& tick(const Eigen::Vector3d& tool, double period) noexcept override;
  void set_damping_share(double share) noexcept override { spring_.set_damping_share(share); }
  const Operations& operations() const noexcept override { return proxy_.operations(); }

  const Proxy& proxy() const noexcept { return proxy_; }

 private:
  Eigen::Vector3d shaded(const ProxyState& state, const Eigen::Vector3d& normal) const noexcept;

  Proxy proxy_;
  NormalSpring spring_;
  std::unique_ptr<const Shading> shading_;
  Contact contact_;
};

}  // namespace haptrial::contact
