#include "render/reference/path_tracer.hpp"

#include "catchlight/error.hpp"
#include "catchlight/util/parallel.hpp"

namespace catchlight::render::reference {
namespace {

constexpr std::size_t kPointsPerTask = 16;

const TraceOptions& checked(const TraceOptions& options) {
  if (options.samples < 1) throw Error("reference: " + std::to_string(options.samples) + " samples: expected at least 1");
  if (options.bounces < 0) throw Error("reference: " + std::to_string(options.bounces) + " bounces: expected 0 or more");
  return options;
}

void store(Image& image, int x, int y, const glm::dvec3& value) {
  for (int c = 0; c < 3; ++c) image.pixel(x, y)[c] = static_cast<float>(value[c]);
}

// Mean over the samples of trace(i, points) for every i < count.
template <typename Trace>
std::vector<glm::dvec3> means(std::size_t count, const TraceOptions& options, const ProgressHandler& progress,
                              const Trace& trace) {
  std::vector<glm::dvec3> result(count, glm::dvec3(0));
  const auto run = [&](std::size_t task) {
    for (std::size_t i = task * kPointsPerTask; i < std::min(count, (task + 1) * kPointsPerTask); ++i) {
      const std::uint32_t seed = mix_bits(options.seed ^ mix_bits(static_cast<std::uint32_t>(i)));
      for (int k = 0; k < options.samples; ++k) result[i] += trace(i, PointStream(seed, k)) / double(options.samples);
    }
  };
  parallel_for((count + kPointsPerTask - 1) / kPointsPerTask, options.threads, run, progress);
  return result;
}

}  // namespace

PathTracer::PathTracer(ReferenceScene scene, const TraceOptions& options)
    : scene_(std::move(scene)), options_(checked(options)), paths_(scene_, options.bounces) {}

ReferencePicture PathTracer::render(const CameraModel& camera, const RigidTransform& camera_from_tag,
                                    const ProgressHandler& progress) const {
  const int width = camera.width_px, height = camera.height_px;
  const CameraRays rays(camera, camera_from_tag);
  ReferencePicture picture{Image(width, height), Image(width, height)};
  const auto trace_row = [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < width; ++x) {
      const std::uint32_t seed = mix_bits(options_.seed ^ mix_bits(static_cast<std::uint32_t>(y) * width + x));
      glm::dvec3 object(0), kept(0);
      for (int k = 0; k < options_.samples; ++k) {
        PointStream points(seed, k);
        const glm::dvec2 pixel = glm::dvec2(x, y) + points.next() - 0.5;
        const Seen seen = paths_.look(rays.origin_tag_m(), rays.direction_tag(pixel), points);
        object += seen.object;
        kept += seen.kept;
      }
      store(picture.object, x, y, object / double(options_.samples));
      store(picture.kept, x, y, kept / double(options_.samples));
    }
  };
  parallel_for(height, options_.threads, trace_row, progress);
  return picture;
}

std::vector<glm::dvec3> PathTracer::exit_radiance(std::span<const MattePoint> points, const ProgressHandler& progress) const {
  return means(points.size(), options_, progress,
               [&](std::size_t i, PointStream stream) { return paths_.exit_radiance(points[i], stream); });
}

std::vector<glm::dvec3> PathTracer::receiver_ratio(std::span<const glm::dvec2> points_m, const ProgressHandler& progress) const {
  return means(points_m.size(), options_, progress,
               [&](std::size_t i, PointStream stream) { return paths_.receiver_ratio(points_m[i], stream); });
}

std::vector<MattePoint> matte_vertices(const Mesh& mesh) {
  std::vector<MattePoint> points;
  for (const Vertex& vertex : mesh.vertices) points.push_back({vertex.position_m, vertex.normal, glm::dvec3(0)});
  for (std::size_t i = mesh.indices.size(); i-- > 0;) {  // backwards: the first triangle has the last word
    const Material& material = mesh.materials[mesh.triangle_material[i / 3]];
    const Vertex& vertex = mesh.vertices[mesh.indices[i]];
    points[mesh.indices[i]].albedo = glm::dvec3(material.base_color * vertex.color) * (1.0 - material.metallic);
  }
  return points;
}

}  // namespace catchlight::render::reference
