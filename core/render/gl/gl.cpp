#include "core/render/gl/gl.h"

#include <GL/glcorearb.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/base/error.h"
#include "core/render/gl/image.h"

namespace haptrial::render {
namespace {

class Loader {
 public:
  explicit Loader(GetProcAddress address_of) : address_of_(address_of) {}

  template <class Function>
  void operator()(Function*& function, const char* name) const {
    function = reinterpret_cast<Function*>(address_of_(name));
    if (function == nullptr) {
      throw RunError(fmt::format("the OpenGL function {} is missing; OpenGL 3.3 is needed", name));
    }
  }

 private:
  GetProcAddress address_of_;
};

void load_state(Gl& gl, const Loader& load) {
  load(gl.get_error, "glGetError");
  load(gl.get_integerv, "glGetIntegerv");
  load(gl.viewport, "glViewport");
  load(gl.scissor, "glScissor");
  load(gl.clear_color, "glClearColor");
  load(gl.clear, "glClear");
  load(gl.enable, "glEnable");
  load(gl.disable, "glDisable");
  load(gl.blend_func_separate, "glBlendFuncSeparate");
  load(gl.blend_equation, "glBlendEquation");
  load(gl.depth_func, "glDepthFunc");
  load(gl.depth_mask, "glDepthMask");
  load(gl.cull_face, "glCullFace");
  load(gl.pixel_storei, "glPixelStorei");
  load(gl.finish, "glFinish");
  load(gl.read_pixels, "glReadPixels");
}

void load_shaders(Gl& gl, const Loader& load) {
  load(gl.create_shader, "glCreateShader");
  load(gl.shader_source, "glShaderSource");
  load(gl.compile_shader, "glCompileShader");
  load(gl.get_shaderiv, "glGetShaderiv");
  load(gl.get_shader_info_log, "glGetShaderInfoLog");
  load(gl.delete_shader, "glDeleteShader");
  load(gl.create_program, "glCreateProgram");
  load(gl.attach_shader, "glAttachShader");
  load(gl.link_program, "glLinkProgram");
  load(gl.get_programiv, "glGetProgramiv");
  load(gl.get_program_info_log, "glGetProgramInfoLog");
  load(gl.delete_program, "glDeleteProgram");
  load(gl.use_program, "glUseProgram");
  load(gl.get_uniform_location, "glGetUniformLocation");
  load(gl.uniform1i, "glUniform1i");
  load(gl.uniform1f, "glUniform1f");
  load(gl.uniform2f, "glUniform2f");
  load(gl.uniform4f, "glUniform4f");
  load(gl.uniform_matrix4fv, "glUniformMatrix4fv");
}

void load_vertices(Gl& gl, const Loader& load) {
  load(gl.gen_vertex_arrays, "glGenVertexArrays");
  load(gl.bind_vertex_array, "glBindVertexArray");
  load(gl.delete_vertex_arrays, "glDeleteVertexArrays");
  load(gl.gen_buffers, "glGenBuffers");
  load(gl.bind_buffer, "glBindBuffer");
  load(gl.buffer_data, "glBufferData");
  load(gl.buffer_sub_data, "glBufferSubData");
  load(gl.delete_buffers, "glDeleteBuffers");
  load(gl.enable_vertex_attrib_array, "glEnableVertexAttribArray");
  load(gl.vertex_attrib_pointer, "glVertexAttribPointer");
  load(gl.vertex_attrib4f, "glVertexAttrib4f");
  load(gl.vertex_attrib_divisor, "glVertexAttribDivisor");
  load(gl.draw_arrays_instanced, "glDrawArraysInstanced");
  load(gl.draw_elements, "glDrawElements");
}

void load_textures(Gl& gl, const Loader& load) {
  load(gl.gen_textures, "glGenTextures");
  load(gl.active_texture, "glActiveTexture");
  load(gl.bind_texture, "glBindTexture");
  load(gl.tex_image_2d, "glTexImage2D");
  load(gl.tex_parameteri, "glTexParameteri");
  load(gl.delete_textures, "glDeleteTextures");
  load(gl.gen_framebuffers, "glGenFramebuffers");
  load(gl.bind_framebuffer, "glBindFramebuffer");
  load(gl.framebuffer_texture_2d, "glFramebufferTexture2D");
  load(gl.draw_buffers, "glDrawBuffers");
  load(gl.check_framebuffer_status, "glCheckFramebufferStatus");
  load(gl.delete_framebuffers, "glDeleteFramebuffers");
  load(gl.gen_renderbuffers, "glGenRenderbuffers");
  load(gl.bind_renderbuffer, "glBindRenderbuffer");
  load(gl.renderbuffer_storage, "glRenderbufferStorage");
  load(gl.framebuffer_renderbuffer, "glFramebufferRenderbuffer");
  load(gl.delete_renderbuffers, "glDeleteRenderbuffers");
  load(gl.blit_framebuffer, "glBlitFramebuffer");
}

}  // namespace

Gl load_gl(GetProcAddress address_of) {
  Gl gl{};
  const Loader load(address_of);
  load_state(gl, load);
  load_shaders(gl, load);
  load_vertices(gl, load);
  load_textures(gl, load);
  return gl;
}

Image read_frame(const Gl& gl, int width, int height) {
  const auto row = static_cast<std::size_t>(width) * 3;
  std::vector<std::uint8_t> upwards(row * static_cast<std::size_t>(height));
  gl.pixel_storei(GL_PACK_ALIGNMENT, 1);
  gl.read_pixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, upwards.data());
  if (const Gl::Enum error = gl.get_error(); error != GL_NO_ERROR) {
    throw RunError(fmt::format("OpenGL error 0x{:04x} while a picture was drawn", error));
  }
  Image image{width, height, std::vector<std::uint8_t>(upwards.size())};
  for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
    std::copy_n(upwards.data() + y * row, row, image.rgb.data() + image.rgb.size() - (y + 1) * row);
  }
  return image;
}

namespace {

constexpr int kLogSize = 1024;

Gl::Name compiled(const Gl& gl, const char* whose, Gl::Enum type, const char* text) {
  const Gl::Name shader = gl.create_shader(type);
  gl.shader_source(shader, 1, &text, nullptr);
  gl.compile_shader(shader);
  int good = GL_FALSE;
  gl.get_shaderiv(shader, GL_COMPILE_STATUS, &good);
  if (good != GL_TRUE) {
    std::array<char, kLogSize> log{};
    gl.get_shader_info_log(shader, kLogSize, nullptr, log.data());
    gl.delete_shader(shader);
    throw RunError(fmt::format("{}'s shader does not compile: {}", whose, log.data()));
  }
  return shader;
}

}  // namespace

Gl::Name build_program(const Gl& gl, const char* whose, const char* vertex, const char* fragment) {
  const Gl::Name first = compiled(gl, whose, GL_VERTEX_SHADER, vertex);
  const Gl::Name second = compiled(gl, whose, GL_FRAGMENT_SHADER, fragment);
  const Gl::Name program = gl.create_program();
  gl.attach_shader(program, first);
  gl.attach_shader(program, second);
  gl.link_program(program);
  gl.delete_shader(first);  // kept by OpenGL until the program goes
  gl.delete_shader(second);
  int good = GL_FALSE;
  gl.get_programiv(program, GL_LINK_STATUS, &good);
  if (good != GL_TRUE) {
    std::array<char, kLogSize> log{};
    gl.get_program_info_log(program, kLogSize, nullptr, log.data());
    throw RunError(fmt::format("{}'s shaders do not link: {}", whose, log.data()));
  }
  return program;
}

}  // namespace haptrial::render
