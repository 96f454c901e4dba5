#include "catchlight/response.hpp"

#include "catchlight/color.hpp"

namespace catchlight {

double linear_from_code(TransferFunction transfer, double code) {
  switch (transfer) {
    case TransferFunction::srgb:
      return linear_from_srgb(code);
    case TransferFunction::linear:
      return code;
    case TransferFunction::gamma22:
      return std::pow(std::max(code, 0.0), 2.2);
    case TransferFunction::gamma28:
      return std::pow(std::max(code, 0.0), 2.8);
    case TransferFunction::pq: {
      const double root = std::pow(std::max(code, 0.0), 32.0 / 2523.0);
      return std::pow(std::max(root - 0.8359375, 0.0) / (18.8515625 - 18.6875 * root), 16384.0 / 2610.0) * 10000.0 / 203.0;
    }
    case TransferFunction::hlg: {
      const double e = std::max(code, 0.0);
      const double scene = e <= 0.5 ? e * e / 3.0 : (std::exp((e - 0.55991073) / 0.17883277) + 0.28466892) / 12.0;
      return scene / 0.26496256;  // code 0.75 is reference white
    }
  }
  return code;
}

double code_from_linear(TransferFunction transfer, double linear) {
  const double light = std::max(linear, 0.0);
  switch (transfer) {
    case TransferFunction::srgb:
      return srgb_from_linear(linear);
    case TransferFunction::linear:
      return linear;
    case TransferFunction::gamma22:
      return std::pow(light, 1 / 2.2);
    case TransferFunction::gamma28:
      return std::pow(light, 1 / 2.8);
    case TransferFunction::pq: {
      const double root = std::pow(light * 203.0 / 10000.0, 2610.0 / 16384.0);
      return std::pow((0.8359375 + 18.8515625 * root) / (1 + 18.6875 * root), 2523.0 / 32.0);
    }
    case TransferFunction::hlg: {
      const double scene = light * 0.26496256;
      return scene <= 1.0 / 12 ? std::sqrt(3 * scene) : 0.17883277 * std::log(12 * scene - 0.28466892) + 0.55991073;
    }
  }
  return linear;
}

}  // namespace catchlight
