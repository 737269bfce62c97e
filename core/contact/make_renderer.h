#pragma once

#include <memory>

#include "core/contact/renderer_kinds.h"

namespace haptrial::contact {

/// The mesh is read, not kept; `surface` must outlive the renderer, and may serve several.
/// @throws std::invalid_argument naming the option that breaks its bound, or "radius" for a kind
///         whose tool is a point, or without one for a kind whose tool is a ball.
std::unique_ptr<Renderer> make_renderer(RendererKind kind, const geometry::Mesh& mesh,
                                        const ContactSurface& surface,
                                        const RendererOptions& options);

}  // namespace haptrial::contact
