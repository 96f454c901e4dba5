// Shaders: what C++ and GLSL must agree on, and what a broken one says.
#include "catchlight/error.hpp"
#include "embedded/embedded_shaders.hpp"
#include "render/compositor.hpp"
#include "render/gl/shader.hpp"
#include "render/settings.hpp"
#include "shaders/interface.h"
#include "tests/support/gl_fixture.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace catchlight::render::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class ShaderGl : public GlTest {};

struct Member {
  std::string name;
  std::size_t offset;
};

/// Compares with what GL reports of the block's members that the program uses; the others cannot be asked for.
void expect_layout(const GlProgram& program, const std::string& block, std::size_t size, const std::vector<Member>& members) {
  const GLuint block_index = glGetProgramResourceIndex(program.id(), GL_UNIFORM_BLOCK, block.c_str());
  ASSERT_NE(block_index, GL_INVALID_INDEX) << block;
  const GLenum size_property = GL_BUFFER_DATA_SIZE, offset_property = GL_OFFSET;
  GLint value = -1;
  glGetProgramResourceiv(program.id(), GL_UNIFORM_BLOCK, block_index, 1, &size_property, 1, nullptr, &value);
  EXPECT_EQ(static_cast<std::size_t>(value), size) << block;
  for (const Member& member : members) {
    const GLuint index = glGetProgramResourceIndex(program.id(), GL_UNIFORM, (block + "." + member.name).c_str());
    ASSERT_NE(index, GL_INVALID_INDEX) << block << "." << member.name;
    glGetProgramResourceiv(program.id(), GL_UNIFORM, index, 1, &offset_property, 1, nullptr, &value);
    EXPECT_EQ(static_cast<std::size_t>(value), member.offset) << block << "." << member.name;
  }
}

#define MEMBER(type, name)      \
  Member {                      \
#name, offsetof(type, name) \
  }

TEST_F(ShaderGl, UniformBlocksLieAsCppLaysThem) {
  using namespace shader_interface;
  const GlProgram object = make_program({.vertex = "object.vert", .fragment = "object.frag", .captured = {}}, "");
  expect_layout(object, "ViewUniforms", sizeof(ViewUniforms),
                {MEMBER(ViewUniforms, clip_from_camera), MEMBER(ViewUniforms, camera_from_tag),
                 MEMBER(ViewUniforms, light_from_tag), MEMBER(ViewUniforms, plate_from_rec709),
                 MEMBER(ViewUniforms, camera_in_tag_m), MEMBER(ViewUniforms, exposure), MEMBER(ViewUniforms, radial_numerator),
                 MEMBER(ViewUniforms, radial_denominator), MEMBER(ViewUniforms, tangential), MEMBER(ViewUniforms, lens_limit)});
  const GlProgram transfer = make_program({.vertex = "transfer.vert", .fragment = {}, .captured = {"transferred"}}, "");
  expect_layout(transfer, "LightUniforms", sizeof(LightUniforms),
                {MEMBER(LightUniforms, count), {"coefficients[0]", offsetof(LightUniforms, coefficients)}});
  const GlProgram receiver = make_program({.vertex = "receiver.vert", .fragment = "receiver.frag", .captured = {}}, "");
  expect_layout(
      receiver, "ReceiverUniforms", sizeof(ReceiverUniforms),
      {MEMBER(ReceiverUniforms, min_max_m), MEMBER(ReceiverUniforms, one_over_unshadowed), MEMBER(ReceiverUniforms, points)});
  const GlProgram composite = make_program({.vertex = "fullscreen.vert", .fragment = "composite.frag", .captured = {}}, "");
  expect_layout(
      composite, "CompositeUniforms", sizeof(CompositeUniforms),
      {MEMBER(CompositeUniforms, output_rect), MEMBER(CompositeUniforms, virtual_rect), MEMBER(CompositeUniforms, modes),
       MEMBER(CompositeUniforms, black), MEMBER(CompositeUniforms, code_limits), MEMBER(CompositeUniforms, glare_from_frame)});
}

/// A folder with all embedded shaders, for one test.
class ShaderFolder {
 public:
  ShaderFolder() {
    std::filesystem::create_directories(path_);
    for (const auto& [name, text] : embedded_shaders()) write(name, text);
  }
  ~ShaderFolder() { std::filesystem::remove_all(path_); }
  void write(const std::string& name, const std::string& text) const { std::ofstream(path_ / name) << text; }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_ = std::filesystem::temp_directory_path() / ("catchlight_shaders_" + std::to_string(getpid()));
};

TEST_F(ShaderGl, AFolderReplacesTheEmbeddedFiles) {
  ShaderFolder folder;
  std::string text = embedded_shaders().at("composite.frag");
  const std::string codes = "vec4(new_code, changed";
  text.replace(text.find(codes), codes.size(), "vec4(vec3(0.25), changed");
  folder.write("composite.frag", text);
  CompositorSettings settings;
  settings.shader_folder = folder.path();
  Compositor compositor(constant_scene(sphere(0.05, {0, 0, 0}), Material{}, glm::vec3(1)), settings);
  EXPECT_EQ(pixel_at(compositor.render(view_from_above(), plate_u8(200)), 80, 60).x, 0.25f);
}

TEST_F(ShaderGl, AnErrorNamesFileAndLineAlsoWithinAnInclude) {
  ShaderFolder folder;
  folder.write("lens.glsl", "vec4 clip_from_tag(vec3 p) {\n  return nonsense;\n}\n");
  EXPECT_THAT(
      [&] { make_program({.vertex = "object.vert", .fragment = "object.frag", .captured = {}}, folder.path()); },
      ThrowsMessage<Error>(AllOf(HasSubstr("object.vert"), HasSubstr("2 = lens.glsl"), HasSubstr("2:2"), HasSubstr("nonsense"))));
}

TEST_F(ShaderGl, AMissingFileIsNamed) {
  ShaderFolder folder;
  std::filesystem::remove(folder.path() + "/color.glsl");
  EXPECT_THAT([&] { shader_text("composite.frag", folder.path()); },
              ThrowsMessage<Error>(HasSubstr("color.glsl: cannot be read")));
  EXPECT_THAT([] { shader_text("no.frag", ""); }, ThrowsMessage<Error>(HasSubstr("no.frag")));
}

TEST_F(ShaderGl, StagesThatDoNotFitAreReported) {
  ShaderFolder folder;
  folder.write("fullscreen.vert", "#version 450 core\nvoid main() { gl_Position = vec4(0); }\n");
  folder.write("bad.frag",
               "#version 450 core\nin vec3 never_written;\nout vec4 c;\nvoid main() { c = vec4(never_written, 1); }\n");
  EXPECT_THAT([&] { make_program({.vertex = "fullscreen.vert", .fragment = "bad.frag", .captured = {}}, folder.path()); },
              ThrowsMessage<Error>(HasSubstr("fullscreen.vert + bad.frag")));
}

TEST_F(ShaderGl, EveryShaderPassesTheReferenceCompiler) {
  if (std::system("glslangValidator --version > /dev/null 2>&1") != 0)
    GTEST_SKIP() << "glslangValidator (glslang-tools) is not installed";
  ShaderFolder folder;
  for (const auto& [name, text] : embedded_shaders()) {
    if (!name.ends_with(".vert") && !name.ends_with(".frag")) continue;
    folder.write(name, shader_text(name, "").text);
    EXPECT_EQ(std::system(("glslangValidator " + folder.path() + "/" + name).c_str()), 0) << name;
  }
}

TEST_F(ShaderGl, GlErrorsSurfaceAtTheNextCheck) {
  glEnable(0xFFFF);
  EXPECT_THAT([] { check_gl("the middle of a test"); }, ThrowsMessage<Error>(HasSubstr("the middle of a test")));
  EXPECT_NO_THROW(check_gl("the same place again"));
}

TEST_F(ShaderGl, TheContextSaysWhatItIs) {
  const GlInfo info = gl_info();
  EXPECT_THAT(info.version, HasSubstr("4.5"));
  EXPECT_FALSE(info.renderer.empty());
  EXPECT_THAT(info.platform, HasSubstr("EGL"));
}

}  // namespace
}  // namespace catchlight::render::test
