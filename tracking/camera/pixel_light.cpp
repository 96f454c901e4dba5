#include "tracking/camera/pixel_light.hpp"

#include <array>
#include <limits>

#include "catchlight/plate.hpp"
#include "catchlight/projection.hpp"

namespace catchlight::tracking {

PixelLight pixel_light(const FrameImage& frame) {
  const PlateColor color = frame.color();
  const CodeView codes = frame.codes();
  return {codes, LightTable(color), glm::inverse(color.plate_from_rec709),
          clipping_linear(codes.is_real ? Plate::Format::rgb_f32 : Plate::Format::rgb_u8, color)};
}

namespace {

constexpr std::size_t kMaxSamples = 144;

/// What is looked at in one square: plain arrays, so that the loops over them are vectorised.
struct Samples {
  std::size_t count = 0;
  std::array<double, kMaxSamples> x_px, y_px;
  std::array<int, kMaxSamples> x, y;
  std::array<std::array<float, kMaxSamples>, 3> values;  ///< the decoder's samples, then codes, then light
};

/// Where the points are seen; false where one is not in front of the camera.
bool project(const CameraModel& camera, const RigidTransform& camera_from_plane, const PlaneSquare& square, int across,
             Samples& samples) {
  const double step_m = square.side_m / across;
  const glm::dvec3 first_m = camera_from_plane * glm::dvec3(square.low_m + step_m / 2, 0);
  const glm::dvec3 right_m = camera_from_plane.rotation[0] * step_m, up_m = camera_from_plane.rotation[1] * step_m;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (int row = 0; row < across; ++row) {
    const glm::dvec3 row_m = first_m + static_cast<double>(row) * up_m;
    for (int column = 0; column < across; ++column) {
      const glm::dvec3 point_m = row_m + static_cast<double>(column) * right_m;
      const double per_depth = 1 / point_m.z;
      samples.x_px[samples.count] = point_m.x * per_depth * camera.fx_px + camera.cx_px;
      samples.y_px[samples.count] = point_m.y * per_depth * camera.fy_px + camera.cy_px;
      nearest_m = std::min(nearest_m, point_m.z);
      ++samples.count;
    }
  }
  if (!(nearest_m > 0)) return false;
  for (std::size_t i = 0; camera.has_distortion() && i < samples.count; ++i) {
    const glm::dvec2 seen_px = distort_px(camera, {samples.x_px[i], samples.y_px[i]});
    samples.x_px[i] = seen_px.x, samples.y_px[i] = seen_px.y;
  }
  return true;
}

/// The pixels that the points are in; false where one is beyond the picture.
bool round_to_pixels(int width_px, int height_px, Samples& samples) {
  bool is_inside = true;
  for (std::size_t i = 0; i < samples.count; ++i) {
    const double x = samples.x_px[i] + 0.5, y = samples.y_px[i] + 0.5;
    is_inside &= x >= 0 && y >= 0 && x < width_px && y < height_px;
  }
  if (!is_inside) return false;
  for (std::size_t i = 0; i < samples.count; ++i) {
    samples.x[i] = static_cast<int>(samples.x_px[i] + 0.5);
    samples.y[i] = static_cast<int>(samples.y_px[i] + 0.5);
  }
  return true;
}

/// As PixelLight::at() does for one pixel.
void read_light(const PixelLight& light, Samples& samples) {
  const CodeView& codes = light.codes;
  auto& [first, second, third] = samples.values;
  const int shift_x = codes.block_shift.x, shift_y = codes.block_shift.y;
  for (std::size_t i = 0; i < samples.count; ++i) {
    const int x = samples.x[i], y = samples.y[i];
    first[i] = codes.samples[0].at(x, y);
    second[i] = codes.samples[1].at(x >> shift_x, y >> shift_y);
    third[i] = codes.samples[2].at(x >> shift_x, y >> shift_y);
  }
  const glm::mat3& rgb = codes.rgb_from_samples;
  const glm::vec3& zeros = codes.rgb_of_zeros;
  const float least = codes.is_real ? -std::numeric_limits<float>::infinity() : 0.0f;
  const float most = codes.is_real ? std::numeric_limits<float>::infinity() : 1.0f;
  for (std::size_t i = 0; i < samples.count; ++i) {
    const float a = first[i], b = second[i], c = third[i];
    first[i] = std::clamp(rgb[0][0] * a + rgb[1][0] * b + rgb[2][0] * c + zeros[0], least, most);
    second[i] = std::clamp(rgb[0][1] * a + rgb[1][1] * b + rgb[2][1] * c + zeros[1], least, most);
    third[i] = std::clamp(rgb[0][2] * a + rgb[1][2] * b + rgb[2][2] * c + zeros[2], least, most);
  }
  for (int channel = 0; channel < 3; ++channel)
    for (std::size_t i = 0; i < samples.count; ++i) {
      float& value = samples.values[static_cast<std::size_t>(channel)][i];
      value = light.light_of_code(value, channel);
    }
}

}  // namespace

std::optional<SquareLight> square_light(const PixelLight& light, const CameraModel& camera,
                                        const RigidTransform& camera_from_plane, const PlaneSquare& square, int across) {
  Samples samples;
  if (!project(camera, camera_from_plane, square, across, samples)) return std::nullopt;
  if (!round_to_pixels(light.codes.width_px, light.codes.height_px, samples)) return std::nullopt;
  SquareLight seen;
  seen.samples = static_cast<int>(samples.count);
  read_light(light, samples);
  for (std::size_t i = 0; i < samples.count; ++i) {
    const glm::vec3 rgb = light.rec709_from_frame * glm::vec3(samples.values[0][i], samples.values[1][i], samples.values[2][i]);
    seen.mean += glm::dvec3(rgb);
    for (int c = 0; c < 3; ++c) seen.clipped[c] += rgb[c] >= light.clipping_linear[c];
  }
  seen.mean /= seen.samples;
  return seen;
}

}  // namespace catchlight::tracking
