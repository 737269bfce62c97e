#include "core/contact/renderer_kinds.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/base/require.h"
#include "core/contact/field_renderers.h"
#include "core/contact/proxy_renderer.h"

namespace haptrial::contact {
namespace {

using geometry::Mesh;
using Tool = KindOfRenderer::Tool;

/// @param published  as Ruspini et al. have it: edges of a ball's way are not rounded
std::unique_ptr<Renderer> proxy_of(const Mesh& mesh, const ContactSurface& surface,
                                   const RendererOptions& options, bool published) {
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

std::unique_ptr<Renderer> make_proxy(const Mesh& mesh, const ContactSurface& surface,
                                     const RendererOptions& options) {
  return proxy_of(mesh, surface, options, false);
}

std::unique_ptr<Renderer> make_ruspini(const Mesh& mesh, const ContactSurface& surface,
                                       const RendererOptions& options) {
  return proxy_of(mesh, surface, options, true);
}

template <class R>
std::unique_ptr<Renderer> make_pointed(const Mesh& mesh, const ContactSurface& surface,
                                       const RendererOptions& options) {
  return std::make_unique<R>(mesh, surface, options);
}

/// The shipped ones in the order of RendererKind.
std::vector<KindOfRenderer>& all_renderers() {
  static std::vector<KindOfRenderer> kinds{
      {.word = "proxy",
       .make = make_proxy,
       .tool = Tool::kPointOrBall,
       .friction = true,
       .open_meshes = true,
       .passive = true},
      {.word = "ruspini",
       .make = make_ruspini,
       .tool = Tool::kBall,
       .friction = true,
       .open_meshes = true},
      {.word = "penalty", .make = make_pointed<PenaltyRenderer>},
      {.word = "voxel", .make = make_pointed<VoxelRenderer>, .cells = true},
      {.word = "distance field", .make = make_pointed<DistanceFieldRenderer>, .cells = true},
  };
  return kinds;
}

}  // namespace

const std::vector<KindOfRenderer>& kinds_of_renderer() { return all_renderers(); }

RendererKind add_kind_of_renderer(const KindOfRenderer& kind) {
  const std::vector<KindOfRenderer>& kinds = all_renderers();
  if (std::ranges::find(kinds, kind.word, &KindOfRenderer::word) != kinds.end()) {
    throw std::invalid_argument("add_kind_of_renderer: there is a renderer '" + kind.word +
                                "' already");
  }
  all_renderers().push_back(kind);
  return static_cast<RendererKind>(kinds.size() - 1);
}

const KindOfRenderer& kind_of(RendererKind renderer) {
  return all_renderers().at(static_cast<std::size_t>(renderer));
}

std::string_view name_of(RendererKind kind) { return kind_of(kind).word; }

RendererKind renderer_kind(std::string_view name) {
  std::string allowed;
  for (std::size_t i = 0; i < all_renderers().size(); ++i) {
    const std::string& word = all_renderers()[i].word;
    if (name == word) {
      return static_cast<RendererKind>(i);
    }
    allowed += (allowed.empty() ? "\"" : ", \"") + word + "\"";
  }
  throw std::invalid_argument("renderer \"" + std::string(name) + "\": allowed: " + allowed);
}

namespace {

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
