// Precomputed radiance transfer (Sloan, Kautz & Snyder 2002): how much of each SH lighting coefficient leaves each vertex of the
// object, and arrives at each point of the receiver, with shadows and interreflection. Baked with Embree; no GL.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "catchlight/error.hpp"
#include "catchlight/progress.hpp"
#include "render/mesh/mesh.hpp"
#include "render/transfer/receiver_grid.hpp"
#include "render/transfer/transfer_options.hpp"

namespace catchlight::render {

/// What bake_transfer makes, all in the tag frame. Vertex v's irradiance / pi per channel = sum_i light_i * object[v * n^2 + i]:
/// times the diffuse albedo of a place on the surface, it is the radiance that leaves it. 0 where nothing is diffuse. Receiver
/// point p's irradiance relative to the unshadowed one = dot(light, receiver[p]) / dot(light, receiver_unshadowed): that ratio
/// multiplies the real surface (Debevec 1998); receiver values are normalised for a white (albedo 1) surface.
struct Transfer {
  int bands = 0;
  std::vector<glm::vec3> object;         ///< vertices * bands^2
  std::vector<glm::vec3> object_direct;  ///< the part of it that met no other surface
  ReceiverGrid grid;
  std::vector<glm::vec3> receiver;         ///< rows * columns * bands^2, row-major from min
  std::vector<glm::vec3> receiver_direct;  ///< the part of it that met no other surface
  std::vector<float> receiver_unshadowed;  ///< bands^2, the closed form for normal +z
};

/// `mesh_tag` is in the tag frame. Values are the closed form of the open hemisphere less the occluded rays, so exact where
/// nothing is in the way. Faces block light from either side, and send it back (with bounces) from their front. Where the
/// receiver's albedo is known, vertices below its plane (a sunk object) are lit as if on it. Rays follow the vertex normal's
/// hemisphere: where that dips into the solid they are blocked. The receiver's shadow fades to nothing over the grid's outer 4
/// cells; points covered by the object take their neighbours' values. Throws Error for a mesh without triangles or options out of
/// range (1 to 10 bands, 1 ray or more).
Transfer bake_transfer(const Mesh& mesh_tag, const ReceiverGrid& grid, const TransferOptions& options,
                       const ProgressHandler& progress);

/// Key of everything the bake depends on (geometry, materials, grid, options, version): a hexadecimal string.
std::string transfer_key(const Mesh& mesh_tag, const ReceiverGrid& grid, const TransferOptions& options);

/// bake_transfer behind a cache (ContentCache) in that folder. `cache_hit` (optional) says whether it was read.
Transfer load_or_bake_transfer(const Mesh& mesh_tag, const ReceiverGrid& grid, const TransferOptions& options,
                               const std::string& cache_folder, const ProgressHandler& progress, const WarningHandler& warn,
                               bool* cache_hit = nullptr);

}  // namespace catchlight::render
