#include <algorithm>
#include <cstring>

#include "catchlight/error.hpp"
#include "render/mesh_file/gltf.hpp"

namespace catchlight::render::gltf {
namespace {

constexpr std::size_t kMaxElements = std::size_t{1} << 28;

[[noreturn]] void refuse(const Document& document, const std::string& why) {
  throw Error(document.path + ": damaged glTF: " + why);
}

template <typename T>
const T& at(const Document& document, const std::vector<T>& list, int index, const char* what) {
  if (index < 0 || static_cast<std::size_t>(index) >= list.size())
    refuse(document, std::string("there is no ") + what + " " + std::to_string(index));
  return list[index];
}

// Component `type` at `bytes`, as the specification's table maps normalised integers (glTF 2.0, 3.6.2.2).
float component(const unsigned char* bytes, int type, bool normalized) {
  const auto load = [bytes]<typename T>(T value) {
    std::memcpy(&value, bytes, sizeof value);
    return value;
  };
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return load(0.0f);
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return normalized ? std::max(load(std::int8_t{}) / 127.0f, -1.0f) : load(std::int8_t{});
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return load(std::uint8_t{}) / (normalized ? 255.0f : 1.0f);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return normalized ? std::max(load(std::int16_t{}) / 32767.0f, -1.0f) : load(std::int16_t{});
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load(std::uint16_t{}) / (normalized ? 65535.0f : 1.0f);
    default:
      return static_cast<float>(load(std::uint32_t{}));
  }
}

std::uint32_t unsigned_component(const Document& document, const unsigned char* bytes, int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return *bytes;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return bytes[0] | (bytes[1] << 8);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return bytes[0] | (bytes[1] << 8) | (bytes[2] << 16) | (std::uint32_t{bytes[3]} << 24);
    default:
      refuse(document, "indices of component type " + std::to_string(type));
  }
}

// `count` elements of `element_bytes`, `stride` apart, checked to lie within the view.
struct Elements {
  const unsigned char* first;
  std::size_t stride;
  const unsigned char* operator[](std::size_t i) const { return first + i * stride; }
};

Elements elements(const Document& document, int buffer_view, std::size_t offset, std::size_t count, std::size_t element_bytes,
                  bool strided) {
  const std::span<const unsigned char> bytes = bytes_of(document, buffer_view);
  const std::size_t own_stride = strided ? document.model.bufferViews[buffer_view].byteStride : 0;
  const std::size_t stride = own_stride > 0 ? own_stride : element_bytes;
  if (count > kMaxElements || offset > bytes.size() ||
      (count > 0 && (count - 1) * stride + element_bytes > bytes.size() - offset)) {
    refuse(document, "an accessor reaches beyond buffer view " + std::to_string(buffer_view));
  }
  return {bytes.data() + offset, stride};
}

// Sparse accessors replace single elements.
void put_sparse(const Document& document, const tinygltf::Accessor& accessor, int file_components, int components,
                std::vector<float>& values) {
  const auto& sparse = accessor.sparse;
  const std::size_t size = tinygltf::GetComponentSizeInBytes(accessor.componentType), count = std::max(sparse.count, 0);
  const int index_size = tinygltf::GetComponentSizeInBytes(sparse.indices.componentType);
  if (index_size <= 0 || sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0)
    refuse(document, "a sparse accessor without indices");
  const Elements indices = elements(document, sparse.indices.bufferView, sparse.indices.byteOffset, count, index_size, false);
  const Elements replaced =
      elements(document, sparse.values.bufferView, sparse.values.byteOffset, count, size * file_components, false);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t target = unsigned_component(document, indices[i], sparse.indices.componentType);
    if (target >= accessor.count)
      refuse(document, "a sparse accessor names element " + std::to_string(target) + " of " + std::to_string(accessor.count));
    for (int c = 0; c < components; ++c) {
      values[target * components + c] = component(replaced[i] + c * size, accessor.componentType, accessor.normalized);
    }
  }
}

}  // namespace

std::span<const unsigned char> bytes_of(const Document& document, int buffer_view) {
  const tinygltf::BufferView& view = at(document, document.model.bufferViews, buffer_view, "buffer view");
  const std::vector<unsigned char>& data = at(document, document.model.buffers, view.buffer, "buffer").data;
  if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset) {
    refuse(document, "buffer view " + std::to_string(buffer_view) + " reaches beyond its buffer");
  }
  return {data.data() + view.byteOffset, view.byteLength};
}

std::vector<float> read_floats(const Document& document, int index, int components) {
  const tinygltf::Accessor& accessor = at(document, document.model.accessors, index, "accessor");
  const int size = tinygltf::GetComponentSizeInBytes(accessor.componentType),
            file_components = tinygltf::GetNumComponentsInType(accessor.type);
  if (size <= 0 || size > 4 || file_components < components || accessor.count > kMaxElements) {
    refuse(document, "accessor " + std::to_string(index) + " does not hold vectors of " + std::to_string(components));
  }
  std::vector<float> values(accessor.count * components);  // zeros where no buffer view is named (glTF 2.0, 5.1.1)
  if (accessor.bufferView >= 0) {
    const Elements source = elements(document, accessor.bufferView, accessor.byteOffset, accessor.count,
                                     static_cast<std::size_t>(size) * file_components, true);
    for (std::size_t i = 0; i < accessor.count; ++i) {
      for (int c = 0; c < components; ++c)
        values[i * components + c] = component(source[i] + c * size, accessor.componentType, accessor.normalized);
    }
  }
  if (accessor.sparse.isSparse) put_sparse(document, accessor, file_components, components, values);
  return values;
}

std::vector<std::uint32_t> read_indices(const Document& document, int index) {
  const tinygltf::Accessor& accessor = at(document, document.model.accessors, index, "accessor");
  const int size = tinygltf::GetComponentSizeInBytes(accessor.componentType);
  if (size <= 0 || accessor.type != TINYGLTF_TYPE_SCALAR)
    refuse(document, "accessor " + std::to_string(index) + " holds no indices");
  if (accessor.bufferView < 0) refuse(document, "accessor " + std::to_string(index) + " holds no indices");
  const Elements source = elements(document, accessor.bufferView, accessor.byteOffset, accessor.count, size, true);
  std::vector<std::uint32_t> indices(accessor.count);
  for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = unsigned_component(document, source[i], accessor.componentType);
  return indices;
}

}  // namespace catchlight::render::gltf
