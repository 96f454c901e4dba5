// Parts of `catchlight probe` with files of their own.
#pragma once

#include "app/commands/commands.hpp"

namespace catchlight::app {

void add_probe_merge(CLI::App& parent, Context& context);

}  // namespace catchlight::app
