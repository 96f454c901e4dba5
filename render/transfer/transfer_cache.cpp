#include "catchlight/error.hpp"
#include "catchlight/progress.hpp"
#include "render/cache/content_cache.hpp"
#include "render/mesh/base_color.hpp"
#include "render/transfer/transfer.hpp"

namespace catchlight::render {
namespace {

// Raise when the bake or its members change: older files then no longer match.
constexpr std::uint32_t kVersion = 8;

void add_scene(ContentHash& hash, const Mesh& mesh) {
  static_assert(sizeof(Vertex) == 9 * sizeof(float), "vertices are hashed as they lie in memory");
  hash.add(mesh.vertices);
  hash.add(mesh.indices);
  hash.add(mesh.triangle_material);
  for (const Material& material : mesh.materials) {
    hash.add(material.base_color);
    hash.add(material.metallic);
  }
  if (mesh.has_textures()) hash.add(vertex_diffuse_albedos(mesh));
}

void archive(CacheStream& file, Transfer& transfer) {
  file(transfer.bands);
  file(transfer.object);
  file(transfer.object_direct);
  file(transfer.grid);
  file(transfer.receiver);
  file(transfer.receiver_direct);
  file(transfer.receiver_unshadowed);
}

}  // namespace

std::string transfer_key(const Mesh& mesh_tag, const ReceiverGrid& grid, const TransferOptions& options) {
  ContentHash hash;
  hash.add(kVersion);
  add_scene(hash, mesh_tag);
  for (const float value : {grid.min_m.x, grid.min_m.y, grid.max_m.x, grid.max_m.y}) hash.add(value);
  for (const int value : {grid.columns, grid.rows, options.bands, options.rays, options.bounces}) hash.add(value);
  hash.add(options.seed);
  hash.add(options.receiver_albedo.seen_from_m);
  hash.add(options.receiver_albedo.image.width);
  hash.add(options.receiver_albedo.image.data);
  return hash.text();
}

Transfer load_or_bake_transfer(const Mesh& mesh_tag, const ReceiverGrid& grid, const TransferOptions& options,
                               const std::string& cache_folder, const ProgressHandler& progress, const WarningHandler& warn,
                               bool* cache_hit) {
  bool was_cached = false;
  Transfer transfer = ContentCache(cache_folder)
                          .get<Transfer>(
                              "transfer", transfer_key(mesh_tag, grid, options), warn,
                              [&] { return bake_transfer(mesh_tag, grid, options, progress); }, archive, &was_cached);
  if (was_cached && progress) progress(1.0);
  if (cache_hit) *cache_hit = was_cached;
  return transfer;
}

}  // namespace catchlight::render
