#pragma once

#include "core/render/gl/gl.h"

namespace haptrial::render {

/// A linked program of two shader texts.
/// @param whose  for the message: "the painter".
/// @throws RunError with OpenGL's log when they do not compile or link.
Gl::Name build_program(const Gl& gl, const char* whose, const char* vertex, const char* fragment);

}  // namespace haptrial::render
