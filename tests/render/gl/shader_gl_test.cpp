// Shaders: what C++ and GLSL must agree on, and what a broken one says.
#include "catchlight/error.hpp"
#include "embedded/embedded_shaders.hpp"
#include "render/gl/fullscreen.hpp"
#include "render/gl/gl_context.hpp"
#include "render/gl/shader_library.hpp"
#include "render/gl_compositor.hpp"
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
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

class ShaderGl : public GlTest {};

struct Member {
  std::string name;
  std::size_t offset;
};

/// Compares with what GL reports of the block's members that the program uses; the others cannot be asked for.
void expect_layout(const Program& program, const std::string& block, std::size_t size, const std::vector<Member>& members) {
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
  ShaderLibrary shaders;
  const Program& object = shaders.program({.vertex = "object.vert", .fragment = "object.frag"});
  expect_layout(
      object, "ViewUniforms", sizeof(ViewUniforms),
      {MEMBER(ViewUniforms, clip_from_camera), MEMBER(ViewUniforms, camera_from_tag), MEMBER(ViewUniforms, light_from_tag),
       MEMBER(ViewUniforms, plate_from_rec709), MEMBER(ViewUniforms, camera_in_tag_m), MEMBER(ViewUniforms, exposure),
       MEMBER(ViewUniforms, radial_numerator), MEMBER(ViewUniforms, radial_denominator), MEMBER(ViewUniforms, tangential),
       MEMBER(ViewUniforms, distortion_limit)});
  const Program& transfer = shaders.program({.vertex = "transfer.vert", .captured = {"transferred"}});
  expect_layout(transfer, "LightUniforms", sizeof(LightUniforms),
                {MEMBER(LightUniforms, count), {"coefficients[0]", offsetof(LightUniforms, coefficients)}});
  const Program& receiver = shaders.program({.vertex = "receiver.vert", .fragment = "receiver.frag"});
  expect_layout(
      receiver, "ReceiverUniforms", sizeof(ReceiverUniforms),
      {MEMBER(ReceiverUniforms, min_max_m), MEMBER(ReceiverUniforms, one_over_unshadowed), MEMBER(ReceiverUniforms, points)});
  const Program& composite = shaders.program(fullscreen("composite.frag"));
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
  /// Replaces every `from` of the embedded file.
  void replace_in(const std::string& name, const std::string& from, const std::string& to) const {
    std::string text = embedded_shaders().at(name);
    ASSERT_NE(text.find(from), std::string::npos) << from;
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) text.replace(at, from.size(), to);
    write(name, text);
  }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_ = std::filesystem::temp_directory_path() / ("catchlight_shaders_" + std::to_string(getpid()));
};

CompositorSettings with_shaders_from(const ShaderFolder& folder) {
  CompositorSettings settings;
  settings.shader_folder = folder.path();
  return settings;
}

RenderScene white_ball() {
  return constant_scene(sphere(0.05, {0, 0, 0}), Material{}, glm::vec3(1));
}

float red_in_the_middle(GlCompositor& compositor) {
  return pixel_at(compositor.render(view_from_above(), plate_u8(200)), 80, 60).x;
}

TEST_F(ShaderGl, AFolderReplacesTheEmbeddedFiles) {
  ShaderFolder folder;
  folder.replace_in("composite.frag", "vec4(new_code, changed", "vec4(vec3(0.25), changed");
  GlCompositor compositor(white_ball(), with_shaders_from(folder));
  EXPECT_EQ(red_in_the_middle(compositor), 0.25f);
}

TEST_F(ShaderGl, ReloadTakesUpWhatWasEditedAndKeepsWhatDoesNotCompile) {
  ShaderFolder folder;
  GlCompositor compositor(white_ball(), with_shaders_from(folder));
  const float as_shipped = red_in_the_middle(compositor);
  EXPECT_THAT(compositor.reload_shaders(), IsEmpty()) << "nothing was edited";
  EXPECT_EQ(red_in_the_middle(compositor), as_shipped);

  folder.replace_in("composite.frag", "vec4(new_code, changed", "vec4(vec3(0.25), changed");
  EXPECT_THAT(compositor.reload_shaders(), IsEmpty());
  EXPECT_EQ(red_in_the_middle(compositor), 0.25f);

  folder.write("sensor_noise.glsl", "\n\nvec3 missing_noise() { return nonsense; }\n");
  EXPECT_THAT(compositor.reload_shaders(),
              ElementsAre(AllOf(HasSubstr("composite.frag"), HasSubstr(folder.path() + "/sensor_noise.glsl:3"))));
  EXPECT_EQ(red_in_the_middle(compositor), 0.25f) << "the last one that compiled draws on";

  std::filesystem::remove(folder.path() + "/sensor_noise.glsl");
  EXPECT_THAT(compositor.reload_shaders(), ElementsAre(HasSubstr("sensor_noise.glsl: cannot be read")));

  folder.write("sensor_noise.glsl", embedded_shaders().at("sensor_noise.glsl"));
  folder.write("composite.frag", embedded_shaders().at("composite.frag"));
  EXPECT_THAT(compositor.reload_shaders(), IsEmpty());
  EXPECT_EQ(red_in_the_middle(compositor), as_shipped);
}

TEST_F(ShaderGl, ReloadLightsAnewWhatIsLitOnce) {
  ShaderFolder folder;
  Material white;
  white.base_color = glm::vec3(1);
  white.dielectric_f0 = 0;
  GlCompositor compositor(constant_scene(sphere(0.05, {0, 0, 0}), white, glm::vec3(0.5f)), with_shaders_from(folder));
  EXPECT_GT(red_in_the_middle(compositor), 0.5f);
  folder.replace_in("transfer.vert", "transferred = mix(", "transferred = 0.0 * mix(");
  EXPECT_THAT(compositor.reload_shaders(), IsEmpty());
  EXPECT_EQ(red_in_the_middle(compositor), 0.0f);
}

TEST_F(ShaderGl, AProgramIsCompiledOnceAndStaysGood) {
  ShaderFolder folder;
  ShaderLibrary shaders(folder.path());
  Program& up = shaders.program(fullscreen("glare_up.frag"));
  const GLuint as_shipped = up.id();
  EXPECT_EQ(&shaders.program(fullscreen("glare_up.frag")), &up);
  EXPECT_NE(&shaders.program(fullscreen("glare_up.frag", {"OWN"})), &up);
  EXPECT_THAT(shaders.reload(), IsEmpty());
  EXPECT_EQ(up.id(), as_shipped) << "unchanged files are not compiled again";
  folder.replace_in("bspline.glsl", "vec3 bspline(", "// edited\nvec3 bspline(");
  EXPECT_THAT(shaders.reload(), IsEmpty());
  EXPECT_NE(up.id(), as_shipped);
  EXPECT_EQ(&shaders.program(fullscreen("glare_up.frag")), &up);
}

TEST_F(ShaderGl, UniformsAreSetByName) {
  ShaderFolder folder;
  ShaderLibrary shaders(folder.path());
  Program& up = shaders.program(fullscreen("glare_up.frag", {"OWN"}));
  up.set("own_gain", 0.75f);
  const auto own_gain = [&] {
    float value = 0;
    glGetUniformfv(up.id(), glGetUniformLocation(up.id(), "own_gain"), &value);
    return value;
  };
  EXPECT_EQ(own_gain(), 0.75f);
  EXPECT_THAT([&] { up.set("own_gian", 1.0f); }, ThrowsMessage<Error>(AllOf(HasSubstr("glare_up.frag"), HasSubstr("own_gian"))));
  // Without OWN nothing reads it and the compiler drops it.
  EXPECT_NO_THROW(shaders.program(fullscreen("glare_up.frag")).set("own_gain", 1.0f));
  up.set("own_gain", 3);
  EXPECT_THAT([] { check_gl("a test"); }, ThrowsMessage<Error>(HasSubstr("a test"))) << "an integer for a float";

  // A program that lost what its pass sets is as broken as one that does not compile.
  folder.replace_in("glare_up.frag", "own_gain", "gain_of_own");
  EXPECT_THAT(shaders.reload(), Contains(HasSubstr("own_gain")));
  EXPECT_EQ(own_gain(), 0.75f);
}

TEST_F(ShaderGl, AnErrorNamesFileAndLineAlsoWithinAnInclude) {
  ShaderFolder folder;
  folder.write("distortion.glsl", "vec4 clip_from_tag(vec3 p) {\n  return nonsense;\n}\n");
  ShaderLibrary shaders(folder.path());
  EXPECT_THAT([&] { shaders.program({.vertex = "object.vert", .fragment = "object.frag"}); },
              ThrowsMessage<Error>(
                  AllOf(HasSubstr("object.vert"), HasSubstr(folder.path() + "/distortion.glsl:2"), HasSubstr("nonsense"))));
}

TEST(ShaderLog, NamesFilesAsEachDriverCountsThem) {
  const ShaderText text{"", {"a.frag", "interface.h", "distortion.glsl"}};
  EXPECT_EQ(with_file_names("2:23(9): error: oh", text), "distortion.glsl:23(9): error: oh\n");
  EXPECT_EQ(with_file_names("ERROR: 1:7: 'x' : oh", text), "interface.h:7: 'x' : oh\n");
  EXPECT_EQ(with_file_names("0(12) : error C1008: oh\nand more", text), "a.frag:12 : error C1008: oh\nand more\n");
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
  ShaderLibrary shaders(folder.path());
  EXPECT_THAT([&] { shaders.program(fullscreen("bad.frag")); }, ThrowsMessage<Error>(HasSubstr("fullscreen.vert + bad.frag")));
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
