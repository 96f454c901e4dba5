#include "app/media/read/newest_frame_source.hpp"

#include <gmock/gmock.h>

#include "tests/support/media_fixture.hpp"

namespace catchlight::app::testing {
namespace {

/// Gives as many frames as the test has allowed so far; a frame's time is its number in the stream.
class AllowedFrames : public MediaSource {
 public:
  const SourceInfo& info() const override { return info_; }

  std::optional<Frame> read() override {
    std::unique_lock lock(mutex_);
    is_waiting_ = allowed_ == given_;
    changed_.notify_all();
    changed_.wait(lock, [&] { return given_ < allowed_ || has_ended_; });
    is_waiting_ = false;
    if (given_ == allowed_ && is_damaged_) throw DamagedMedia("broken off");
    if (given_ == allowed_) return {};
    const int index = given_++;
    return Frame(noise_frame(AV_PIX_FMT_YUV420P, 16, 16, 1), index, index);
  }
  const AVStream* video_stream() const override { return nullptr; }
  void stop() override { end(false); }

  /// Returns when all of them have been read.
  void allow(int frames) {
    std::unique_lock lock(mutex_);
    allowed_ += frames;
    is_waiting_ = false;
    changed_.notify_all();
    changed_.wait(lock, [&] { return is_waiting_; });
  }

  void end(bool is_damaged) {
    const std::lock_guard lock(mutex_);
    has_ended_ = true;
    is_damaged_ = is_damaged;
    changed_.notify_all();
  }

 private:
  SourceInfo info_;
  std::mutex mutex_;
  std::condition_variable changed_;
  int allowed_ = 0, given_ = 0;
  bool has_ended_ = false, is_damaged_ = false, is_waiting_ = false;
};

class NewestFrame : public ::testing::Test {
 protected:
  NewestFrame() {
    auto stream = std::make_unique<AllowedFrames>();
    stream_ = stream.get();
    source_ = std::make_unique<NewestFrameSource>(std::move(stream));
  }

  std::unique_ptr<NewestFrameSource> source_;
  AllowedFrames* stream_;
};

TEST_F(NewestFrame, WhoReadsSlowlySeesTheNewestAndWhoReadsFastSeesAll) {
  stream_->allow(1);
  EXPECT_EQ(source_->read()->time_s(), 0);
  stream_->allow(1);
  EXPECT_EQ(source_->read()->time_s(), 1);
  stream_->allow(8);
  EXPECT_EQ(source_->read()->time_s(), 9);
  EXPECT_EQ(source_->dropped_frames(), 7);
}

TEST_F(NewestFrame, FramesAreNumberedAsTheyAreTaken) {
  for (int number = 0; number < 4; ++number) {
    stream_->allow(3);
    EXPECT_EQ(source_->read()->number(), number);
  }
}

/// A scene may take seconds to make, and nobody misses what was to be seen meanwhile.
TEST_F(NewestFrame, FramesBeforeTheFirstThatIsTakenAreNotCounted) {
  stream_->allow(50);
  EXPECT_EQ(source_->read()->time_s(), 49);
  EXPECT_EQ(source_->dropped_frames(), 0);
}

TEST_F(NewestFrame, TheEndComesBehindTheNewestFrame) {
  stream_->allow(2);
  stream_->end(false);
  EXPECT_EQ(source_->read()->time_s(), 1);
  EXPECT_FALSE(source_->read());
  EXPECT_FALSE(source_->read());
}

TEST_F(NewestFrame, DamageComesBehindTheNewestFrameAndOnce) {
  stream_->allow(2);
  stream_->end(true);
  EXPECT_EQ(source_->read()->time_s(), 1);
  EXPECT_THROW(source_->read(), DamagedMedia);
  EXPECT_FALSE(source_->read());
}

TEST_F(NewestFrame, AStreamThatGivesNothingCanBeLeft) {
  stream_->allow(1);
  source_.reset();  // its thread waits for a frame that never comes
}

}  // namespace
}  // namespace catchlight::app::testing
