// Many rays that are asked for at once, as arrays: Embree takes several of them through its hierarchy together.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace catchlight::render {

struct RayStream {
  static constexpr std::uint32_t kNothing = 0xffffffffu;

  std::vector<float> origin_x_m, origin_y_m, origin_z_m;
  std::vector<float> direction_x, direction_y, direction_z;
  std::vector<float> near, far;  ///< the part of the ray that counts, in lengths of its direction
  // What closest_hits() finds. `far` is then where the ray meets the triangle.
  std::vector<std::uint32_t> triangle;              ///< kNothing where it meets none
  std::vector<float> u, v;                          ///< barycentric weights of corners 1 and 2
  std::vector<float> normal_x, normal_y, normal_z;  ///< of the triangle, any length, out of the side where corners wind
                                                    ///< counter-clockwise
  std::vector<std::uint32_t> geometry;              ///< Embree's own

  std::size_t size() const { return near.size(); }

  /// Changes how many rays there are. New ones are to be set.
  void resize(std::size_t rays) {
    for (auto* lane : {&origin_x_m, &origin_y_m, &origin_z_m, &direction_x, &direction_y, &direction_z, &near, &far, &u, &v,
                       &normal_x, &normal_y, &normal_z})
      lane->resize(rays);
    triangle.resize(rays), geometry.resize(rays);
  }

  void set(std::size_t ray, const glm::vec3& origin_m, const glm::vec3& direction, float from, float to) {
    origin_x_m[ray] = origin_m.x, origin_y_m[ray] = origin_m.y, origin_z_m[ray] = origin_m.z;
    direction_x[ray] = direction.x, direction_y[ray] = direction.y, direction_z[ray] = direction.z;
    near[ray] = from, far[ray] = to;
  }

  glm::vec3 origin_m(std::size_t ray) const { return {origin_x_m[ray], origin_y_m[ray], origin_z_m[ray]}; }
  glm::vec3 direction(std::size_t ray) const { return {direction_x[ray], direction_y[ray], direction_z[ray]}; }
  bool meets(std::size_t ray) const { return triangle[ray] != kNothing; }

  /// Whether the ray met the side where the corners wind counter-clockwise.
  bool is_front_facing(std::size_t ray) const {
    return normal_x[ray] * direction_x[ray] + normal_y[ray] * direction_y[ray] + normal_z[ray] * direction_z[ray] < 0;
  }
};

}  // namespace catchlight::render
