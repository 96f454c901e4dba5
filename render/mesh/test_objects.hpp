// Objects that need no file: what artists put down first, to see light, shadow and reflection.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "render/mesh/mesh.hpp"

namespace catchlight::render {

/// White shapes; a mirror ball beside a matte grey one.
inline constexpr std::array kTestObjects{"sphere", "cube", "cone", "cylinder", "plane", "torus", "chrome-and-grey"};

/// The object of that name, its middle in the origin and its axis along z, as large as suits a tag of this size; empty for other
/// names. The shapes are three quarters as wide as the tag and reflect 0.8 of the light; cube, cone and cylinder are as high as
/// wide, the torus is a quarter of that, the plane lies flat. The pair lies along x, each ball 0.6 as wide as the tag: at -x one
/// that mirrors all light, at +x a Lambertian one that reflects 0.18.
std::optional<Mesh> test_object(const std::string& name, double tag_size_m);

}  // namespace catchlight::render
