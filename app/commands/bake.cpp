#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <memory>

#include "app/commands/commands.hpp"
#include "app/commands/help.hpp"
#include "app/session/recording.hpp"
#include "app/session/report.hpp"
#include "app/session/scene_builder.hpp"
#include "app/support/progress.hpp"
#include "catchlight/util/text.hpp"
#include "render/render_scene.hpp"

namespace catchlight::app {
namespace {

struct Arguments {
  std::string location;
  RecordingOverrides overrides;
};

void bake(const Arguments& arguments, Log& log) {
  const Recording recording = open_recording(arguments.location, arguments.overrides);
  const auto start = std::chrono::steady_clock::now();
  SceneBuilder builder;
  const BuiltScene& built = builder.build(recording.scene, log.warning_handler(), progress_handler(log, "bake"));
  const double elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const render::RenderScene& scene = built.scene;
  log.info(recording.name + ": " + counted(scene.mesh.vertices.size(), "vertex", "vertices") + ", " +
           std::to_string(scene.transfer.grid.columns) + "x" + std::to_string(scene.transfer.grid.rows) + " receiver points, " +
           counted(scene.transfer.bands, "band") + ", " + std::to_string(built.rays) + " rays, " +
           (built.transfer_was_cached ? "taken from the cache" : "baked") + " in " +
           number_text(std::round(elapsed_s * 10) / 10) + " s");
  log.detail("  cache: " + render::default_cache_folder() + ", entry " + built.scene.transfer_key + '\n' + plan_text(built.plan));
}

bool uses_parameter(const std::string& key) {
  const ChangeCost cost = find_parameter(key)->cost;
  return cost == ChangeCost::light || cost == ChangeCost::bake || cost == ChangeCost::mesh;
}

}  // namespace

void set_up_bake(CLI::App& command, Context& context) {
  const auto arguments = std::make_shared<Arguments>();
  add_recording_options(command, context, arguments->location, arguments->overrides, uses_parameter);
  show_examples(command,
                {"catchlight bake recordings/matte", "catchlight bake recordings/matte --quality.tolerance 0.001 --verbose"});
  command.callback([arguments, &context] { bake(*arguments, context.log); });
}

}  // namespace catchlight::app
