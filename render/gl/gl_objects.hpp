// Owners of GL objects: move-only, empty by default (safe without a context), labelled for debuggers. Direct state access
// throughout.
#pragma once

#include <epoxy/gl.h>

#include <cstddef>
#include <span>
#include <string>
#include <utility>

namespace catchlight::render {

/// Deletes its object with Traits::destroy.
template <typename Traits>
class GlObject {
 public:
  GlObject() = default;
  explicit GlObject(GLuint id) : id_(id) {}
  ~GlObject() {
    if (id_ != 0) Traits::destroy(id_);
  }
  GlObject(GlObject&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
  GlObject& operator=(GlObject&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  GlObject(const GlObject&) = delete;
  GlObject& operator=(const GlObject&) = delete;

  GLuint id() const { return id_; }
  explicit operator bool() const { return id_ != 0; }

 private:
  GLuint id_ = 0;
};

namespace detail {
struct BufferTraits {
  static void destroy(GLuint id) { glDeleteBuffers(1, &id); }
};
struct TextureTraits {
  static void destroy(GLuint id) { glDeleteTextures(1, &id); }
};
struct RenderbufferTraits {
  static void destroy(GLuint id) { glDeleteRenderbuffers(1, &id); }
};
struct FramebufferTraits {
  static void destroy(GLuint id) { glDeleteFramebuffers(1, &id); }
};
struct VertexArrayTraits {
  static void destroy(GLuint id) { glDeleteVertexArrays(1, &id); }
};
struct QueryTraits {
  static void destroy(GLuint id) { glDeleteQueries(1, &id); }
};
struct ProgramTraits {
  static void destroy(GLuint id) { glDeleteProgram(id); }
};
struct ShaderTraits {
  static void destroy(GLuint id) { glDeleteShader(id); }
};
}  // namespace detail

using GlBuffer = GlObject<detail::BufferTraits>;
using GlTexture = GlObject<detail::TextureTraits>;
using GlRenderbuffer = GlObject<detail::RenderbufferTraits>;
using GlFramebuffer = GlObject<detail::FramebufferTraits>;
using GlVertexArray = GlObject<detail::VertexArrayTraits>;
using GlQuery = GlObject<detail::QueryTraits>;
using GlProgram = GlObject<detail::ProgramTraits>;
using GlShader = GlObject<detail::ShaderTraits>;

/// Immutable storage of max(1, bytes) bytes, filled from `data` unless null; `flags` as glNamedBufferStorage takes them.
GlBuffer make_buffer(const std::string& label, std::size_t bytes, const void* data, GLbitfield flags = 0);

template <typename T>
GlBuffer make_buffer(const std::string& label, std::span<const T> data) {
  return make_buffer(label, data.size_bytes(), data.data());
}

/// One mip level, clamped to its edge, `filter` both ways. Throws Error where the size exceeds what GL offers.
GlTexture make_texture_2d(const std::string& label, GLenum format, int width, int height, GLenum filter = GL_NEAREST);

/// All mip levels, filtered between texels and levels, clamped to its edge.
GlTexture make_mipmapped_texture_2d(const std::string& label, GLenum format, int width, int height);

/// `samples` < 2: one sample a pixel.
GlRenderbuffer make_renderbuffer(const std::string& label, GLenum format, int width, int height, int samples);

GlFramebuffer make_framebuffer(const std::string& label);
GlVertexArray make_vertex_array(const std::string& label);
GlQuery make_query(GLenum target);

inline void bind_storage(GLuint binding, GLuint buffer) {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer);
}

/// A uniform block's buffer, rewritten each frame.
template <typename Block>
class UniformBuffer {
 public:
  explicit UniformBuffer(const std::string& label)
      : buffer_(make_buffer(label, sizeof(Block), nullptr, GL_DYNAMIC_STORAGE_BIT)) {}

  void update(const Block& block) { glNamedBufferSubData(buffer_.id(), 0, sizeof(Block), &block); }
  void bind(GLuint binding) const { glBindBufferBase(GL_UNIFORM_BUFFER, binding, buffer_.id()); }

 private:
  GlBuffer buffer_;
};

}  // namespace catchlight::render
