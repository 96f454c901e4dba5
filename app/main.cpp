#include <cstdlib>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "app/commands/commands.hpp"

namespace {

using namespace catchlight::app;

constexpr Command kCommands[] = {
    {"overlay", "Put the virtual objects into footage", set_up_overlay},
    {"tune", "Turn everything by hand in a window on the footage", set_up_tune},
    {"track", "Find the tag and its exposure in footage; no drawing", set_up_track},
    {"replay", "Overlay recordings and say what drifted from the truth, or from a run that was kept", set_up_replay},
    {"reference", "Path trace one frame with the object in it, to compare an overlay with", set_up_reference},
    {"bake", "Precompute how light travels over a recording's objects", set_up_bake},
    {"probe", "Look at light probes and convert them", set_up_probe},
    {"glare", "Show what an aperture makes of a bright light", set_up_glare},
    {"tag", "Print a tag or a board of tags at its exact size: PDF, SVG, PNG", set_up_tag},
    {"calibrate", "Make camera.yaml from footage of a checkerboard or a board of tags", set_up_calibrate},
    {"info", "Versions, libraries and graphics: what a bug report needs", set_up_info},
    {"params", "List every parameter of a scene", set_up_params},
};

/// Buffers of a frame's size are made and let go for every frame. By default each goes back to the kernel, which zeroes it page
/// by page for the next one.
void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int kMaxKept_bytes = 256 << 20;
  mallopt(M_MMAP_THRESHOLD, kMaxKept_bytes);
  mallopt(M_TRIM_THRESHOLD, kMaxKept_bytes);
#endif
}

}  // namespace

int main(int argc, char** argv) {
  keep_freed_memory();
  return run_command_line(kCommands, argc, argv);
}
