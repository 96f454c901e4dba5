#include "render/cache/content_cache.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "catchlight/util/pending_file.hpp"

namespace catchlight::render {
namespace {

namespace fs = std::filesystem;

constexpr std::array<char, 8> kMagic{'C', 'L', 'C', 'A', 'C', 'H', 'E', '1'};
constexpr std::size_t kKeyDigits = 32;

struct FileHeader {
  std::array<char, 8> magic = kMagic;
  std::array<char, kKeyDigits> key{};
  std::uint64_t bytes = 0;                 ///< of all that follows
  std::array<std::uint64_t, 2> content{};  ///< its hash
};
static_assert(sizeof(FileHeader) == 64, "written as it lies in memory: no padding");

FileHeader header_for(const std::string& key, std::uint64_t bytes, const std::array<std::uint64_t, 2>& content) {
  FileHeader header;
  std::copy_n(key.begin(), kKeyDigits, header.key.begin());
  header.bytes = bytes;
  header.content = content;
  return header;
}

bool is_entry(const fs::path& file) {
  const std::string digits = file.stem();
  return digits.size() == kKeyDigits && digits.find_first_not_of("0123456789abcdef") == std::string::npos;
}

// Whether the work went through; a warning says why not, the same whatever was to be kept.
template <class Work>
bool succeeds(const Work& work, const WarningHandler& warn) {
  const auto refuse = [&](const std::string& why) {
    if (warn)
      warn("what was made for this scene cannot be kept for next time: " + why +
           "; make room there, or name a folder for it by XDG_CACHE_HOME");
  };
  try {
    work();
    return true;
  } catch (const fs::filesystem_error& error) {
    refuse(error.path1().string() + ": " + error.code().message());
  } catch (const std::runtime_error& error) {
    refuse(error.what());
  }
  return false;
}

}  // namespace

void CacheStream::pass(void* data, std::size_t size) {
  if (failed_ || size == 0) return;
  if (out_) {
    out_->write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
    written_ += size;
  } else {
    failed_ = size > left_ || !in_->read(static_cast<char*>(data), static_cast<std::streamsize>(size));
    left_ -= failed_ ? 0 : size;
  }
  hash_.add_bytes(data, size);
}

ContentCache::ContentCache(const std::string& folder, std::uintmax_t max_bytes)
    : folder_(folder.empty() ? default_cache_folder() : folder), max_bytes_(max_bytes) {}

fs::path ContentCache::file(const std::string& kind, const std::string& key) const {
  return folder_ / (key + "." + kind);
}

bool ContentCache::read(const std::string& kind, const std::string& key, const Pass& pass) const {
  const fs::path path = file(kind, key);
  std::ifstream in(path, std::ios::binary);
  FileHeader header;
  if (!in.read(reinterpret_cast<char*>(&header), sizeof header)) return false;
  std::error_code unknown;
  if (header.bytes + sizeof header != fs::file_size(path, unknown)) return false;
  CacheStream stream(in, header.bytes);
  pass(stream);
  const FileHeader expected = header_for(key, header.bytes, stream.content());
  if (!stream.is_whole() || std::memcmp(&header, &expected, sizeof header) != 0) return false;
  fs::last_write_time(path, fs::file_time_type::clock::now(), unknown);  // used last
  return true;
}

bool ContentCache::is_writable(const std::string& kind, const std::string& key, const WarningHandler& warn) const {
  const auto make_and_remove = [&] {
    fs::create_directories(folder_);
    const PendingFile made_and_removed(file(kind, key));
  };
  return succeeds(make_and_remove, warn);
}

void ContentCache::write(const std::string& kind, const std::string& key, const Pass& pass, const WarningHandler& warn) const {
  const auto write_all = [&] {
    const fs::path path = file(kind, key);
    PendingFile pending(path);
    std::ofstream out(pending.pending_path(), std::ios::binary);
    const FileHeader room;
    out.write(reinterpret_cast<const char*>(&room), sizeof room);
    CacheStream stream(out);
    pass(stream);
    const FileHeader header = header_for(key, stream.written(), stream.content());
    out.seekp(0);
    out.write(reinterpret_cast<const char*>(&header), sizeof header);
    out.close();
    if (!out) throw Error(path.string() + ": cannot be written; is the disk full?");
    pending.commit();
    remove_oldest(path);
  };
  succeeds(write_all, warn);
}

void ContentCache::keep(const std::string& kind, const std::string& key, const Pass& pass, const WarningHandler& warn) const {
  if (is_writable(kind, key, warn)) write(kind, key, pass, warn);
}

void ContentCache::remove_oldest(const fs::path& kept) const {
  struct Entry {
    fs::path path;
    fs::file_time_type used;
    std::uintmax_t bytes;
  };
  std::vector<Entry> entries;
  std::uintmax_t total = 0;
  std::error_code gone;  // another program may have removed an entry meanwhile
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
    if (!is_entry(entry.path()) || !entry.is_regular_file(gone)) continue;
    const std::uintmax_t bytes = entry.file_size(gone);
    if (gone) continue;
    entries.push_back({entry.path(), entry.last_write_time(gone), bytes});
    total += bytes;
  }
  std::ranges::sort(entries, {}, &Entry::used);
  for (const Entry& entry : entries) {
    if (total <= max_bytes_) return;
    if (entry.path == kept) continue;
    fs::remove(entry.path, gone);
    total -= entry.bytes;
  }
}

std::string default_cache_folder() {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return std::string(value ? value : "");
  };
  if (const std::string cache = variable("XDG_CACHE_HOME"); !cache.empty()) return cache + "/catchlight";
  if (const std::string home = variable("HOME"); !home.empty()) return home + "/.cache/catchlight";
  return (fs::temp_directory_path() / "catchlight-cache").string();
}

}  // namespace catchlight::render
