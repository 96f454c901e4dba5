// Files for tests: a folder of one's own, and footage that may be absent.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "catchlight/error.hpp"

namespace catchlight::render {

/// A new empty folder, removed at the end of the test.
class TempFolder {
 public:
  TempFolder() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ =
        std::filesystem::temp_directory_path() / ("catchlight_" + std::string(test->test_suite_name()) + "_" + test->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~TempFolder() { std::filesystem::remove_all(folder_); }
  std::string operator/(const std::string& name) const { return (folder_ / name).string(); }

 private:
  std::filesystem::path folder_;
};

inline void write_text(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

inline std::string read_text(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Changes a byte in the middle of each file of a folder.
inline void damage_all_in(const std::string& folder) {
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::string bytes = read_text(entry.path());
    bytes[bytes.size() / 2] ^= 0x10;
    write_text(entry.path(), bytes);
  }
}

/// Collects warnings.
struct Warnings {
  std::vector<std::string> all;
  WarningHandler handler() {
    return [this](const std::string& warning) { all.push_back(warning); };
  }
};

/// Message of the Error that `call` throws; empty where it throws none.
template <typename Call>
std::string error_of(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// Folder of real footage: $CATCHLIGHT_FOOTAGE, or shared/footage beside the sources.
inline std::filesystem::path footage_folder() {
  const char* named = std::getenv("CATCHLIGHT_FOOTAGE");
  return named ? std::filesystem::path(named) : std::filesystem::path(CATCHLIGHT_SOURCE_DIR) / ".." / "shared" / "footage";
}

}  // namespace catchlight::render
