// What takes time to make, kept on disk for the next run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "catchlight/error.hpp"
#include "render/cache/content_hash.hpp"

namespace catchlight::render {

/// $XDG_CACHE_HOME/catchlight or ~/.cache/catchlight.
std::string default_cache_folder();

/// Passes a value's members to a file of the cache, or from it, in the order in which they are named.
class CacheStream {
 public:
  explicit CacheStream(std::ostream& out) : out_(&out) {}
  CacheStream(std::istream& in, std::uint64_t bytes) : in_(&in), left_(bytes) {}

  template <typename T>
  void operator()(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    pass(&value, sizeof value);
  }

  template <typename T, typename Allocator>
  void operator()(std::vector<T, Allocator>& values) {
    pass_count(values, sizeof(T));
    pass(values.data(), values.size() * sizeof(T));
  }

  /// Calls each(element) for elements with members of their own.
  template <typename T, typename Each>
  void for_each(std::vector<T>& values, const Each& each) {
    pass_count(values, 1);
    for (T& value : values) each(value);
  }

  /// Whether all was there that was asked for, and no more.
  bool is_whole() const { return !failed_ && left_ == 0; }
  std::uint64_t written() const { return written_; }
  std::array<std::uint64_t, 2> content() const { return hash_.value(); }

 private:
  template <typename Values>
  void pass_count(Values& values, std::size_t min_bytes_each) {
    std::uint64_t count = values.size();
    pass(&count, sizeof count);
    if (in_ && (failed_ || count > left_ / min_bytes_each)) count = 0, failed_ = true;
    if (in_) values.resize(count);
  }
  void pass(void* data, std::size_t size);

  std::ostream* out_ = nullptr;
  std::istream* in_ = nullptr;
  std::uint64_t left_ = 0, written_ = 0;
  bool failed_ = false;
  ContentHash hash_;
};

/// A folder of values by key. Entries that were not used for longest go where all together take more than the bound. A damaged or
/// foreign file counts as none. Several programs may share a folder.
class ContentCache {
 public:
  static constexpr std::uintmax_t kMaxBytes = std::uintmax_t{4} << 30;

  /// `folder` empty: default_cache_folder().
  explicit ContentCache(const std::string& folder, std::uintmax_t max_bytes = kMaxBytes);

  /// The value of that kind and key (32 hexadecimal digits, of all that it is made from and of the way it is made), or else what
  /// make() returns, which is kept. archive(stream, value) passes the value's members to a CacheStream. An unwritable folder only
  /// costs a warning, before make() is called. `was_cached` (optional) says whether the value was read.
  template <typename Value, typename Make, typename Archive>
  Value get(const std::string& kind, const std::string& key, const WarningHandler& warn, const Make& make, const Archive& archive,
            bool* was_cached = nullptr) const {
    Value value{};
    const Pass pass = [&](CacheStream& file) { archive(file, value); };
    const bool found = read(kind, key, pass);
    if (was_cached) *was_cached = found;
    if (found) return value;
    const bool can_be_kept = is_writable(kind, key, warn);
    value = make();
    if (can_be_kept) write(kind, key, pass, warn);
    return value;
  }

  /// Passes members to or from a stream.
  using Pass = std::function<void(CacheStream&)>;

  /// Reads an entry where there is one that is whole. False: the members hold anything.
  bool read(const std::string& kind, const std::string& key, const Pass& pass) const;

  /// Writes an entry, over another that may be there. An unwritable folder only costs a warning.
  void keep(const std::string& kind, const std::string& key, const Pass& pass, const WarningHandler& warn) const;

 private:
  std::filesystem::path file(const std::string& kind, const std::string& key) const;
  bool is_writable(const std::string& kind, const std::string& key, const WarningHandler& warn) const;
  void write(const std::string& kind, const std::string& key, const Pass& pass, const WarningHandler& warn) const;
  void remove_oldest(const std::filesystem::path& kept) const;

  std::filesystem::path folder_;
  std::uintmax_t max_bytes_;
};

/// The entries of a cache that are made from the same. Without a cache, none is found and none is kept.
class KeyedCache {
 public:
  KeyedCache() = default;
  /// `from`: the hash of all that they are made from, but for the way they are made.
  KeyedCache(ContentCache cache, const ContentHash& from) : cache_(std::move(cache)), from_(from) {}

  /// ContentCache::read and keep. `version` rises with the way the entry is made.
  bool read(const std::string& kind, std::uint32_t version, const ContentCache::Pass& pass) const {
    return cache_ && cache_->read(kind, key(version), pass);
  }
  void keep(const std::string& kind, std::uint32_t version, const ContentCache::Pass& pass) const {
    if (cache_) cache_->keep(kind, key(version), pass, {});
  }

 private:
  std::string key(std::uint32_t version) const {
    ContentHash hash = from_;
    hash.add(version);
    return hash.text();
  }

  std::optional<ContentCache> cache_;
  ContentHash from_;
};

}  // namespace catchlight::render
