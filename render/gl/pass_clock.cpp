#include "render/gl/pass_clock.hpp"

namespace catchlight::render {

PassClock::Scope::Scope(PassClock& clock, const char* name) {
  glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, -1, name);
  if (clock.queries_.size() == clock.names_.size()) clock.queries_.push_back(make_query(GL_TIME_ELAPSED));
  glBeginQuery(GL_TIME_ELAPSED, clock.queries_[clock.names_.size()].id());
  clock.names_.emplace_back(name);
}

PassClock::Scope::~Scope() {
  glEndQuery(GL_TIME_ELAPSED);
  glPopDebugGroup();
}

void PassClock::begin_frame() {
  names_.clear();
  frame_start_ = std::chrono::steady_clock::now();
}

std::vector<PassTime> PassClock::times() const {
  const double frame_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - frame_start_).count();
  std::vector<PassTime> result;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    GLuint64 elapsed_ns = 0;
    glGetQueryObjectui64v(queries_[i].id(), GL_QUERY_RESULT, &elapsed_ns);
    const double ms = static_cast<double>(elapsed_ns) * 1e-6;
    // llvmpipe gives the time since boot for a pass that draws no pixel.
    result.push_back({names_[i], ms <= frame_ms ? ms : 0.0});
  }
  return result;
}

}  // namespace catchlight::render
