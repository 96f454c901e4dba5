#include "tracking/camera/exposure_match.hpp"

#include <algorithm>
#include <cmath>

#include "catchlight/util/statistics.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::tracking {
namespace {

constexpr double kReach_s = 2;
constexpr std::size_t kMaxAsked = 8;  ///< frames, either side; evenly chosen where the footage has more

using Readings = std::deque<ExposureReading>;

/// The row's exposure goes from `before` to `after` evenly in stops; black evenly in light.
void interpolate(const TrackRow& before, const TrackRow& after, TrackRow& row) {
  const double share = static_cast<double>(row.frame - before.frame) / static_cast<double>(after.frame - before.frame);
  for (int c = 0; c < 3; ++c) row.exposure[c] = before.exposure[c] * std::pow(after.exposure[c] / before.exposure[c], share);
  row.black = glm::mix(before.black, after.black, share);
}

/// The frames that know the channel, within reach; else the nearest one either side.
std::vector<std::size_t> asked(const Readings& all, std::size_t frame, int channel) {
  const auto is_asked = [&](std::size_t i) { return all[i].knows(channel) && all[i].tag == all[frame].tag; };
  std::vector<std::size_t> found;
  for (const int step : {-1, 1}) {
    std::vector<std::size_t> side;
    for (std::size_t i = frame + static_cast<std::size_t>(step); i < all.size(); i += static_cast<std::size_t>(step)) {
      if (!side.empty() && std::abs(all[i].time_s - all[frame].time_s) > kReach_s) break;
      if (is_asked(i)) side.push_back(i);
    }
    const std::size_t stride = (side.size() + kMaxAsked - 1) / kMaxAsked;
    for (std::size_t i = 0; i < side.size(); i += stride) found.push_back(side[i]);
  }
  if (is_asked(frame)) found.push_back(frame);
  return found;
}

/// Sets the channel's exposure where it is known; whether it is.
bool match(const Readings& all, std::size_t frame, int channel, TagExposure& exposure) {
  const ExposureReading& here = all[frame];
  if (!here.plane) return false;
  std::vector<double> whites, blacks;
  for (const std::size_t i : asked(all, frame, channel)) {
    const TagExposure& theirs = all[i].own.exposure;
    const auto ratio = i == frame ? 1.0 : brightening(*here.plane, *all[i].plane, channel);
    if (!ratio) continue;
    whites.push_back(theirs.white[channel] * *ratio);
    blacks.push_back(theirs.black[channel] * *ratio);  // flare is light, too
  }
  if (whites.empty()) {
    const auto knows = [channel](const ExposureReading& reading) { return reading.knows(channel); };
    if (here.own.sources[static_cast<std::size_t>(channel)] == ExposureSource::nothing) return false;
    if (std::any_of(all.begin(), all.end(), knows)) return false;  // held or gone over from what is known
    whites = {here.own.exposure.white[channel]};
    blacks = {here.own.exposure.black[channel]};
  }
  exposure.white[channel] = quantile(std::move(whites), 0.5);
  exposure.black[channel] = quantile(std::move(blacks), 0.5);
  return true;
}

/// Sets the channels that are known; whether all are.
bool match(const Readings& all, std::size_t frame, TagExposure& exposure) {
  bool is_known = true;
  for (int c = 0; c < 3; ++c) is_known &= match(all, frame, c, exposure);
  return is_known;
}

void set_exposure(TrackRow& row, const TagExposure& exposure) {
  row.has_exposure = true;
  row.exposure = exposure.white;
  row.black = exposure.black;
}

TagExposure exposure_of(const TrackRow& row) {
  return {row.exposure, row.black};
}

}  // namespace

void ExposureCounts::add(const ExposureReading& reading, bool is_found) {
  found += is_found;
  held += is_found && !reading.plane;
  guessed += is_found && reading.is_guessed();
}

std::optional<std::string> ExposureCounts::warning() const {
  if (held > 0)
    return "the exposure could not be read off the tag in " + std::to_string(held) + " of " + counted(found, "frame") +
           " (covered, black or clipped) and is that of the frames around; where that shows, keep the tag in sight and "
           "its white below clipping";
  if (guessed > 0 && guessed == found)
    return "the tag's white is clipped in every frame; the exposure is estimated from its black, which flare spoils: expose the "
           "tag's white below clipping in one frame at least";
  return std::nullopt;
}

void ExposureMatch::add(const FrameImage& frame, const TrackRow& row) {
  readings_.push_back(reader_.read(frame, row));
}

void ExposureMatch::set_latest(TrackRow& row) {
  match(readings_, readings_.size() - 1, latest_);
  set_exposure(row, latest_);
  counts_.add(readings_.back(), row.found);
  forget();
}

/// Keeps the last two seconds, and the last frame that knew a channel.
void ExposureMatch::forget() {
  const auto is_spare = [this](const ExposureReading& first) {
    if (readings_.back().time_s - first.time_s <= kReach_s) return false;
    for (int c = 0; c < 3; ++c)
      if (first.knows(c) && std::none_of(readings_.begin() + 1, readings_.end(), [c](const auto& r) { return r.knows(c); }))
        return false;
    return true;
  };
  while (is_spare(readings_.front())) readings_.pop_front();
}

void ExposureMatch::set_all(std::vector<TrackRow>& rows) const {
  std::optional<std::size_t> before;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    TagExposure exposure = before ? exposure_of(rows[*before]) : TagExposure{};
    const bool is_known = match(readings_, i, exposure);
    set_exposure(rows[i], exposure);
    if (!is_known) continue;
    for (std::size_t gap = before ? *before + 1 : 0; gap < i; ++gap) {
      if (before)
        interpolate(rows[*before], rows[i], rows[gap]);
      else
        set_exposure(rows[gap], exposure);
    }
    before = i;
  }
}

ExposureCounts ExposureMatch::counts(const std::vector<TrackRow>& rows) const {
  ExposureCounts counts;
  for (std::size_t i = 0; i < rows.size(); ++i) counts.add(readings_[i], rows[i].found);
  return counts;
}

}  // namespace catchlight::tracking
