#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/contact/renderer.h"

namespace haptrial::contact {

/// One method to render contact, with what it needs and offers.
struct KindOfRenderer {
  enum class Tool { kPoint, kPointOrBall, kBall };

  std::string word;  // of `renderer` in [objects.NAME]
  /// The mesh is read, not kept; `surface` outlives the renderer.
  /// @param options  within their bounds (make_renderer), of this kind's tool and friction
  std::unique_ptr<Renderer> (*make)(const geometry::Mesh& mesh, const ContactSurface& surface,
                                    const RendererOptions& options);
  Tool tool{Tool::kPoint};
  bool friction{false};     // it renders friction; edges may be shaded
  bool cells{false};        // it uses the option `resolution`
  bool open_meshes{false};  // it needs no inside
  bool passive{false};      // proven of it without shading: it never gives out energy
};

/// Every kind that make_renderer() knows, by RendererKind. Call before threads are started.
const std::vector<KindOfRenderer>& kinds_of_renderer();

/// Adds a kind of a program's own. @returns its place among the kinds
/// @throws std::invalid_argument for a word that is taken
RendererKind add_kind_of_renderer(const KindOfRenderer& kind);

const KindOfRenderer& kind_of(RendererKind renderer);
std::string_view name_of(RendererKind kind);
/// @throws std::invalid_argument naming the word and what is allowed.
RendererKind renderer_kind(std::string_view name);

/// The mesh is read, not kept; `surface` must outlive the renderer, and may serve several.
/// @throws std::invalid_argument naming the option that breaks its bound, or "radius" for a kind
///         whose tool is a point, or without one for a kind whose tool is a ball.
std::unique_ptr<Renderer> make_renderer(RendererKind kind, const geometry::Mesh& mesh,
                                        const ContactSurface& surface,
                                        const RendererOptions& options);

}  // namespace haptrial::contact
