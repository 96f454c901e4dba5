#include "app/session/run_stages.hpp"

#include <thread>

#include "catchlight/util/bounded_queue.hpp"

namespace catchlight::app {

void run_stages(Session& session, const std::function<void(FrameJob&)>& write, StageOptions options) {
  session.prepare();
  const std::size_t length = session.footage().info().is_live ? 1 : options.queue_length;
  BoundedQueue<FrameJob> decoded(length), tracked(length), drawn(length), left_over(length);
  const std::jthread decoding([&] { fill(decoded, [&] { return session.decode(); }); });
  const std::jthread tracking([&] {
    pass_on(decoded, tracked, [&](FrameJob& job) {
      session.track(job);
      return true;
    });
  });
  const std::jthread writing([&] {
    pass_on(drawn, left_over, [&](FrameJob& job) {
      write(job);
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
