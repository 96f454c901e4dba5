#include "app/media/read/rewindable_source.hpp"

#include <gmock/gmock.h>

#include "tests/support/media_fixture.hpp"

namespace catchlight::app::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::ElementsAreArray;

constexpr int kBytes = 1 << 20;  ///< more than a made frame needs

/// Frames numbered from 0, and how many were decoded. Breaks off where there is damage.
class CountedSource : public MediaSource {
 public:
  CountedSource(int frames, bool is_damaged, int& decoded) : frames_(frames), is_damaged_(is_damaged), decoded_(decoded) {}
  const SourceInfo& info() const override { return info_; }
  std::optional<Frame> read() override {
    if (next_ == frames_ && std::exchange(is_damaged_, false)) throw DamagedMedia("broken off");
    if (next_ == frames_) return {};
    ++decoded_;
    const auto number = static_cast<unsigned>(next_++);
    return Frame(noise_frame(AV_PIX_FMT_YUV420P, 16, 16, number), number, number);
  }
  const AVStream* video_stream() const override { return nullptr; }

 private:
  SourceInfo info_;
  int frames_, next_ = 0;
  bool is_damaged_;
  int& decoded_;
};

class Rewindable : public ::testing::Test {
 protected:
  RewindableSource source(std::int64_t budget_bytes, bool is_damaged = false) {
    const RewindableSource::Open open = [this, is_damaged] { return std::make_unique<CountedSource>(6, is_damaged, decoded_); };
    return {open(), open, budget_bytes};
  }

  /// The numbers of up to `count` frames; -1 is damage.
  static std::vector<std::int64_t> numbers(RewindableSource& source, int count = 100) {
    std::vector<std::int64_t> read;
    try {
      for (std::optional<Frame> frame; count-- > 0 && (frame = source.read());) read.push_back(frame->number());
    } catch (const DamagedMedia&) {
      read.push_back(-1);
    }
    return read;
  }

  int decoded_ = 0;
};

TEST_F(Rewindable, FramesThatFitAreDecodedOnceAndTheOthersTwice) {
  for (const bool fits : {true, false}) {
    decoded_ = 0;
    RewindableSource footage = source(fits ? 6 * kBytes : 1);
    footage.keep({});
    EXPECT_THAT(numbers(footage), ElementsAre(0, 1, 2, 3, 4, 5));
    footage.rewind();
    EXPECT_EQ(footage.kept().has_all, fits);
    EXPECT_THAT(numbers(footage), ElementsAre(0, 1, 2, 3, 4, 5));
    EXPECT_EQ(decoded_, fits ? 6 : 12);
    EXPECT_FALSE(footage.read());
  }
}

TEST_F(Rewindable, WhatWasNotReadBeforeIsReadBehindTheKeptFrames) {
  for (const bool fits : {true, false}) {
    decoded_ = 0;
    RewindableSource footage = source(fits ? 6 * kBytes : 1);
    footage.keep({});
    EXPECT_THAT(numbers(footage, 3), ElementsAre(0, 1, 2));
    footage.rewind();
    EXPECT_THAT(numbers(footage), ElementsAre(0, 1, 2, 3, 4, 5));
    EXPECT_EQ(decoded_, fits ? 6 : 9);
  }
}

TEST_F(Rewindable, DamageIsMetAgainInTheSamePlace) {
  for (const bool fits : {true, false}) {
    RewindableSource footage = source(fits ? 6 * kBytes : 1, true);
    footage.keep({});
    const std::vector<std::int64_t> first = numbers(footage);
    EXPECT_EQ(first.back(), -1);
    footage.rewind();
    EXPECT_THAT(numbers(footage), ElementsAreArray(first));
    EXPECT_FALSE(footage.read());
  }
}

/// The samples are the decoder's: kept, not copied.
TEST_F(Rewindable, KeptFramesShareTheirSamples) {
  RewindableSource footage = source(6 * kBytes);
  footage.keep({});
  const Frame first = footage.read().value();
  footage.rewind();
  EXPECT_EQ(footage.read().value().picture().data[0], first.picture().data[0]);
}

TEST_F(Rewindable, NothingIsKeptOfFramesThatAreKnownNotToFit) {
  RewindableSource footage = source(6 * kBytes);
  footage.keep(1'000'000);
  EXPECT_THAT(numbers(footage, 1), ElementsAre(0));
  EXPECT_FALSE(footage.kept().has_all);
  EXPECT_GT(footage.kept().bytes, 6 * kBytes);
}

TEST_F(Rewindable, FramesAreNotKeptUnlessAskedFor) {
  RewindableSource footage = source(6 * kBytes);
  EXPECT_THAT(numbers(footage), ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_FALSE(footage.kept().has_all);
}

}  // namespace
}  // namespace catchlight::app::testing
