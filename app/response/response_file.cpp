#include "app/response/response_file.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>

#include "app/response/response_points.hpp"
#include "catchlight/response.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::app {
namespace {

constexpr const char* kExpected = "\"footage\", \"srgb\", \"linear\", \"gamma:2.4\", or a file .yaml, .yml, .xml, .csv or .cube";

/// Exact at every code of 8 and of 16 bits.
ResponseCurve gamma_curve(double exponent) {
  constexpr int kCodes = 65536;
  ResponseCurve::Tables tables;
  for (auto& light : tables)
    for (int code = 0; code < kCodes; ++code)
      light.push_back(static_cast<float>(std::pow(code / static_cast<double>(kCodes - 1), exponent)));
  return ResponseCurve(std::move(tables));
}

CameraResponse gamma_response(const std::string& name) {
  const std::optional<double> exponent = real_from_text(std::string_view(name).substr(6));
  // Beyond 3, the first codes' light is less than single floats hold.
  if (!exponent || !(*exponent >= 0.2 && *exponent <= 3))
    throw Error("exposure.response is \"" + name + "\"; expected gamma:X with X from 0.2 to 3, such as gamma:2.4");
  return {TransferFunction::srgb, std::make_shared<ResponseCurve>(gamma_curve(*exponent))};
}

std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(path + ": cannot be opened; exposure.response expects " + std::string(kExpected));
  std::ostringstream buffer;
  buffer << file.rdbuf();
  return buffer.str();
}

}  // namespace

std::optional<CameraResponse> load_response(const std::string& name, const WarningHandler& warn) {
  if (name == "footage") return std::nullopt;
  if (name == "srgb") return CameraResponse{TransferFunction::srgb, {}};
  if (name == "linear") return CameraResponse{TransferFunction::linear, {}};
  if (name.starts_with("gamma:")) return gamma_response(name);
  const std::string extension = std::filesystem::path(name).extension().string();
  ResponsePoints points;
  if (extension == ".yaml" || extension == ".yml" || extension == ".xml")
    points = points_of_storage(name, text_of(name));
  else if (extension == ".csv")
    points = points_of_csv(name, text_of(name));
  else if (extension == ".cube")
    points = points_of_cube(name, text_of(name));
  else
    throw Error("exposure.response is \"" + name + "\"; expected " + kExpected);
  return CameraResponse{TransferFunction::srgb, std::make_shared<ResponseCurve>(curve_of(std::move(points), name, warn))};
}

}  // namespace catchlight::app
