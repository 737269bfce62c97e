#include "core/contact/make_renderer.h"

#include <cmath>

#include "core/base/require.h"

namespace haptrial::contact {
namespace {

using Tool = KindOfRenderer::Tool;

void check(const KindOfRenderer& kind, const RendererOptions& options) {
  require(options.stiffness > 0.0 && std::isfinite(options.stiffness),
          "stiffness: allowed: finite, above 0");
  require(options.damping >= 0.0 && std::isfinite(options.damping),
          "damping: allowed: finite, 0 or more");
  require(options.crease_angle <= M_PI / 2.0, "crease_angle: allowed: up to pi / 2, or negative");
  require(options.resolution >= 4 && options.resolution <= 512, "resolution: allowed: 4 to 512");
  require(kind.tool != Tool::kPoint || options.radius == 0.0,
          "radius: only proxies have one; allowed: 0");
  require(kind.tool != Tool::kBall || options.radius > 0.0,
          ("radius: allowed for " + kind.word + ": above 0").c_str());
  require(kind.friction || options.friction.static_friction == 0.0,
          "static_friction: only proxies have friction; allowed: 0");
}

}  // namespace

std::unique_ptr<Renderer> make_renderer(RendererKind kind, const geometry::Mesh& mesh,
                                        const ContactSurface& surface,
                                        const RendererOptions& options) {
  const KindOfRenderer& made = kind_of(kind);
  check(made, options);
  return made.make(mesh, surface, options);
}

}  // namespace haptrial::contact
