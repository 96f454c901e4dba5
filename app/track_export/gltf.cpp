#include <bit>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/track_export/camera_trajectory.hpp"
#include "app/track_export/formats.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/track.hpp"

namespace catchlight::app {
namespace {

using Json = nlohmann::ordered_json;
constexpr int kFloat = 5126;      // GL's name of the component type, as glTF numbers it
constexpr double kNear_m = 0.01;  // a perspective camera must have one

struct Gltf {
  Json json;
  std::string keys;  ///< little-endian floats: times, then translations, then rotations
};

void append_u32(std::string& bytes, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(value >> shift & 0xff);
}

void append_float(std::string& bytes, double value) {
  append_u32(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(value)));
}

Json vector_json(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

Json quaternion_json(const glm::dquat& q) {
  return {q.x, q.y, q.z, q.w};
}

Json matrix_json(const glm::dmat4& matrix) {
  Json cells = Json::array();
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) cells.push_back(matrix[column][row]);
  return cells;
}

/// The keys whose times rise in single precision.
std::vector<CameraKey> animation_keys(const std::vector<TrackRow>& rows, const SceneSettings& scene) {
  std::vector<CameraKey> keys;
  for (const CameraKey& key : camera_path_y_up(rows, scene))
    if (keys.empty() || static_cast<float>(key.time_s) > static_cast<float>(keys.back().time_s)) keys.push_back(key);
  return keys;
}

/// Everything a camera file says, for programs that look.
Json camera_json(const CameraModel& camera) {
  const double aspect_ratio = camera.width_px * camera.fy_px / (camera.height_px * camera.fx_px);
  return {{"type", "perspective"},
          {"perspective", {{"yfov", vertical_fov_rad(camera)}, {"aspectRatio", aspect_ratio}, {"znear", kNear_m}}},
          {"extras",
           {{"image_width", camera.width_px},
            {"image_height", camera.height_px},
            {"fx_px", camera.fx_px},
            {"fy_px", camera.fy_px},
            {"cx_px", camera.cx_px},
            {"cy_px", camera.cy_px},
            {"distortion_k1_k2_p1_p2_k3_k4_k5_k6", camera.distortion}}}};
}

/// camera, tag, and the objects as the tag's children.
Json nodes_json(const CameraKey& first, const SceneSettings& scene) {
  Json nodes = Json::array();
  nodes.push_back({{"name", "camera"},
                   {"camera", 0},
                   {"translation", vector_json(first.world_from_camera_m)},
                   {"rotation", quaternion_json(first.world_from_camera)}});
  nodes.push_back({{"name", "tag"},
                   {"rotation", quaternion_json(glm::quat_cast(y_up_from_tag(scene)))},
                   {"extras", {{"family", scene.tag.family}, {"id", scene.tag.id}, {"size_m", scene.tag.size_m}}}});
  for (const SceneSettings::Object& object : scene.objects) {
    nodes[1]["children"].push_back(nodes.size());
    nodes.push_back({{"name", "place of " + std::filesystem::path(object.mesh).filename().string()},
                     {"matrix", matrix_json(object.tag_from_object())}});
  }
  return nodes;
}

/// Accessors, buffer views and the animation that uses them; appends the keys to `gltf.keys`.
void add_animation(Gltf& gltf, const std::vector<CameraKey>& keys) {
  const auto add_accessor = [&](const char* type, auto&& append_key) {
    const std::size_t offset = gltf.keys.size();
    for (const CameraKey& key : keys) append_key(key);
    gltf.json["accessors"].push_back(
        {{"bufferView", gltf.json["bufferViews"].size()}, {"componentType", kFloat}, {"count", keys.size()}, {"type", type}});
    gltf.json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", gltf.keys.size() - offset}});
  };
  add_accessor("SCALAR", [&](const CameraKey& key) { append_float(gltf.keys, key.time_s); });
  gltf.json["accessors"][0]["min"] = Json::array({static_cast<float>(keys.front().time_s)});
  gltf.json["accessors"][0]["max"] = Json::array({static_cast<float>(keys.back().time_s)});
  add_accessor("VEC3", [&](const CameraKey& key) {
    for (int i = 0; i < 3; ++i) append_float(gltf.keys, key.world_from_camera_m[i]);
  });
  add_accessor("VEC4", [&](const CameraKey& key) {
    const glm::dquat& q = key.world_from_camera;
    for (const double component : {q.x, q.y, q.z, q.w}) append_float(gltf.keys, component);
  });
  const auto channel = [](int sampler, const char* path) {
    return Json{{"sampler", sampler}, {"target", {{"node", 0}, {"path", path}}}};
  };
  const auto sampler = [](int output) { return Json{{"input", 0}, {"output", output}, {"interpolation", "LINEAR"}}; };
  gltf.json["animations"].push_back({{"name", "camera path"},
                                     {"channels", Json::array({channel(0, "translation"), channel(1, "rotation")})},
                                     {"samplers", Json::array({sampler(1), sampler(2)})}});
}

Gltf make_gltf(const std::vector<TrackRow>& rows, const Shot& shot) {
  const std::vector<CameraKey> keys = animation_keys(rows, shot.scene);
  Gltf gltf;
  gltf.json["asset"] = {{"version", "2.0"},
                        {"generator", "Catchlight " CATCHLIGHT_VERSION},
                        {"extras", {{"world", "metres, +y up, origin at the tag's centre; times are the footage's"}}}};
  gltf.json["scene"] = 0;
  gltf.json["scenes"] = Json::array({Json{{"nodes", {0, 1}}}});
  gltf.json["nodes"] = nodes_json(keys.front(), shot.scene);
  gltf.json["cameras"] = Json::array({camera_json(shot.camera)});
  add_animation(gltf, keys);
  gltf.json["buffers"] = Json::array({Json{{"byteLength", gltf.keys.size()}}});
  return gltf;
}

/// RFC 4648.
std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t j = i; j < i + 3; ++j) group = group << 8 | (j < bytes.size() ? static_cast<unsigned char>(bytes[j]) : 0u);
    for (int shift = 18; shift >= 0; shift -= 6) text += kDigits[group >> shift & 63];
  }
  for (std::size_t i = 0; i < (3 - bytes.size() % 3) % 3; ++i) text[text.size() - 1 - i] = '=';
  return text;
}

void append_chunk(std::string& bytes, std::string_view type, std::string_view content) {
  append_u32(bytes, static_cast<std::uint32_t>(content.size()));
  bytes += type;
  bytes += content;
}

}  // namespace

std::string gltf_text(const std::vector<TrackRow>& rows, const Shot& shot) {
  Gltf gltf = make_gltf(rows, shot);
  gltf.json["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64(gltf.keys);
  return gltf.json.dump(1) + '\n';
}

std::string glb_bytes(const std::vector<TrackRow>& rows, const Shot& shot) {
  const Gltf gltf = make_gltf(rows, shot);
  std::string json = gltf.json.dump();
  json.resize((json.size() + 3) / 4 * 4, ' ');  // chunks are aligned; the keys are already
  std::string chunks;
  append_chunk(chunks, "JSON", json);
  append_chunk(chunks, std::string_view("BIN\0", 4), gltf.keys);
  constexpr std::size_t kHeader = 12;
  std::string bytes = "glTF";
  append_u32(bytes, 2);
  append_u32(bytes, static_cast<std::uint32_t>(kHeader + chunks.size()));
  return bytes + chunks;
}

}  // namespace catchlight::app
