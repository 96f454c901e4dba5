// What C++ and GLSL must agree on: uniform blocks (std140; only vec4, ivec4 and mat4 members, so C++ lays them out alike; a test
// asks GL), and the numbers of bindings, attributes and outputs.
#ifdef __cplusplus
#pragma once
#include <glm/glm.hpp>

namespace catchlight::render::shader_interface {
using glm::ivec4;
using glm::uvec4;
using glm::mat4;
using glm::vec4;
#define UNIFORM_BLOCK(type, binding_number) struct type
#define BLOCK_NAME(name)
#else
#define UNIFORM_BLOCK(type, binding_number) layout(std140, binding = binding_number) uniform type
#define BLOCK_NAME(name) name
#endif

#define MAX_LIGHT_COEFFICIENTS 100
#define MAX_LIGHT_SAMPLES 128
#define RECEIVER_CELLS 96
#define GLARE_MARGIN 4  // texels around the glare grid and its halvings
#define GLARE_TILE 2    // texels of the grid along a tile that is drawn or left out as a whole
#define MAX_GLARE_BLUR_TAPS 16
#define DEFOCUS_TAPS 96

// Uniform blocks
#define BINDING_VIEW 0
#define BINDING_LIGHT 1
#define BINDING_RECEIVER 2
#define BINDING_COMPOSITE 3
#define BINDING_LIGHT_SAMPLES 4

// Storage blocks
#define BINDING_TRANSFER 0
#define BINDING_DIRECT_TRANSFER 1
#define BINDING_BVH_NODES 0
#define BINDING_BVH_TRIANGLES 1
#define BINDING_VERTICES 2
#define BINDING_IRRADIANCE 3
#define BINDING_MATERIALS 4
#define BINDING_VERTEX_LIGHTS 5
#define BINDING_TRIANGLE_LIGHTS 7
#define BINDING_CORNERS 0
#define BINDING_LUMINANCES 0
#define BINDING_RESPONSE 6

// Textures
#define TEXTURE_PROBE 0
#define TEXTURE_BRDF 1
#define TEXTURE_RATIO 2
#define TEXTURE_PLATE_LIGHT 3
#define TEXTURE_RECEIVER_LIGHT 4
#define TEXTURE_SHADOW_MAPS 5
#define TEXTURE_REST 6
#define TEXTURE_OBJECT 0
#define TEXTURE_SHADOW 1
#define TEXTURE_PLATE 2
#define TEXTURE_GLARE 3
#define TEXTURE_REFLECTION 4
#define TEXTURE_BLOOM 3
#define TEXTURE_STREAKS 4
#define TEXTURE_SOURCE 0
#define TEXTURE_COARSER 1
#define TEXTURE_EMISSION 1

// Vertex attributes
#define ATTRIBUTE_POSITION 0
#define ATTRIBUTE_NORMAL 1
#define ATTRIBUTE_COLOR 2
#define ATTRIBUTE_IRRADIANCE 3
#define ATTRIBUTE_MIRRORS_OBJECT 4

// TransferFunction
#define TRANSFER_SRGB 0
#define TRANSFER_LINEAR 1
#define TRANSFER_GAMMA22 2
#define TRANSFER_GAMMA28 3
#define TRANSFER_PQ 4
#define TRANSFER_HLG 5
#define TRANSFER_CURVE 6  // the table in BINDING_RESPONSE

// The camera and its exposure.
UNIFORM_BLOCK(ViewUniforms, BINDING_VIEW) {
  mat4 clip_from_camera;
  mat4 camera_from_tag;
  mat4 light_from_tag;     // rotation
  mat4 plate_from_rec709;  // linear primaries
  vec4 camera_in_tag_m;
  vec4 exposure;
  vec4 radial_numerator;    // k1 k2 k3
  vec4 radial_denominator;  // k4 k5 k6
  vec4 tangential;          // p1 p2
  vec4 distortion_limit;    // radius, distorted radius, slope
  vec4 frame;               // width, height, focal length in pixels
  vec4 probe_in_tag_m;      // where the probe was captured; w: how deep below its triangles a smoothed surface may start a ray
  ivec4 options;            // rays over a rough surface's lobe (0: the probe alone is mirrored), receiver mirrored
}
BLOCK_NAME(view);

// A material as a storage block has it (std430).
struct SurfaceMaterial {
  vec4 base_color_metallic;
  vec4 emissive_roughness;
  vec4 dielectric;  // f0, f90
  vec4 unlit_color;  // exposed linear
};

// What a vertex sees of the lights' samples (std430). A bit a sample: what is neither lit nor dark lies on a shadow's border.
struct VertexLights {
  vec4 irradiance_over_pi;
  uvec4 lit;
  uvec4 dark;
};

// What a triangle sees of them (std430).
struct TriangleLights {
  vec4 flux_red;  // sum of irradiance times direction over the samples that are lit
  vec4 flux_green;
  vec4 flux_blue;
  uvec4 shining;  // all of the triangle sees these, which make highlights
  uvec4 mixed;    // part of it does: these are looked up at each pixel
};

UNIFORM_BLOCK(LightUniforms, BINDING_LIGHT) {
  ivec4 count;  // coefficients; whether lights are split off
  vec4 coefficients[MAX_LIGHT_COEFFICIENTS];
  vec4 split_off[MAX_LIGHT_COEFFICIENTS];  // the lights' part of them
}
BLOCK_NAME(light);

// Lights split off the probe.
UNIFORM_BLOCK(LightSampleUniforms, BINDING_LIGHT_SAMPLES) {
  ivec4 count;                         // samples
  vec4 sphere;                         // sphere around the object: middle in the tag frame, radius
  vec4 lift_m;                         // x: how far above a surface its shadows are looked up; y: how far apart at most
  vec4 to_light[MAX_LIGHT_SAMPLES];    // tag frame, length 1; w: spread (rad)
  vec4 right[MAX_LIGHT_SAMPLES];       // the shadow map's x axis
  vec4 irradiance[MAX_LIGHT_SAMPLES];  // irradiance on a surface that faces the light; w: 1 where it makes highlights
}
BLOCK_NAME(light_samples);

UNIFORM_BLOCK(ReceiverUniforms, BINDING_RECEIVER) {
  vec4 min_max_m;         // tag x, y of the first and last points
  vec4 lights_min_max_m;  // corners of the lights' texture
  vec4 drawn_min_max_m;   // rectangle around both
  vec4 one_over_unshadowed;
  vec4 unshadowed_rest;  // irradiance / pi of what is not split off
  vec4 unshadowed_lights;
  vec4 light_texels;  // width, height; 0 without lights
  ivec4 points;       // columns, rows
}
BLOCK_NAME(receiver);

// Rectangles are x, y, width, height in pixels of the frame.
UNIFORM_BLOCK(CompositeUniforms, BINDING_COMPOSITE) {
  ivec4 output_rect;
  ivec4 virtual_rect;  // what object and shadow textures hold
  ivec4 plate_rect;    // what the plate texture holds
  ivec4 modes;         // TransferFunction, codes end at 1, glare (1: on its grid, 2: by pixels), result is linear light
  vec4 black;
  vec4 receiver_light;    // light of the receiver where it is not shadowed, exposed linear; 0: not known
  vec4 code_limits;       // x: smallest difference of codes that counts; y: the clipping level
  vec4 glare_from_frame;  // texels of the glare = pixel * xy + zw
  ivec4 noise;            // added, seed, log2 of the pixels that share a colour (across, down)
  vec4 noise_slope;       // variance = slope * light + floor
  vec4 noise_floor;
  vec4 vignetting;     // v1, v2, v3; w: 1 / the tag's
  vec4 vignetting_at;  // middle (pixels), 1 / half diagonal squared
  mat4 noise_mix;      // unit variance of RGB from two numbers a block and one a pixel
}
BLOCK_NAME(composite);

#ifdef __cplusplus
#undef UNIFORM_BLOCK
#undef BLOCK_NAME
}  // namespace catchlight::render::shader_interface
#endif
