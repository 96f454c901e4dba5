#include <array>
#include <bit>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <type_traits>

#include "catchlight/error.hpp"
#include "catchlight/progress.hpp"
#include "catchlight/util/pending_file.hpp"
#include "render/transfer/transfer.hpp"

namespace catchlight::render {
namespace {

namespace fs = std::filesystem;

// Raise when the bake or the file changes: older files then no longer match.
constexpr std::uint32_t kFormatVersion = 5;
constexpr std::array<char, 8> kMagic{'C', 'L', 'T', 'R', 'A', 'N', 'S', 'F'};

// 128 bits out of two FNV-1a hashes over 64-bit words (Fowler, Noll & Vo) with different starts. Guards against accidents, not
// attacks.
class Hash {
 public:
  void add_bytes(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; i += 8) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes + i, std::min<std::size_t>(8, size - i));
      add_word(word);
    }
    add_word(size);
  }

  template <typename T>
  void add(const T& value) {
    static_assert(std::has_unique_object_representations_v<T> || std::is_same_v<T, float> || std::is_same_v<T, glm::vec3>);
    add_bytes(&value, sizeof value);
  }

  template <typename T>
  void add(const std::vector<T>& values) {
    add_bytes(values.data(), values.size() * sizeof(T));
  }

  std::array<std::uint64_t, 2> value() const { return state_; }

 private:
  void add_word(std::uint64_t word) {
    for (std::uint64_t& state : state_) {
      state = (state ^ word) * 0x100000001b3u;
      state ^= state >> 29;  // multiplication only carries upwards; whole words need their high bits brought down
    }
  }

  std::array<std::uint64_t, 2> state_{0xcbf29ce484222325u, 0x6c62272e07bb0142u};
};

void add_scene(Hash& hash, const Mesh& mesh) {
  static_assert(sizeof(Vertex) == 9 * sizeof(float), "vertices are hashed as they lie in memory");
  hash.add(mesh.vertices);
  hash.add(mesh.indices);
  hash.add(mesh.triangle_material);
  for (const Material& material : mesh.materials) {
    hash.add(material.base_color);
    hash.add(material.metallic);
  }
}

struct FileHeader {
  std::array<char, 8> magic = kMagic;
  std::array<char, 32> key{};
  std::int32_t bands = 0, columns = 0, rows = 0, unused = 0;
  std::array<float, 4> grid_m{};
  std::uint64_t object_count = 0, receiver_count = 0;
  std::array<std::uint64_t, 2> content{};  ///< hash of all that follows
};
static_assert(sizeof(FileHeader) == 104, "written as it lies in memory: no padding");

FileHeader header_for(const Transfer& transfer, const std::string& key) {
  FileHeader header;
  std::copy_n(key.begin(), header.key.size(), header.key.begin());
  header.bands = transfer.bands, header.columns = transfer.grid.columns, header.rows = transfer.grid.rows;
  header.grid_m = {transfer.grid.min_m.x, transfer.grid.min_m.y, transfer.grid.max_m.x, transfer.grid.max_m.y};
  header.object_count = transfer.object.size();
  header.receiver_count = transfer.receiver.size();
  Hash hash;
  hash.add(transfer.object);
  hash.add(transfer.object_direct);
  hash.add(transfer.receiver);
  hash.add(transfer.receiver_direct);
  hash.add(transfer.receiver_unshadowed);
  header.content = hash.value();
  return header;
}

template <typename T>
void read_into(std::istream& in, std::vector<T>& values) {
  in.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(T)));
}

template <typename T>
void write_from(std::ostream& out, const std::vector<T>& values) {
  out.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(T)));
}

// Empty unless the file is whole and made for exactly this key and these counts.
std::optional<Transfer> read_cached(const fs::path& file, const std::string& key, const Mesh& mesh, const ReceiverGrid& grid,
                                    int bands) {
  std::ifstream in(file, std::ios::binary);
  FileHeader header;
  if (!in.read(reinterpret_cast<char*>(&header), sizeof header)) return std::nullopt;
  const std::size_t count = static_cast<std::size_t>(bands) * bands;
  Transfer transfer{bands, {}, {}, grid, {}, {}, std::vector<float>(count)};
  const std::uint64_t object_count = mesh.vertices.size() * count;
  const std::uint64_t receiver_count = static_cast<std::uint64_t>(grid.columns) * grid.rows * count;
  if (header.magic != kMagic || std::string(header.key.begin(), header.key.end()) != key || header.object_count != object_count ||
      header.receiver_count != receiver_count) {
    return std::nullopt;
  }
  for (auto* values : {&transfer.object, &transfer.object_direct}) values->resize(object_count);
  for (auto* values : {&transfer.receiver, &transfer.receiver_direct}) values->resize(receiver_count);
  read_into(in, transfer.object);
  read_into(in, transfer.object_direct);
  read_into(in, transfer.receiver);
  read_into(in, transfer.receiver_direct);
  read_into(in, transfer.receiver_unshadowed);
  const FileHeader expected = header_for(transfer, key);
  if (!in || in.peek() != std::char_traits<char>::eof() || std::memcmp(&header, &expected, sizeof header) != 0)
    return std::nullopt;
  return transfer;
}

void write_cached(const fs::path& path, const std::string& key, const Transfer& transfer) {
  PendingFile file(path);
  std::ofstream out(file.pending_path(), std::ios::binary);
  const FileHeader header = header_for(transfer, key);
  out.write(reinterpret_cast<const char*>(&header), sizeof header);
  write_from(out, transfer.object);
  write_from(out, transfer.object_direct);
  write_from(out, transfer.receiver);
  write_from(out, transfer.receiver_direct);
  write_from(out, transfer.receiver_unshadowed);
  out.close();
  if (!out) throw Error(path.string() + ": cannot be written; is the disk full?");
  file.commit();
}

// Whether the work went through; a warning says why not.
template <class Work>
bool keep(Work work, const WarningHandler& warn) {
  try {
    work();
    return true;
  } catch (const std::runtime_error& error) {
    if (warn) warn(std::string("the baked light transfer cannot be kept for next time: ") + error.what());
    return false;
  }
}

void check_cache_folder(const fs::path& file) {
  fs::create_directories(file.parent_path());
  const PendingFile made_and_removed(file);
}

}  // namespace

std::string transfer_key(const Mesh& mesh_tag, const ReceiverGrid& grid, const TransferOptions& options) {
  Hash hash;
  hash.add(kFormatVersion);
  add_scene(hash, mesh_tag);
  for (const float value : {grid.min_m.x, grid.min_m.y, grid.max_m.x, grid.max_m.y}) hash.add(value);
  for (const int value : {grid.columns, grid.rows, options.bands, options.rays, options.bounces}) hash.add(value);
  hash.add(options.seed);
  hash.add(options.receiver_albedo.seen_from_m);
  hash.add(options.receiver_albedo.image.width);
  hash.add(options.receiver_albedo.image.data);
  std::array<char, 33> text;
  const auto value = hash.value();
  std::snprintf(text.data(), text.size(), "%016llx%016llx", static_cast<unsigned long long>(value[0]),
                static_cast<unsigned long long>(value[1]));
  return text.data();
}

Transfer load_or_bake_transfer(const Mesh& mesh_tag, const ReceiverGrid& grid, const TransferOptions& options,
                               const std::string& cache_folder, const ProgressHandler& progress, const WarningHandler& warn,
                               bool* cache_hit) {
  const std::string key = transfer_key(mesh_tag, grid, options);
  const fs::path file = fs::path(cache_folder.empty() ? default_cache_folder() : cache_folder) / (key + ".transfer");
  std::optional<Transfer> cached = read_cached(file, key, mesh_tag, grid, options.bands);
  if (cache_hit) *cache_hit = cached.has_value();
  if (cached) {
    if (progress) progress(1.0);
    return std::move(*cached);
  }
  const bool can_be_kept = keep([&] { check_cache_folder(file); }, warn);  // before the long work
  Transfer transfer = bake_transfer(mesh_tag, grid, options, progress);
  if (can_be_kept) keep([&] { write_cached(file, key, transfer); }, warn);
  return transfer;
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
