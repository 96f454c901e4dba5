#include <gtest/gtest.h>

#include "render/transfer/transfer.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/test_files.hpp"

namespace catchlight::render {
namespace {

class TransferCache : public testing::Test {
 protected:
  TransferCache() {
    options_.bands = 3, options_.rays = 16;
    append(mesh_, box({1, 1, 0}, {2, 2, 3}));
  }

  Transfer load(bool& hit) {
    return load_or_bake_transfer(mesh_, grid_, options_, folder_ / "cache", {}, warnings_.handler(), &hit);
  }

  std::filesystem::path file() {
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "cache")) return entry.path();
    return {};
  }

  void expect_rebaked(const Transfer& expected) {
    bool hit = true;
    const Transfer again = load(hit);
    EXPECT_FALSE(hit);
    EXPECT_TRUE(again.object == expected.object);
    EXPECT_TRUE(warnings_.all.empty());
    load(hit);
    EXPECT_TRUE(hit) << "the damaged file is replaced";
  }

  TempFolder folder_;
  Mesh mesh_ = sphere({0, 0, 1}, 1, 8);
  ReceiverGrid grid_{{-2, -2}, {3, 3}, 8, 9};
  TransferOptions options_;
  Warnings warnings_;
};

TEST_F(TransferCache, SecondTimeIsReadAndTheSame) {
  bool hit = true;
  const Transfer baked = load(hit);
  EXPECT_FALSE(hit);
  const Transfer read = load(hit);
  EXPECT_TRUE(hit);
  EXPECT_EQ(read.bands, baked.bands);
  EXPECT_TRUE(read.object == baked.object);
  EXPECT_TRUE(read.receiver == baked.receiver);
  EXPECT_EQ(read.receiver_unshadowed, baked.receiver_unshadowed);
  EXPECT_EQ(read.grid.columns, 8);
  EXPECT_EQ(read.grid.max_m, baked.grid.max_m);
}

TEST_F(TransferCache, LeavesNothingButTheFile) {
  bool hit;
  load(hit);
  const std::filesystem::directory_iterator files(folder_ / "cache");
  EXPECT_EQ(std::distance(begin(files), end(files)), 1);
}

TEST_F(TransferCache, KeyFollowsEverythingTheBakeDependsOn) {
  const auto key = [this] { return transfer_key(mesh_, grid_, options_); };
  std::vector<std::string> keys{key()};
  const auto changed = [&](auto& value, auto other) {
    const auto before = value;
    value = other;
    keys.push_back(key());
    value = before;
  };
  changed(mesh_.vertices[3].position_m.x, 0.123f);
  changed(mesh_.vertices[3].normal.x, 0.123f);
  changed(mesh_.vertices[3].color.x, 0.123f);
  changed(mesh_.indices[0], 9u);
  changed(mesh_.triangle_material[0], std::uint16_t{1});
  changed(mesh_.materials[0].base_color.x, 0.5f);
  changed(mesh_.materials[0].metallic, 0.5f);
  changed(grid_.columns, 9);
  changed(grid_.min_m.x, -2.5f);
  changed(options_.bands, 4);
  changed(options_.rays, 17);
  changed(options_.bounces, 1);
  changed(options_.seed, 2u);
  std::sort(keys.begin(), keys.end());
  EXPECT_EQ(std::unique(keys.begin(), keys.end()), keys.end());
}

TEST_F(TransferCache, KeyIgnoresWhatChangesNothing) {
  const std::string key = transfer_key(mesh_, grid_, options_);
  options_.threads = 7;
  mesh_.materials[0].name = "renamed";
  mesh_.materials[0].roughness = 0.1f;
  EXPECT_EQ(transfer_key(mesh_, grid_, options_), key);
  EXPECT_EQ(key.size(), 32u);
}

TEST_F(TransferCache, TruncatedFileIsBakedAnew) {
  bool hit;
  const Transfer baked = load(hit);
  std::filesystem::resize_file(file(), std::filesystem::file_size(file()) - 5);
  expect_rebaked(baked);
}

TEST_F(TransferCache, EmptyFileIsBakedAnew) {
  bool hit;
  const Transfer baked = load(hit);
  std::filesystem::resize_file(file(), 0);
  expect_rebaked(baked);
}

TEST_F(TransferCache, FileOfAnotherProgramIsBakedAnew) {
  bool hit;
  const Transfer baked = load(hit);
  write_text(file().string(), std::string(100000, 'x'));
  expect_rebaked(baked);
}

TEST_F(TransferCache, OneFlippedBitIsBakedAnew) {
  bool hit;
  const Transfer baked = load(hit);
  const std::string bytes = read_text(file().string());
  for (const std::size_t at : {std::size_t{1}, std::size_t{60}, bytes.size() / 2, bytes.size() - 1}) {
    std::string damaged = bytes;
    damaged[at] ^= 4;
    write_text(file().string(), damaged);
    expect_rebaked(baked);
  }
}

TEST_F(TransferCache, TrailingBytesAreBakedAnew) {
  bool hit;
  const Transfer baked = load(hit);
  std::ofstream(file(), std::ios::app) << "more";
  expect_rebaked(baked);
}

TEST_F(TransferCache, UnwritableFolderOnlyCostsAWarning) {
  write_text(folder_ / "taken", "a file where the folder should be");
  bool hit = true;
  const auto is_warned = [&](double) { EXPECT_EQ(warnings_.all.size(), 1u) << "before the bake, not after it"; };
  const Transfer transfer =
      load_or_bake_transfer(mesh_, grid_, options_, folder_ / "taken", is_warned, warnings_.handler(), &hit);
  EXPECT_FALSE(hit);
  EXPECT_FALSE(transfer.object.empty());
  ASSERT_EQ(warnings_.all.size(), 1u);
  EXPECT_NE(warnings_.all[0].find("taken"), std::string::npos);
}

}  // namespace
}  // namespace catchlight::render
