// What takes time to make, kept on disk for the next run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>
#include <type_traits>
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

  template <typename T>
  void operator()(std::vector<T>& values) {
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
  template <typename T>
  void pass_count(std::vector<T>& values, std::size_t min_bytes_each) {
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
    const bool found = read(kind, key, [&](CacheStream& file) { archive(file, value); });
    if (was_cached) *was_cached = found;
    if (found) return value;
    const bool can_be_kept = is_writable(kind, key, warn);
    value = make();
    if (can_be_kept)
      write(
          kind, key, [&](CacheStream& file) { archive(file, value); }, warn);
    return value;
  }

 private:
  using Pass = std::function<void(CacheStream&)>;
  std::filesystem::path file(const std::string& kind, const std::string& key) const;
  bool read(const std::string& kind, const std::string& key, const Pass& pass) const;
  bool is_writable(const std::string& kind, const std::string& key, const WarningHandler& warn) const;
  void write(const std::string& kind, const std::string& key, const Pass& pass, const WarningHandler& warn) const;
  void remove_oldest(const std::filesystem::path& kept) const;

  std::filesystem::path folder_;
  std::uintmax_t max_bytes_;
};

}  // namespace catchlight::render
