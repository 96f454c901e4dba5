// What a subcommand is, and those there are; main.cpp has the table.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "app/session/recording.hpp"
#include "app/support/log.hpp"

namespace CLI {
class App;
}

namespace catchlight::app {

/// What commands share; lives as long as the program.
struct Context {
  Log log;
  int exit_code = 0;                   ///< for a command that ran to its end and still has to report failure
  std::vector<std::string> arguments;  ///< the whole command line
};

struct Command {
  const char* name;
  const char* help;
  void (*set_up)(CLI::App& command, Context& context);  ///< adds options and the callback that runs it
};

void set_up_bake(CLI::App& command, Context& context);
void set_up_calibrate(CLI::App& command, Context& context);
void set_up_glare(CLI::App& command, Context& context);
void set_up_info(CLI::App& command, Context& context);
void set_up_overlay(CLI::App& command, Context& context);
void set_up_params(CLI::App& command, Context& context);
void set_up_probe(CLI::App& command, Context& context);
void set_up_reference(CLI::App& command, Context& context);
void set_up_replay(CLI::App& command, Context& context);
void set_up_tag(CLI::App& command, Context& context);
void set_up_tune(CLI::App& command, Context& context);
void set_up_track(CLI::App& command, Context& context);

/// Whether a command makes use of the parameter of that key. All are taken, so that one set of options fits all commands; what
/// is of no use is left out of the help.
using UsesParameter = bool (*)(const std::string& key);

/// The positional RECORDING, --scene, --camera, --fov, and one option for every parameter, with a number too where the arguments
/// give one (`--object[1].mesh`). `location` and `overrides` must live as long as `command`.
void add_recording_options(
    CLI::App& command, const Context& context, std::string& location, RecordingOverrides& overrides,
    UsesParameter uses = [](const std::string&) { return true; });

/// Adds --renderer and --shader-dir, for commands that draw. `both_draw`, where not null: "both" is a choice too, which sets it.
void add_renderer_options(CLI::App& command, RecordingOverrides& overrides, bool* both_draw = nullptr);

/// Runs the command that the arguments name. Exit code 0, 2 for a command line that cannot be carried out, 1 for anything else;
/// an error is one message on stderr.
int run_command_line(std::span<const Command> commands, int argc, const char* const* argv);

}  // namespace catchlight::app
