#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <memory>

#include "app/commands/commands.hpp"
#include "app/session/recording.hpp"
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
  log.info(recording.name + ": " + std::to_string(scene.mesh.vertices.size()) + " vertices, " +
           std::to_string(scene.transfer.grid.columns) + "x" + std::to_string(scene.transfer.grid.rows) + " receiver points, " +
           std::to_string(scene.transfer.bands) + " bands, " + std::to_string(built.rays) + " rays, " +
           (built.transfer_was_cached ? "taken from the cache" : "baked") + " in " +
           number_text(std::round(elapsed_s * 10) / 10) + " s");
  log.info("  cache: " + render::default_cache_folder() + ", entry " + built.scene.transfer_key);
  for (const PlanEntry& entry : built.plan) log.info("  " + entry.choice + " = " + entry.value + ": " + entry.reason);
}

}  // namespace

void set_up_bake(CLI::App& command, Context& context) {
  const auto arguments = std::make_shared<Arguments>();
  add_recording_options(command, context, arguments->location, arguments->overrides);
  command.callback([arguments, &context] { bake(*arguments, context.log); });
}

}  // namespace catchlight::app
