#pragma once

#include <memory>

#include "core/contact/renderer.h"

namespace haptrial::contact {

/// The mesh is read, not kept; `surface` must outlive the renderer, and may serve several.
/// @throws std::invalid_argument naming the option that breaks its bound, or "radius" for a kind
///         without a radius (penalty, voxel, distance field) or in need of one (ruspini).
std::unique_ptr<Renderer> make_renderer(RendererKind kind, const geometry::Mesh& mesh,
                                        const ContactSurface& surface,
                                        const RendererOptions& options);

}  // namespace haptrial::contact
