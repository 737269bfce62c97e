#include "core/contact/make_renderer.h"

#include <cmath>

#include "core/base/require.h"
#include "core/contact/field_renderers.h"
#include "core/contact/proxy_renderer.h"

namespace haptrial::contact {
namespace {

void check(RendererKind kind, const RendererOptions& options) {
  require(options.stiffness > 0.0 && std::isfinite(options.stiffness),
          "stiffness: allowed: finite, above 0");
  require(options.damping >= 0.0 && std::isfinite(options.damping),
          "damping: allowed: finite, 0 or more");
  require(options.crease_angle <= M_PI / 2.0, "crease_angle: allowed: up to pi / 2, or negative");
  require(options.resolution >= 4 && options.resolution <= 512, "resolution: allowed: 4 to 512");
  const bool proxy = kind == RendererKind::kProxy || kind == RendererKind::kRuspini;
  require(proxy || options.radius == 0.0, "radius: only proxies have one; allowed: 0");
  require(kind != RendererKind::kRuspini || options.radius > 0.0,
          "radius: allowed for ruspini: above 0");
  require(proxy || options.friction.static_friction == 0.0,
          "static_friction: only proxies have friction; allowed: 0");
}

}  // namespace

std::unique_ptr<Renderer> make_renderer(RendererKind kind, const geometry::Mesh& mesh,
                                        const ContactSurface& surface,
                                        const RendererOptions& options) {
  check(kind, options);
  switch (kind) {
    case RendererKind::kPenalty:
      return std::make_unique<PenaltyRenderer>(mesh, surface, options);
    case RendererKind::kVoxel:
      return std::make_unique<VoxelRenderer>(mesh, surface, options);
    case RendererKind::kDistanceField:
      return std::make_unique<DistanceFieldRenderer>(mesh, surface, options);
    default:
      break;
  }
  const bool published = kind == RendererKind::kRuspini;
  std::unique_ptr<const Shading> shading;
  if (options.crease_angle >= 0.0) {
    shading = std::make_unique<const Shading>(mesh, surface, options.crease_angle);
  }
  const ProxyOptions proxy{.radius = options.radius,
                           .friction = options.friction,
                           .ways_out = !published,
                           .arcs = !published};
  return std::make_unique<ProxyRenderer>(surface, proxy, options, std::move(shading));
}

}  // namespace haptrial::contact
