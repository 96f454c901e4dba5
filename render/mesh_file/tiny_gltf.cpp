// The glTF parser, compiled here without its picture decoder. With the prebuilt library, loaders came up without file callbacks
// in some programs and not in others.
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>
