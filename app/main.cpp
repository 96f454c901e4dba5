#include "app/commands.hpp"

namespace {

using namespace catchlight::app;

constexpr Command kCommands[] = {
    {"bake", "Precompute how light travels over a recording's objects", set_up_bake},
    {"probe", "Look at light probes and convert them", set_up_probe},
    {"info", "Versions, libraries and graphics: what a bug report needs", set_up_info},
    {"params", "List every parameter of a scene", set_up_params},
};

}  // namespace

int main(int argc, char** argv) {
  return run_command_line(kCommands, argc, argv);
}
