// glTF files made by hand.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "render/image/picture_file.hpp"
#include "render/mesh_file/mesh_file.hpp"
#include "tests/support/test_files.hpp"

namespace catchlight::render {

inline std::string base64(const std::vector<unsigned char>& bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned word = 0;
    for (std::size_t k = 0; k < 3; ++k) word = word << 8 | (i + k < bytes.size() ? bytes[i + k] : 0);
    for (int k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : kDigits[word >> (18 - 6 * k) & 63];
  }
  return text;
}

template <typename T>
std::vector<unsigned char> bytes_of(const std::vector<T>& values) {
  const auto* first = reinterpret_cast<const unsigned char*>(values.data());
  return {first, first + values.size() * sizeof(T)};
}

/// A glTF file in pieces: one buffer, JSON for the rest.
struct Gltf {
  std::vector<unsigned char> buffer;
  std::string views, accessors, extra;
  std::string nodes = R"({"mesh":0})", primitive, materials;
  int view_count = 0, accessor_count = 0;

  int view(const std::vector<unsigned char>& bytes, int stride = 0) {
    views += std::string(view_count ? "," : "") + R"({"buffer":0,"byteOffset":)" + std::to_string(buffer.size()) +
             R"(,"byteLength":)" + std::to_string(bytes.size()) + (stride ? R"(,"byteStride":)" + std::to_string(stride) : "") +
             "}";
    buffer.insert(buffer.end(), bytes.begin(), bytes.end());
    buffer.resize((buffer.size() + 3) / 4 * 4);
    return view_count++;
  }
  int accessor(const std::string& fields) {
    accessors += std::string(accessor_count ? "," : "") + "{" + fields + "}";
    return accessor_count++;
  }
  int vectors(const std::vector<float>& values, const std::string& type, int components) {
    return accessor(R"("bufferView":)" + std::to_string(view(bytes_of(values))) + R"(,"componentType":5126,"type":")" + type +
                    R"(","count":)" + std::to_string(values.size() / components));
  }
  std::string text() const {
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[)" + nodes +
           R"(],"meshes":[{"primitives":[{)" + primitive + R"(}]}],"accessors":[)" + accessors + R"(],"bufferViews":[)" + views +
           "]," + (materials.empty() ? "" : R"("materials":[)" + materials + "],") + extra + R"("buffers":[{"byteLength":)" +
           std::to_string(buffer.size()) + R"(,"uri":"data:application/octet-stream;base64,)" + base64(buffer) + R"("}]})";
  }
};

inline const std::vector<float> kTriangle{0, 0, 0, 1, 0, 0, 0, 1, 0};

/// One triangle in the xy plane, facing +z.
inline Gltf triangle() {
  Gltf gltf;
  gltf.primitive = R"("attributes":{"POSITION":)" + std::to_string(gltf.vectors(kTriangle, "VEC3", 3)) + "}";
  return gltf;
}

/// The triangle with texture coordinates of the same places, v down; with material 0.
inline Gltf textured_triangle() {
  Gltf gltf = triangle();
  const int uv = gltf.vectors({0, 0, 1, 0, 0, 1}, "VEC2", 2);
  gltf.primitive = R"("attributes":{"POSITION":0,"TEXCOORD_0":)" + std::to_string(uv) + R"(},"material":0)";
  return gltf;
}

class GltfFile : public testing::Test {
 protected:
  Mesh load(const std::string& name) { return load_mesh(folder_ / name, warnings_.handler()); }
  Mesh load(const Gltf& gltf) {
    write_text(folder_ / "a.gltf", gltf.text());
    return load("a.gltf");
  }
  std::string load_error(const Gltf& gltf) {
    return error_of([&] { load(gltf); });
  }

  void write_picture(const std::string& name, const cv::Mat& bgr) { write_png(folder_ / name, bgr); }

  TempFolder folder_;
  Warnings warnings_;
};

}  // namespace catchlight::render
