// The rules of the house, held against the tree itself; and against made-up trees with one fault each, for a rule that finds
// nothing may be asleep.
#include "tests/house/include_rules.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace catchlight::house {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string itself(const std::string& file) {
  return file;
}

class House : public ::testing::Test {
 protected:
  static const SourceTree& tree() {
    static const SourceTree read = read_tree(CATCHLIGHT_SOURCE_DIR);
    return read;
  }
};

TEST_F(House, IsRead) {
  EXPECT_GT(tree().size(), 400u);
  EXPECT_THAT(tree().at("render/gl_compositor.cpp").includes, ::testing::Contains("render/gl_compositor.hpp"));
}

TEST_F(House, HasNoForbiddenInclude) {
  EXPECT_THAT(forbidden_includes(tree()), IsEmpty());
}

TEST_F(House, HasNoCircleOfFiles) {
  EXPECT_THAT(include_circles(tree(), itself), IsEmpty());
}

TEST_F(House, HasNoCircleOfUnits) {
  EXPECT_THAT(include_circles(tree(), unit_of), IsEmpty());
}

TEST_F(House, HasNoCircleOfFolders) {
  EXPECT_THAT(include_circles(tree(), folder_of), IsEmpty());
}

TEST_F(House, HasNoCircleOfLibraries) {
  EXPECT_THAT(include_circles(tree(), library_of), IsEmpty());
}

TEST_F(House, HasRoomInFoldersAndFiles) {
  EXPECT_THAT(oversized(tree()), IsEmpty());
}

struct Fault {
  std::string file, include;
};

class ForbiddenInclude : public ::testing::TestWithParam<Fault> {};

TEST_P(ForbiddenInclude, IsFound) {
  const tests::TemporaryFolder folder;
  folder.write(GetParam().file, "#pragma once\n  #  include <" + GetParam().include + ">  // why not\n");
  EXPECT_THAT(forbidden_includes(read_tree(folder.path())),
              ElementsAre(HasSubstr(GetParam().file + " includes " + GetParam().include + ": ")));
}

INSTANTIATE_TEST_SUITE_P(
    Each, ForbiddenInclude,
    ::testing::Values(Fault{"tracking/pose/a.hpp", "render/math/sh.hpp"}, Fault{"tracking/a.cpp", "app/session/b.hpp"},
                      Fault{"tracking/a.cpp", "epoxy/gl.h"}, Fault{"render/camera/a.cpp", "tracking/tracker.hpp"},
                      Fault{"render/passes/a.cpp", "app/media/b.hpp"}, Fault{"render/image/a.hpp", "render/gl/gl_objects.hpp"},
                      Fault{"render/math/a.cpp", "epoxy/gl.h"}, Fault{"render/mesh/a.cpp", "render/passes/b.hpp"},
                      Fault{"render/probe/a.cpp", "EGL/egl.h"}, Fault{"render/rays/a.cpp", "render/gl_compositor.hpp"},
                      Fault{"render/transfer/a.cpp", "render/gl/shader.hpp"}, Fault{"render/glare/a.cpp", "epoxy/gl.h"},
                      Fault{"render/tone/a.cpp", "render/passes/b.hpp"}, Fault{"render/cpu/glare/a.cpp", "render/passes/b.hpp"},
                      Fault{"render/camera/a.cpp", "render/gl/b.hpp"}, Fault{"render/reference/a.cpp", "render/gl/b.hpp"},
                      Fault{"render/settings.hpp", "render/gl/b.hpp"}, Fault{"render/gl/a.cpp", "GLFW/glfw3.h"},
                      Fault{"render/passes/a.cpp", "imgui.h"}, Fault{"tracking/a.cpp", "CLI/CLI.hpp"},
                      Fault{"render/gl/a.cpp", "libavutil/frame.h"}, Fault{"app/session/a.cpp", "libswscale/swscale.h"},
                      Fault{"app/media/read/a.cpp", "tracking/tracker.hpp"}, Fault{"app/session/a.cpp", "imgui.h"},
                      Fault{"app/commands/a.cpp", "GLFW/glfw3.h"}, Fault{"app/media/write/a.cpp", "render/gl_compositor.hpp"},
                      Fault{"app/main.cpp", "tests/support/a.hpp"}, Fault{"catchlight/a.hpp", "render/math/sh.hpp"},
                      Fault{"catchlight/util/a.hpp", "shaders/interface.h"}, Fault{"catchlight/a.hpp", "opencv2/core.hpp"},
                      Fault{"catchlight/a.hpp", "unistd.h"}));

TEST(AllowedIncludes, ArePassedOver) {
  const tests::TemporaryFolder folder;
  folder.write("catchlight/a.hpp", "#include <glm/glm.hpp>\n#include <vector>\n#include \"catchlight/b.hpp\"\n");
  folder.write("render/gl/a.cpp", "#include <epoxy/gl.h>\n#include \"render/math/sh.hpp\"\n");
  folder.write("app/media/a.cpp", "#include <libavutil/frame.h>\n");
  folder.write("tracking/a.cpp", "// #include \"render/math/sh.hpp\"\n");
  EXPECT_THAT(forbidden_includes(read_tree(folder.path())), IsEmpty());
}

TEST(IncludeCircle, OfHeadersIsFound) {
  const tests::TemporaryFolder folder;
  folder.write("render/a.hpp", "#include \"render/b.hpp\"\n");
  folder.write("render/b.hpp", "#include \"render/c.hpp\"\n");
  folder.write("render/c.hpp", "#include \"render/a.hpp\"\n");
  folder.write("render/d.hpp", "#include \"render/a.hpp\"\n");  // leads into the circle, and is no part of it
  EXPECT_THAT(include_circles(read_tree(folder.path()), itself), ElementsAre("render/a.hpp <-> render/b.hpp <-> render/c.hpp"));
}

TEST(IncludeCircle, OfUnitsIsFound) {
  const tests::TemporaryFolder folder;
  folder.write("render/a.hpp", "");
  folder.write("render/a.cpp", "#include \"render/a.hpp\"\n#include \"render/b.hpp\"\n");
  folder.write("render/b.hpp", "#include \"render/a.hpp\"\n");
  const SourceTree tree = read_tree(folder.path());
  EXPECT_THAT(include_circles(tree, itself), IsEmpty());
  EXPECT_THAT(include_circles(tree, unit_of), ElementsAre("render/a <-> render/b"));
}

TEST(IncludeCircle, OfFoldersIsFound) {
  const tests::TemporaryFolder folder;
  folder.write("tracking/pose/a.cpp", "#include \"tracking/camera/b.hpp\"\n");
  folder.write("tracking/pose/c.hpp", "");
  folder.write("tracking/camera/b.hpp", "");
  folder.write("tracking/camera/b.cpp", "#include \"tracking/pose/c.hpp\"\n");
  const SourceTree tree = read_tree(folder.path());
  EXPECT_THAT(include_circles(tree, unit_of), IsEmpty());
  EXPECT_THAT(include_circles(tree, folder_of), ElementsAre("tracking/camera <-> tracking/pose"));
}

TEST(IncludeCircle, IsNoneWhereAFolderHasPlainDataFromAboveIt) {
  const tests::TemporaryFolder folder;
  folder.write("tracking/tracker.cpp", "#include \"tracking/pose/a.hpp\"\n");
  folder.write("tracking/pose/a.hpp", "#include \"tracking/observation.hpp\"\n");
  folder.write("tracking/observation.hpp", "");
  EXPECT_THAT(include_circles(read_tree(folder.path()), folder_of), IsEmpty());
}

TEST(IncludeCircle, OfLibrariesIsFound) {
  const tests::TemporaryFolder folder;
  folder.write("app/media/write/a.cpp", "#include \"app/session/b.hpp\"\n");
  folder.write("app/session/b.hpp", "");
  folder.write("app/session/c.cpp", "#include \"app/media/read/d.hpp\"\n");
  folder.write("app/media/read/d.hpp", "");
  EXPECT_THAT(include_circles(read_tree(folder.path()), library_of), ElementsAre("app <-> catchlight_media"));
}

TEST(Oversized, IsAFolderWithMoreThan25FilesOfAKind) {
  const tests::TemporaryFolder folder;
  for (int i = 0; i < 25; ++i) {
    folder.write("app/a" + std::to_string(i) + ".cpp", "");
    folder.write("app/a" + std::to_string(i) + ".hpp", "");
  }
  EXPECT_THAT(oversized(read_tree(folder.path())), IsEmpty());
  folder.write("app/one_more.hpp", "");
  EXPECT_THAT(oversized(read_tree(folder.path())), ElementsAre("app/*.hpp are 26 files, more than 25"));
}

TEST(Oversized, IsAFileOfMoreThan400Lines) {
  const tests::TemporaryFolder folder;
  folder.write("app/long.cpp", std::string(400, '\n'));
  EXPECT_THAT(oversized(read_tree(folder.path())), IsEmpty());
  folder.write("app/long.cpp", std::string(401, '\n'));
  EXPECT_THAT(oversized(read_tree(folder.path())), ElementsAre("app/long.cpp has 401 lines, more than 400"));
}

}  // namespace
}  // namespace catchlight::house
