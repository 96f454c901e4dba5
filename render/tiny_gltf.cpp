// The glTF parser's implementation, compiled here: its prebuilt library expects other settings, and its header gives no way to tell.
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>
