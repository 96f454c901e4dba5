#include "catchlight/light_table.hpp"

#include <array>

namespace catchlight {

LightTable::LightTable(const CameraResponse& response) : response_(response) {
  using enum TransferFunction;
  static const std::array<std::vector<float>, 6> tables{tabulated(srgb),    tabulated(linear), tabulated(gamma22),
                                                        tabulated(gamma28), tabulated(pq),     tabulated(hlg)};
  light_ = &tables[static_cast<std::size_t>(response.transfer)];
}

std::vector<float> LightTable::tabulated(TransferFunction transfer) {
  std::vector<float> light;
  for (int step = 0; step <= kSteps; ++step)
    light.push_back(static_cast<float>(linear_from_code(transfer, step / double{kSteps})));
  return light;
}

}  // namespace catchlight
