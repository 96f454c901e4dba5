#include "app/exposure_track.hpp"

#include <algorithm>
#include <cmath>

namespace catchlight::app {
namespace {

constexpr double kReach_s = 2, kFarthest_s = 60;
constexpr std::size_t kMostWitnesses = 24;  ///< of a frame, either side; evenly chosen where the footage has more

bool is_same(const tracking::PrintedTag& a, const tracking::PrintedTag& b) {
  return a == b;
}

bool has(const MatchedExposure& matched, ExposureSource source) {
  return std::find(matched.sources.begin(), matched.sources.end(), source) != matched.sources.end();
}

/// From `before` to `after`, evenly in stops; black evenly in light.
void interpolate(const TrackRow& before, const TrackRow& after, TrackRow& row) {
  const double share = static_cast<double>(row.frame - before.frame) / static_cast<double>(after.frame - before.frame);
  for (int c = 0; c < 3; ++c) row.exposure[c] = before.exposure[c] * std::pow(after.exposure[c] / before.exposure[c], share);
  row.black = glm::mix(before.black, after.black, share);
}

/// Of an even number, the lower one of the middle two: always one that was given.
double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

ExposureTrack::ExposureTrack(const CameraModel& camera, const SceneSettings& scene)
    : light_(camera, scene),
      matcher_(scene.tag.white_albedo, scene.tag.black_albedo),
      is_matching_(scene.exposure.mode == "match") {}

void ExposureTrack::add(const Frame& frame, TrackRow& row) {
  const auto reading = light_.read(frame, row);
  const MatchedExposure matched = reading && reading->is_clipped() ? match_clipped(frame, row, *reading)
                                  : reading                        ? matcher_.update(reading->photometry)
                                                                   : matcher_.update({});
  std::shared_ptr<Reference> reference;
  for (std::size_t c = 0; c < 3; ++c) {
    if (matched.sources[c] != ExposureSource::tag) continue;
    if (!reference) reference = std::make_shared<Reference>(Reference{frame, row.camera_from_tag, {}, {}});
    references_[c] = reference;
  }
  row.has_exposure = true;
  row.exposure = matched.exposure.white;
  row.black = matched.exposure.black;
  drawn_ += row.found;
  held_ += row.found && has(matched, ExposureSource::held);
  guessed_ += row.found && has(matched, ExposureSource::black);
}

double ExposureTrack::brightening(const tracking::PlaneLight& now, const tracking::BundledTag& tag, Reference& since,
                                  int channel) const {
  if (!since.plane || !is_same(since.tag, tag)) {
    since.plane = light_.plane(since.frame, since.camera_from_tag, tag);
    since.tag = tag;
  }
  return tracking::brightening(now, *since.plane, channel).value_or(0.0);
}

MatchedExposure ExposureTrack::match_clipped(const Frame& frame, const TrackRow& row, const TagLight::Reading& reading) {
  const tracking::PlaneLight now = light_.plane(frame, row.camera_from_tag, reading.tag);
  glm::dvec3 ratio(0.0);
  for (int c = 0; c < 3; ++c)
    if (const auto& reference = references_[static_cast<std::size_t>(c)]; reference && reading.photometry.is_clipped[c])
      ratio[c] = brightening(now, reading.tag, *reference, c);
  return matcher_.update(reading.photometry, ratio);
}

std::optional<std::string> ExposureTrack::warning() const {
  return is_matching_ ? exposure_warning(drawn_, held_, guessed_) : std::nullopt;
}

ExposurePath::ExposurePath(const CameraModel& camera, const SceneSettings& scene)
    : light_(camera, scene),
      white_albedo_(scene.tag.white_albedo),
      black_albedo_(scene.tag.black_albedo),
      is_matching_(scene.exposure.mode == "match") {}

void ExposurePath::add(const Frame& frame, const TrackRow& row) {
  Entry entry;
  entry.time_s = row.time_s;
  if (const auto reading = light_.read(frame, row)) {
    entry.own = ExposureMatcher(white_albedo_, black_albedo_).update(reading->photometry);
    entry.tag = reading->tag;
    entry.plane = light_.plane(frame, row.camera_from_tag, reading->tag);
  }
  entries_.push_back(std::move(entry));
}

/// The entries that know the channel, within reach; else the nearest one either side, within a minute.
std::vector<std::size_t> ExposurePath::witnesses(std::size_t entry, int channel) const {
  const auto knows = [&](std::size_t i) { return entries_[i].has(channel) && is_same(entries_[i].tag, entries_[entry].tag); };
  std::vector<std::size_t> found;
  for (const int step : {-1, 1}) {
    std::vector<std::size_t> side;
    for (std::size_t i = entry + static_cast<std::size_t>(step); i < entries_.size(); i += static_cast<std::size_t>(step)) {
      const double away_s = std::abs(entries_[i].time_s - entries_[entry].time_s);
      if (away_s > (side.empty() ? kFarthest_s : kReach_s)) break;
      if (knows(i)) side.push_back(i);
    }
    const std::size_t stride = (side.size() + kMostWitnesses - 1) / kMostWitnesses;
    for (std::size_t i = 0; i < side.size(); i += stride) found.push_back(side[i]);
  }
  if (knows(entry)) found.push_back(entry);
  return found;
}

/// Whether the channel's exposure is known.
bool ExposurePath::match(std::size_t entry, int channel, TrackRow& row) const {
  std::vector<double> white, black;
  const Entry& here = entries_[entry];
  for (const std::size_t i : here.plane ? witnesses(entry, channel) : std::vector<std::size_t>{}) {
    const TagExposure& theirs = entries_[i].own.exposure;
    const auto ratio = i == entry ? 1.0 : tracking::brightening(*here.plane, *entries_[i].plane, channel);
    if (!ratio) continue;
    white.push_back(theirs.white[channel] * *ratio);
    black.push_back(theirs.black[channel] * *ratio);
  }
  if (white.empty() && here.own.sources[static_cast<std::size_t>(channel)] == ExposureSource::held) return false;
  row.exposure[channel] = white.empty() ? here.own.exposure.white[channel] : median(white);
  row.black[channel] = black.empty() ? here.own.exposure.black[channel] : median(black);
  return true;
}

void ExposurePath::fill_in(std::vector<TrackRow>& rows) const {
  std::optional<std::size_t> before;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].has_exposure = true;
    rows[i].exposure = before ? rows[*before].exposure : TagExposure{}.white;
    rows[i].black = before ? rows[*before].black : TagExposure{}.black;
    bool is_known = true;
    for (int c = 0; c < 3; ++c) is_known &= match(i, c, rows[i]);
    if (!is_known) continue;
    for (std::size_t gap = before ? *before + 1 : 0; gap < i; ++gap) {
      if (before) {
        interpolate(rows[*before], rows[i], rows[gap]);
      } else {
        rows[gap].exposure = rows[i].exposure;
        rows[gap].black = rows[i].black;
      }
    }
    before = i;
  }
}

std::optional<std::string> ExposurePath::warning(const std::vector<TrackRow>& rows) const {
  std::int64_t drawn = 0, held = 0, guessed = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    drawn += rows[i].found;
    held += rows[i].found && !entries_[i].plane;
    guessed += rows[i].found && has(entries_[i].own, ExposureSource::black);
  }
  return is_matching_ ? exposure_warning(drawn, held, guessed) : std::nullopt;
}

}  // namespace catchlight::app
