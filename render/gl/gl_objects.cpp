#include "render/gl/gl_objects.hpp"

#include <algorithm>
#include <bit>

#include <algorithm>

#include "catchlight/error.hpp"

namespace catchlight::render {
namespace {

void set_label(GLenum kind, GLuint id, const std::string& label) {
  glObjectLabel(kind, id, static_cast<GLsizei>(label.size()), label.c_str());
}

void check_size(const std::string& label, int width, int height, GLenum limit_name) {
  GLint limit = 0;
  glGetIntegerv(limit_name, &limit);
  if (width < 1 || height < 1 || width > limit || height > limit) {
    throw Error("the " + label + " needs " + std::to_string(width) + " x " + std::to_string(height) +
                " texels; this OpenGL offers 1 to " + std::to_string(limit) +
                " a side: use smaller footage or another GL device");
  }
}

}  // namespace

GlBuffer make_buffer(const std::string& label, std::size_t bytes, const void* data, GLbitfield flags) {
  GLuint id = 0;
  glCreateBuffers(1, &id);
  GlBuffer buffer(id);
  set_label(GL_BUFFER, id, label);
  // GL refuses empty storage; an empty mesh is still a mesh.
  glNamedBufferStorage(id, static_cast<GLsizeiptr>(std::max<std::size_t>(bytes, 1)), bytes > 0 ? data : nullptr, flags);
  return buffer;
}

namespace {

GlTexture make_clamped_texture_2d(const std::string& label, GLenum format, int width, int height, int levels) {
  check_size(label, width, height, GL_MAX_TEXTURE_SIZE);
  GLuint id = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &id);
  GlTexture texture(id);
  set_label(GL_TEXTURE, id, label);
  glTextureStorage2D(id, levels, format, width, height);
  glTextureParameteri(id, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(id, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return texture;
}

}  // namespace

GlTexture make_texture_2d(const std::string& label, GLenum format, int width, int height, GLenum filter) {
  GlTexture texture = make_clamped_texture_2d(label, format, width, height, 1);
  glTextureParameteri(texture.id(), GL_TEXTURE_MIN_FILTER, static_cast<GLint>(filter));
  glTextureParameteri(texture.id(), GL_TEXTURE_MAG_FILTER, static_cast<GLint>(filter));
  return texture;
}

GlTexture make_mipmapped_texture_2d(const std::string& label, GLenum format, int width, int height) {
  const int levels = std::bit_width(static_cast<unsigned>(std::max(width, height)));
  GlTexture texture = make_clamped_texture_2d(label, format, width, height, levels);
  glTextureParameteri(texture.id(), GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTextureParameteri(texture.id(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  return texture;
}

GlRenderbuffer make_renderbuffer(const std::string& label, GLenum format, int width, int height, int samples) {
  check_size(label, width, height, GL_MAX_RENDERBUFFER_SIZE);
  GLuint id = 0;
  glCreateRenderbuffers(1, &id);
  GlRenderbuffer buffer(id);
  set_label(GL_RENDERBUFFER, id, label);
  glNamedRenderbufferStorageMultisample(id, samples < 2 ? 0 : samples, format, width, height);
  return buffer;
}

GlFramebuffer make_framebuffer(const std::string& label) {
  GLuint id = 0;
  glCreateFramebuffers(1, &id);
  GlFramebuffer framebuffer(id);
  set_label(GL_FRAMEBUFFER, id, label);
  return framebuffer;
}

GlVertexArray make_vertex_array(const std::string& label) {
  GLuint id = 0;
  glCreateVertexArrays(1, &id);
  GlVertexArray array(id);
  set_label(GL_VERTEX_ARRAY, id, label);
  return array;
}

GlQuery make_query(GLenum target) {
  GLuint id = 0;
  glCreateQueries(target, 1, &id);
  return GlQuery(id);
}

}  // namespace catchlight::render
