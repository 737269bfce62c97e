#include "core/render/gl/gl_program.h"

#include <GL/glcorearb.h>
#include <fmt/format.h>

#include <array>

#include "core/base/error.h"

namespace haptrial::render {
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
