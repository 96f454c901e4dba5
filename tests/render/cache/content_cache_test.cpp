#include "render/cache/content_cache.hpp"
#include "tests/support/test_files.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <cstdlib>

namespace catchlight::render {
namespace {

using Numbers = std::vector<float>;

const std::string kKeys[] = {std::string(32, '0'), std::string(32, '1'), std::string(32, 'a')};

void archive(CacheStream& file, Numbers& numbers) {
  file(numbers);
}

class ContentCaches : public testing::Test {
 protected:
  /// Whether the numbers came from the cache.
  bool is_cached(const ContentCache& cache, const std::string& key, const Numbers& numbers, const std::string& kind = "numbers") {
    bool was_cached = false;
    EXPECT_EQ(cache.get<Numbers>(
                  kind, key, warnings_.handler(), [&] { return numbers; }, archive, &was_cached),
              numbers);
    return was_cached;
  }

  std::filesystem::path file(const std::string& key) const { return folder_ / ("cache/" + key + ".numbers"); }

  /// As if the entry had last been used so long ago.
  void age(const std::string& key, int hours) const {
    std::filesystem::last_write_time(file(key), std::filesystem::file_time_type::clock::now() - std::chrono::hours(hours));
  }

  TempFolder folder_;
  Warnings warnings_;
};

TEST_F(ContentCaches, KeepValuesByKindAndKey) {
  const ContentCache cache(folder_ / "cache");
  EXPECT_FALSE(is_cached(cache, kKeys[0], {1, 2, 3}));
  EXPECT_FALSE(is_cached(cache, kKeys[1], {}));
  EXPECT_FALSE(is_cached(cache, kKeys[0], {7}, "others"));
  EXPECT_TRUE(is_cached(cache, kKeys[0], {1, 2, 3}));
  EXPECT_TRUE(is_cached(cache, kKeys[1], {}));
  EXPECT_TRUE(is_cached(ContentCache(folder_ / "cache"), kKeys[0], {7}, "others"));
  EXPECT_TRUE(warnings_.all.empty());
}

TEST_F(ContentCaches, KeepMembersOfMembers) {
  using Lists = std::vector<Numbers>;
  const ContentCache cache(folder_ / "cache");
  const Lists lists{{1, 2}, {}, {3}};
  const auto archive_lists = [](CacheStream& out, Lists& all) { out.for_each(all, [&](Numbers& numbers) { out(numbers); }); };
  for (const bool expected : {false, true}) {
    bool was_cached = !expected;
    EXPECT_EQ(cache.get<Lists>(
                  "lists", kKeys[0], {}, [&] { return lists; }, archive_lists, &was_cached),
              lists);
    EXPECT_EQ(was_cached, expected);
  }
}

TEST_F(ContentCaches, LoseWhatWasNotUsedForLongestWhereTheyAreFull) {
  const Numbers large(1000);  // 4 kB: two of them fit
  const ContentCache cache(folder_ / "cache", 10'000);
  is_cached(cache, kKeys[0], large);
  is_cached(cache, kKeys[1], large);
  age(kKeys[0], 2), age(kKeys[1], 1);
  EXPECT_TRUE(is_cached(cache, kKeys[0], large));  // used again: the other is the oldest now
  write_text(folder_ / "cache/notes.txt", std::string(20'000, 'x'));
  EXPECT_FALSE(is_cached(cache, kKeys[2], large));
  EXPECT_TRUE(std::filesystem::exists(file(kKeys[0])));
  EXPECT_FALSE(std::filesystem::exists(file(kKeys[1])));
  EXPECT_TRUE(std::filesystem::exists(file(kKeys[2])));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "cache/notes.txt")) << "no entry: it is left alone, and does not count";
}

TEST_F(ContentCaches, KeepOneEntryThatIsLargerThanTheBound) {
  const ContentCache cache(folder_ / "cache", 100);
  EXPECT_FALSE(is_cached(cache, kKeys[0], Numbers(1000)));
  EXPECT_TRUE(is_cached(cache, kKeys[0], Numbers(1000)));
}

TEST_F(ContentCaches, MakeAnewWhatIsDamagedAnywhere) {
  const ContentCache cache(folder_ / "cache");
  is_cached(cache, kKeys[0], {1, 2, 3});
  const std::string whole = read_text(file(kKeys[0]).string());
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string damaged = whole;
    damaged[at] ^= 0x40;
    write_text(file(kKeys[0]).string(), damaged);
    EXPECT_FALSE(is_cached(cache, kKeys[0], {1, 2, 3})) << at;
    write_text(file(kKeys[0]).string(), whole.substr(0, at));
    EXPECT_FALSE(is_cached(cache, kKeys[0], {1, 2, 3})) << at;
  }
  write_text(file(kKeys[0]).string(), whole + "x");
  EXPECT_FALSE(is_cached(cache, kKeys[0], {1, 2, 3}));
  EXPECT_TRUE(is_cached(cache, kKeys[0], {1, 2, 3}));
}

TEST(ContentHashes, FollowEveryByteAndTheLength) {
  std::vector<std::string> texts;
  for (const std::vector<unsigned char>& bytes :
       {std::vector<unsigned char>{}, {0}, {0, 0}, {1}, {0, 1}, {1, 0}, {0, 0, 0, 0, 0, 0, 0, 1, 0}, {0, 0, 0, 0, 0, 0, 0, 1}}) {
    ContentHash hash;
    hash.add(bytes);
    texts.push_back(hash.text());
    EXPECT_EQ(texts.back().size(), 32u);
  }
  std::ranges::sort(texts);
  EXPECT_EQ(std::ranges::unique(texts).begin(), texts.end());
}

TEST(DefaultCacheFolder, FollowsTheXdgRule) {
  const std::string before = std::getenv("XDG_CACHE_HOME") ? std::getenv("XDG_CACHE_HOME") : "";
  setenv("XDG_CACHE_HOME", "/somewhere", 1);
  EXPECT_EQ(default_cache_folder(), "/somewhere/catchlight");
  unsetenv("XDG_CACHE_HOME");
  EXPECT_EQ(default_cache_folder(), std::string(std::getenv("HOME")) + "/.cache/catchlight");
  if (!before.empty()) setenv("XDG_CACHE_HOME", before.c_str(), 1);
}

}  // namespace
}  // namespace catchlight::render
