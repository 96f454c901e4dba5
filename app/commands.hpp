// The table of subcommands.
#pragma once

#include <string>
#include <vector>

#include "app/log.hpp"
#include "app/recording.hpp"

namespace CLI {
class App;
}

namespace catchlight::app {

/// What commands share; lives as long as the program.
struct Context {
  Log log;
  int exit_code = 0;  ///< for a command that ran to its end and still has to report failure
};

struct Command {
  const char* name;
  const char* help;
  void (*set_up)(CLI::App& command, Context& context);  ///< adds options and the callback that runs it
};

const std::vector<Command>& commands();

void set_up_bake(CLI::App& command, Context& context);
void set_up_info(CLI::App& command, Context& context);
void set_up_params(CLI::App& command, Context& context);
void set_up_probe(CLI::App& command, Context& context);

/// The positional RECORDING, --scene, --camera, --fov, and one option for every parameter.
void add_recording_options(CLI::App& command, std::string& location, RecordingOverrides& overrides);

/// Runs the program. Exit code 0, 2 for a command line that cannot be carried out, 1 for anything else.
int run_catchlight(int argc, const char* const* argv);

}  // namespace catchlight::app
