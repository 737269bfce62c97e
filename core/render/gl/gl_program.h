#pragma once

#include "core/render/gl/gl.h"

namespace haptrial::render {

/// A linked program of two shader texts.
/// @param whose  for the message: "the painter".
/// @throws RunError with OpenGL's log when they do not compile or link.
Gl::Name build_program(const Gl& gl, const char* whose, const char* vertex, const char* fragment);

/// A vertex shader for draw_arrays_instanced(GL_TRIANGLES, 0, 3, 1) without attributes: one
/// triangle that covers the whole viewport, at half the depth.
inline constexpr const char* kScreenVertexShader = R"(#version 330 core
void main() {
  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
})";

}  // namespace haptrial::render
