// The pages that people read, as text.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace catchlight::house {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> pages() {
  const fs::path root = CATCHLIGHT_SOURCE_DIR;
  std::vector<fs::path> found;
  for (const fs::path& folder : {root, root / "docs", root / "recordings"})
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
      if (entry.path().extension() == ".md") found.push_back(entry.path());
  return found;
}

/// The characters of a line of UTF-8.
std::size_t columns(const std::string& line) {
  std::size_t count = 0;
  for (const char c : line) count += (static_cast<unsigned char>(c) & 0xC0) != 0x80 ? 1 : 0;
  return count;
}

/// Prose is wrapped at 120 columns; tables and pictures cannot be. What is far beyond that was forgotten.
TEST(Pages, HaveNoLineThatRunsOutOfAnEditor) {
  constexpr std::size_t kMaxColumns = 200;
  EXPECT_GT(pages().size(), 15u);
  for (const fs::path& page : pages()) {
    std::ifstream file(page);
    int number = 0;
    for (std::string line; std::getline(file, line);) {
      ++number;
      if (line.starts_with("|") || line.starts_with("![")) continue;
      EXPECT_LT(columns(line), kMaxColumns) << page << ":" << number;
    }
  }
}

}  // namespace
}  // namespace catchlight::house
