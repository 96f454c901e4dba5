#include "app/window/playing/live_feed.hpp"

#include <utility>

#include "app/session/session.hpp"
#include "app/settings/change_cost.hpp"
#include "catchlight/error.hpp"

namespace catchlight::app {

using Clock = std::chrono::steady_clock;

void LiveFeed::hold(bool is_held) {
  const std::lock_guard lock(mutex_);
  is_held_ = is_held;
}

void LiveFeed::begin_take(const std::string& folder, const SceneSettings& settings) {
  const std::lock_guard lock(mutex_);
  if (!status_.source) throw Error("nothing comes in that could be recorded");
  if (take_ && !take_->status().is_over) throw Error("the last take is still being written to " + take_->status().folder);
  Recording recording = recording_;
  recording.scene = settings;
  take_ = std::make_unique<TakeRecorder>(folder, std::move(recording), *status_.source);
}

void LiveFeed::end_take() {
  const std::lock_guard lock(mutex_);
  if (take_) take_->stop();
}

void LiveFeed::see(const Frame& frame) {
  const std::lock_guard lock(mutex_);
  if (take_) take_->add(frame);
}

LiveStatus LiveFeed::status() const {
  const std::lock_guard lock(mutex_);
  LiveStatus status = status_;
  if (take_) status.take = take_->status();
  return status;
}

bool LiveFeed::goes_on() const {
  const std::lock_guard lock(mutex_);
  return !is_held_ && !status_.has_ended;
}

SourceInfo LiveFeed::open(const std::function<SourceInfo()>& make) {
  {
    const std::lock_guard lock(mutex_);
    status_.source.reset();
    status_.waiting_since = Clock::now();
  }
  SourceInfo info;
  try {
    info = make();
  } catch (const Error& error) {
    throw LostSource{error.what()};
  }
  const std::lock_guard lock(mutex_);
  status_.source = info;
  status_.lost.reset();
  return info;
}

bool LiveFeed::must_reopen(const Session& session, const SceneSettings& settings) const {
  return session.footage().info().is_live && costs_of_change(session.settings(), settings).contains(ChangeCost::footage);
}

FrameJob LiveFeed::next(Session& session) {
  {
    const std::lock_guard lock(mutex_);
    if (last_ && (is_held_ || status_.has_ended)) return *last_;
    status_.waiting_since = Clock::now();
  }
  std::optional<FrameJob> job;
  try {
    job = session.decode();
  } catch (const Error& error) {
    throw LostSource{error.what()};
  }
  if (!job) throw LostSource{session.damage().value_or(recording_.footage + " has ended")};
  session.track(*job);
  last_ = job;
  const std::lock_guard lock(mutex_);
  status_.waiting_since.reset();
  status_.dropped_frames = session.footage().dropped_frames();
  return *job;
}

bool LiveFeed::lose(const std::string& why, bool comes_again) {
  end_take();
  const std::lock_guard lock(mutex_);
  status_.lost = why;
  status_.waiting_since.reset();
  status_.source.reset();
  status_.has_ended = !comes_again || recording_.footage == "-";
  if (!status_.has_ended) last_.reset();
  return !status_.has_ended;
}

}  // namespace catchlight::app
