// A light probe as a function of direction and as a density of directions that finds its lights.
//
// Radiance is bilinear between texel centres of a latlong picture. A cell, between four centres, is chosen by its luminance times
// its solid angle, the place in it by its bilinear luminance: what is drawn is nearly proportional to what there is, a sun of one
// texel included.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "catchlight/image.hpp"
#include "render/probe/probe.hpp"

namespace catchlight::render::reference {

struct LightSample {
  glm::dvec3 direction_tag, radiance;
  double density;  ///< per steradian, > 0
};

class ProbeSampler {
 public:
  /// `only_above`: directions with tag z < 0 are not drawn (cells across the horizon are). Layouts other than latlong are
  /// converted.
  ProbeSampler(const Probe& probe, const glm::dmat3& tag_from_probe, bool only_above);

  glm::dvec3 radiance(const glm::dvec3& direction_tag) const;

  /// The sample drawn by a place of `square`, [0, 1)^2. Empty where there is no light at all.
  std::optional<LightSample> sample(const glm::dvec2& square) const;

  /// The density with which sample() draws a direction, 0 where it never does.
  double density(const glm::dvec3& direction_tag) const;

  /// Irradiance of the whole light on a surface with that normal, by quadrature of the same function; no sampling noise.
  glm::dvec3 irradiance(const glm::dvec3& normal_tag) const;

 private:
  struct Cell {
    int x, y;        ///< the cell's first texel
    double s, t;     ///< place between the centres, 0 to 1
    double cos_lat;  ///< cosine of the latitude there
  };
  Cell cell_of(const glm::dvec3& direction_tag) const;
  glm::dvec3 direction_of(const Cell& cell) const;
  glm::dvec3 texel(int x, int y) const;
  glm::dvec3 radiance_in(const Cell& cell) const;
  double density_in(const Cell& cell) const;
  double cell_weight(int x, int y, bool only_above) const;

  int columns() const { return image_.width - 1; }
  int rows() const { return image_.height - 1; }
  const float* row_of_cells(int y) const { return &cell_cdf_[static_cast<std::size_t>(y) * (columns() + 1)]; }

  Image image_;  ///< latlong
  glm::dmat3 tag_from_probe_;
  std::vector<double> row_cdf_;  ///< rows() + 1, from 0 to 1; empty where all is black
  std::vector<float> cell_cdf_;  ///< columns() + 1 a row, from 0 to 1
};

}  // namespace catchlight::render::reference
