#include "app/session/run_stages.hpp"

#include <thread>

#include "catchlight/util/bounded_queue.hpp"

namespace catchlight::app {

void run_stages(Session& session, const std::function<void(FrameJob&)>& write, StageOptions options) {
  session.prepare();
  const bool is_live = session.footage().info().is_live;
  const std::size_t length = is_live ? 1 : options.queue_length;
  BoundedQueue<FrameJob> decoded(length), tracked(length), drawn(length), left_over(length);
  // The newest frame of live footage is taken when the tracker can begin with it.
  const std::jthread decoding(is_live ? std::jthread() : std::jthread([&] { fill(decoded, [&] { return session.decode(); }); }));
  const std::jthread tracking([&] {
    const auto track = [&](FrameJob& job) {
      session.track(job);
      return true;
    };
    if (!is_live) return pass_on(decoded, tracked, track);
    fill(tracked, [&] {
      std::optional<FrameJob> job = session.decode();
      if (job) track(*job);
      return job;
    });
  });
  const std::jthread writing([&] {
    pass_on(drawn, left_over, [&](FrameJob& job) {
      write(job);
      session.finish(job);
      return false;
    });
  });
  pass_on(tracked, drawn, [&](FrameJob& job) {
    const bool is_drawn = !job.is_before_range && options.wants(job);
    is_drawn ? session.render(job) : session.skip(job);
    if (is_drawn) options.look(job);
    return is_drawn;
  });
  left_over.pop();  // waits for the end, and throws what came with it
}

}  // namespace catchlight::app
