#pragma once

#include <cstddef>

namespace haptrial::render {

struct Image;

/// Looks up an OpenGL function by name: OSMesaGetProcAddress, glfwGetProcAddress.
using GetProcAddress = void* (*)(const char* name);

/// The functions of OpenGL 3.3 core that the renderer calls, each named as in OpenGL without its
/// prefix. Nothing else of OpenGL is linked, so the same code draws off screen and in a window.
/// Call on the thread whose current context the table was loaded from.
struct Gl {
  using Enum = unsigned;
  using Name = unsigned;

  // State, clearing, reading
  Enum (*get_error)();
  void (*get_integerv)(Enum what, int* value);
  void (*viewport)(int x, int y, int width, int height);
  void (*scissor)(int x, int y, int width, int height);
  void (*clear_color)(float red, float green, float blue, float alpha);
  void (*clear)(unsigned buffers);
  void (*enable)(Enum what);
  void (*disable)(Enum what);
  void (*blend_func_separate)(Enum src_rgb, Enum dst_rgb, Enum src_alpha, Enum dst_alpha);
  void (*blend_equation)(Enum mode);
  void (*depth_func)(Enum when);
  void (*depth_mask)(unsigned char write);
  void (*cull_face)(Enum side);
  void (*pixel_storei)(Enum what, int value);
  void (*finish)();
  void (*read_pixels)(int x, int y, int width, int height, Enum format, Enum type, void* pixels);

  // Shaders
  Name (*create_shader)(Enum type);
  void (*shader_source)(Name shader, int count, const char* const* texts, const int* lengths);
  void (*compile_shader)(Name shader);
  void (*get_shaderiv)(Name shader, Enum what, int* value);
  void (*get_shader_info_log)(Name shader, int size, int* length, char* text);
  void (*delete_shader)(Name shader);
  Name (*create_program)();
  void (*attach_shader)(Name program, Name shader);
  void (*link_program)(Name program);
  void (*get_programiv)(Name program, Enum what, int* value);
  void (*get_program_info_log)(Name program, int size, int* length, char* text);
  void (*delete_program)(Name program);
  void (*use_program)(Name program);
  int (*get_uniform_location)(Name program, const char* name);
  void (*uniform1i)(int location, int value);
  void (*uniform1f)(int location, float x);
  void (*uniform2f)(int location, float x, float y);
  void (*uniform4f)(int location, float x, float y, float z, float w);
  void (*uniform_matrix4fv)(int location, int count, unsigned char transposed, const float* values);

  // Vertices
  void (*gen_vertex_arrays)(int count, Name* names);
  void (*bind_vertex_array)(Name name);
  void (*delete_vertex_arrays)(int count, const Name* names);
  void (*gen_buffers)(int count, Name* names);
  void (*bind_buffer)(Enum target, Name name);
  void (*buffer_data)(Enum target, std::ptrdiff_t size, const void* data, Enum usage);
  void (*buffer_sub_data)(Enum target, std::ptrdiff_t offset, std::ptrdiff_t size,
                          const void* data);
  void (*delete_buffers)(int count, const Name* names);
  void (*enable_vertex_attrib_array)(unsigned index);
  void (*vertex_attrib_pointer)(unsigned index, int size, Enum type, unsigned char normalized,
                                int stride, const void* offset);
  void (*vertex_attrib4f)(unsigned index, float x, float y, float z, float w);
  void (*vertex_attrib_divisor)(unsigned index, unsigned divisor);
  void (*draw_arrays_instanced)(Enum mode, int first, int count, int instances);
  void (*draw_elements)(Enum mode, int count, Enum type, const void* offset);

  // Textures and framebuffers
  void (*gen_textures)(int count, Name* names);
  void (*active_texture)(Enum unit);
  void (*bind_texture)(Enum target, Name name);
  void (*tex_image_2d)(Enum target, int level, int internal_format, int width, int height,
                       int border, Enum format, Enum type, const void* pixels);
  void (*tex_parameteri)(Enum target, Enum what, int value);
  void (*delete_textures)(int count, const Name* names);
  void (*gen_framebuffers)(int count, Name* names);
  void (*bind_framebuffer)(Enum target, Name name);
  void (*framebuffer_texture_2d)(Enum target, Enum attachment, Enum texture_target, Name texture,
                                 int level);
  void (*draw_buffers)(int count, const Enum* attachments);
  Enum (*check_framebuffer_status)(Enum target);
  void (*delete_framebuffers)(int count, const Name* names);
  void (*gen_renderbuffers)(int count, Name* names);
  void (*bind_renderbuffer)(Enum target, Name name);
  void (*renderbuffer_storage)(Enum target, Enum format, int width, int height);
  void (*framebuffer_renderbuffer)(Enum target, Enum attachment, Enum renderbuffer_target,
                                   Name renderbuffer);
  void (*delete_renderbuffers)(int count, const Name* names);
  void (*blit_framebuffer)(int from_x0, int from_y0, int from_x1, int from_y1, int to_x0, int to_y0,
                           int to_x1, int to_y1, unsigned buffers, Enum filter);
};

/// @throws RunError naming the first function that is missing.
Gl load_gl(GetProcAddress address_of);

/// The lower left `width` x `height` pixels of the bound framebuffer, waiting until drawing is
/// done.
/// @throws RunError when OpenGL reports an error, also one of the drawing before.
Image read_frame(const Gl& gl, int width, int height);

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
