#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <set>
#include <vector>

#include "app/commands/commands.hpp"
#include "app/commands/help.hpp"
#include "app/media/frame_rate.hpp"
#include "app/settings/parameters.hpp"
#include "catchlight/error.hpp"
#include "catchlight/util/enum_names.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::app {
namespace {

constexpr const char* kDescription =
    "Puts synthetic objects into real footage: tracks AprilTags, lights the object with a light probe of the place,\n"
    "and composites it at the camera's own exposure.";
constexpr const char* kFooter =
    "`catchlight help COMMAND` explains a command; `catchlight params` lists what a scene file can say.\n"
    "-q (quiet) and -v (verbose) may stand anywhere.";
constexpr const char* kBoth = "both";  ///< a choice of --renderer

enum ExitCode { kSuccess = 0, kFailure = 1, kUsage = 2 };

/// The innermost subcommand that the arguments reached.
const CLI::App& active_command(const CLI::App& app) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  return chosen.empty() ? app : active_command(*chosen.back());
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names{"--quiet", "--verbose"};
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) names.push_back(command->get_name());
  return names;
}

/// "catchlight probe convert" for the command that the arguments reached.
std::string words_of(const CLI::App& command) {
  const CLI::App* parent = command.get_parent();
  return parent ? words_of(*parent) + ' ' + command.get_name() : command.get_name();
}

/// The commands that take an option of that name, "`catchlight overlay`, `catchlight replay`"; empty where none does.
std::string commands_with(const CLI::App& app, const std::string& option) {
  std::string commands;
  const auto add = [&](const std::string& found) { commands += (commands.empty() || found.empty() ? "" : ", ") + found; };
  if (app.get_parent() && app.get_option_no_throw(option)) add('`' + words_of(app) + '`');
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) add(commands_with(*command, option));
  return commands;
}

/// What stands where nothing was expected: a mistyped option, a mistyped command, or one argument too many. There is one.
std::string unexpected_argument(const CLI::App& app) {
  const CLI::App& command = active_command(app);
  const std::vector<std::string> extras = app.remaining(true);
  const std::string& argument = extras.front();
  const std::string name = argument.substr(0, argument.find('='));
  if (name.starts_with("--")) {
    const std::string elsewhere = commands_with(app, name);
    if (!elsewhere.empty()) return '`' + words_of(command) + "` has no option " + name + "; it is one of " + elsewhere;
    return "unknown option " + name + "; did you mean " + nearest(name, option_names(command)) + "?";
  }
  const std::vector<std::string> subcommands = command_names(command);
  if (!name.starts_with("-") && !subcommands.empty())
    return "unknown command '" + name + "'; did you mean '" + nearest(name, subcommands) + "'?";
  return "unexpected argument '" + argument + "'";
}

/// The parameters that options name together with a number, such as `object[1].mesh`. There are as many as a scene has objects,
/// so only those that are used become options.
std::set<std::string> numbered_keys(const std::vector<std::string>& arguments) {
  std::set<std::string> keys;
  for (const std::string& argument : arguments) {
    if (!argument.starts_with("--")) continue;
    const std::string key = argument.substr(2, argument.find('=') - 2);
    if (names_an_element(key)) keys.insert(key);
  }
  return keys;
}

/// Whether only the name of a command is missing, so that help is what is wanted.
bool lacks_command(const CLI::App& app, const CLI::ParseError& error) {
  return error.get_name() == "RequiredError" && app.remaining(true).empty() && !command_names(active_command(app)).empty();
}

int report_parse_error(const CLI::App& app, const CLI::ParseError& error, Log& log) {
  const CLI::App& command = active_command(app);
  const bool is_command_unknown = !command_names(command).empty() && !app.remaining(true).empty();
  if (error.get_exit_code() == 0 && !is_command_unknown) return app.exit(error);  // --help, --version
  if (lacks_command(app, error)) {
    std::fputs(app.help().c_str(), stderr);
    return kUsage;
  }
  // What is left over comes first: a mistyped command or option is often why something else is missing.
  const std::string message = app.remaining(true).empty() ? std::string(error.what()) : unexpected_argument(app);
  log.error(message + "\n`" + words_of(command) + " --help` shows what can be given.");
  return kUsage;
}

}  // namespace

void add_recording_options(CLI::App& command, const Context& context, std::string& location, RecordingOverrides& overrides,
                           UsesParameter uses) {
  command
      .add_option(
          "RECORDING", location,
          "Folder with footage, camera.yaml and scene.toml; or a video, a %04d or #### pattern, a camera, a stream, - (stdin)")
      ->required();
  command
      .add_option("--scene", overrides.scene_file,
                  "Scene file, instead of the recording's scene.toml; none is needed where options say what it would")
      ->type_name("FILE");
  command.add_option("--camera", overrides.camera_file, "Camera file, instead of the recording's camera.yaml")->type_name("FILE");
  command.add_option("--fov", overrides.fov_deg, "Horizontal field of view of a camera that is not calibrated")
      ->type_name("DEGREES");
  command
      .add_option_function<std::string>(
          "--fps", [&overrides](const std::string& text) { overrides.fps = frame_rate_from_text(text); },
          "Frames a second of an image sequence, such as 25, 23.976 or 24000/1001; else what EXR files say, else 24")
      ->type_name("RATE");
  CLI::Option* strict = command.add_flag("--strict", overrides.strict,
                                         "Refuse a probe with NaN, infinite or negative texels instead of taking them for 0");
  if (!uses("probe.image")) strict->group("");
  const auto add = [&](const std::string& key) {
    const auto note = [&overrides, key](const std::string& text) { overrides.parameters.emplace_back(key, text); };
    return command.add_option_function<std::string>("--" + key, note);
  };
  for (const Parameter& parameter : parameters())
    add(parameter.key)
        ->description(parameter_help(parameter))
        ->type_name(parameter.unit.empty() ? "VALUE" : parameter.unit)
        ->group(uses(parameter.key) ? "Parameters of the scene (they override the scene file)" : "");
  for (const std::string& key : numbered_keys(context.arguments)) add(key)->group("");
}

void add_renderer_options(CLI::App& command, RecordingOverrides& overrides, bool* both_draw) {
  std::vector<std::string> choices = name_list<Renderer>();
  std::string help = "What draws: the processor, OpenGL, or whichever is faster: OpenGL where there is a graphics card";
  if (both_draw != nullptr) {
    choices.emplace_back(kBoth);
    help += "; both: each frame is drawn by both, and the pictures are compared";
  }
  command
      .add_option_function<std::string>(
          "--renderer",
          [&overrides, both_draw](const std::string& name) {
            if (name == kBoth)
              *both_draw = true;
            else
              overrides.renderer = value_named<Renderer>(name).value();
          },
          help)
      ->check(CLI::IsMember(choices))
      ->default_str(name_of(Renderer::automatic));
  command
      .add_option("--shader-dir", overrides.shader_folder,
                  "Draw with the shaders of this folder, an edited copy of the source's shaders/, instead of the built-in ones")
      ->type_name("FOLDER")
      ->group("For those who work on shaders");
}

int run_command_line(std::span<const Command> commands, int argc, const char* const* argv) {
  Context context;
  context.arguments.assign(argv + std::min(argc, 1), argv + argc);
  context.arguments = with_help_as_option(std::move(context.arguments));
  CLI::App app{kDescription, "catchlight"};
  app.formatter(std::make_shared<HelpFormatter>());
  app.footer(kFooter);
  app.set_version_flag("--version", "catchlight " CATCHLIGHT_VERSION);
  app.require_subcommand(1);
  app.add_flag_callback(
         "-q,--quiet", [&] { context.log.set_quiet(true); }, "Print nothing but errors")
      ->trigger_on_parse();
  app.add_flag_callback(
         "-v,--verbose", [&] { context.log.set_verbose(true); }, "Print the plan, with its reasons, and the time of each stage")
      ->trigger_on_parse();
  for (const Command& command : commands) {
    CLI::App& subcommand = *app.add_subcommand(command.name, command.help);
    subcommand.fallthrough();
    command.set_up(subcommand, context);
  }
  try {
    app.parse(std::vector(context.arguments.rbegin(), context.arguments.rend()));  // CLI11 takes the last one first
    return context.exit_code;
  } catch (const CLI::ParseError& error) {
    return report_parse_error(app, error, context.log);
  } catch (const UsageError& error) {
    context.log.error(error.what());
    return kUsage;
  } catch (const std::exception& error) {
    context.log.error(error.what());
    return kFailure;
  }
}

}  // namespace catchlight::app
