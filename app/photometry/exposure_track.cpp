#include "app/photometry/exposure_track.hpp"

#include <algorithm>
#include <cmath>

#include "catchlight/util/statistics.hpp"

namespace catchlight::app {
namespace {

constexpr double kReach_s = 2;
constexpr std::size_t kMaxWitnesses = 24;  ///< of a frame, either side; evenly chosen where the footage has more

using Witnesses = std::deque<ExposureWitness>;

/// From `before` to `after`, evenly in stops; black evenly in light.
void interpolate(const TrackRow& before, const TrackRow& after, TrackRow& row) {
  const double share = static_cast<double>(row.frame - before.frame) / static_cast<double>(after.frame - before.frame);
  for (int c = 0; c < 3; ++c) row.exposure[c] = before.exposure[c] * std::pow(after.exposure[c] / before.exposure[c], share);
  row.black = glm::mix(before.black, after.black, share);
}

/// The frames that know the channel, within reach; else the nearest one either side.
std::vector<std::size_t> heard(const Witnesses& all, std::size_t frame, int channel) {
  const auto is_heard = [&](std::size_t i) { return all[i].knows(channel) && all[i].tag == all[frame].tag; };
  std::vector<std::size_t> found;
  for (const int step : {-1, 1}) {
    std::vector<std::size_t> side;
    for (std::size_t i = frame + static_cast<std::size_t>(step); i < all.size(); i += static_cast<std::size_t>(step)) {
      if (!side.empty() && std::abs(all[i].time_s - all[frame].time_s) > kReach_s) break;
      if (is_heard(i)) side.push_back(i);
    }
    const std::size_t stride = (side.size() + kMaxWitnesses - 1) / kMaxWitnesses;
    for (std::size_t i = 0; i < side.size(); i += stride) found.push_back(side[i]);
  }
  if (is_heard(frame)) found.push_back(frame);
  return found;
}

/// Whether the channel's exposure is known.
bool match(const Witnesses& all, std::size_t frame, int channel, double& white, double& black) {
  const ExposureWitness& here = all[frame];
  if (!here.plane) return false;
  std::vector<double> whites, blacks;
  for (const std::size_t i : heard(all, frame, channel)) {
    const TagExposure& theirs = all[i].own.exposure;
    const auto ratio = i == frame ? 1.0 : tracking::brightening(*here.plane, *all[i].plane, channel);
    if (!ratio) continue;
    whites.push_back(theirs.white[channel] * *ratio);
    blacks.push_back(theirs.black[channel] * *ratio);  // flare is light, too
  }
  if (whites.empty()) {
    const auto knows = [channel](const ExposureWitness& witness) { return witness.knows(channel); };
    if (here.own.sources[static_cast<std::size_t>(channel)] == ExposureSource::nothing) return false;
    if (std::any_of(all.begin(), all.end(), knows)) return false;  // held or gone over from what is known
    whites = {here.own.exposure.white[channel]};
    blacks = {here.own.exposure.black[channel]};
  }
  white = quantile(std::move(whites), 0.5);
  black = quantile(std::move(blacks), 0.5);
  return true;
}

}  // namespace

ExposureReader::ExposureReader(const CameraModel& camera, const SceneSettings& scene)
    : light_(camera, scene), white_albedo_(scene.tag.white_albedo), black_albedo_(scene.tag.black_albedo) {}

ExposureWitness ExposureReader::read(const Frame& frame, const TrackRow& row) const {
  ExposureWitness witness;
  witness.time_s = row.time_s;
  if (const auto reading = light_.read(frame, row)) {
    witness.own = read_exposure(reading->photometry, white_albedo_, black_albedo_);
    witness.tag = reading->tag;
    witness.plane = light_.plane(frame, row.camera_from_tag, reading->tag);
  }
  return witness;
}

void ExposureDoubts::add(const ExposureWitness& frame, bool is_drawn) {
  const auto& sources = frame.own.sources;
  drawn += is_drawn;
  held += is_drawn && !frame.plane;
  guessed += is_drawn && std::find(sources.begin(), sources.end(), ExposureSource::black) != sources.end();
}

ExposureTrack::ExposureTrack(const CameraModel& camera, const SceneSettings& scene)
    : reader_(camera, scene), is_matching_(scene.exposure.mode == "match") {}

void ExposureTrack::add(const Frame& frame, TrackRow& row) {
  witnesses_.push_back(reader_.read(frame, row));
  const std::size_t now = witnesses_.size() - 1;
  for (int c = 0; c < 3; ++c) match(witnesses_, now, c, current_.white[c], current_.black[c]);
  row.has_exposure = true;
  row.exposure = current_.white;
  row.black = current_.black;
  doubts_.add(witnesses_.back(), row.found);
  forget();
}

void ExposureTrack::forget() {
  const auto is_spare = [this](const ExposureWitness& first) {
    if (witnesses_.back().time_s - first.time_s <= kReach_s) return false;
    for (int c = 0; c < 3; ++c)
      if (first.knows(c) && std::none_of(witnesses_.begin() + 1, witnesses_.end(), [c](const auto& w) { return w.knows(c); }))
        return false;
    return true;
  };
  while (is_spare(witnesses_.front())) witnesses_.pop_front();
}

std::optional<std::string> ExposureTrack::warning() const {
  return is_matching_ ? exposure_warning(doubts_.drawn, doubts_.held, doubts_.guessed) : std::nullopt;
}

ExposurePath::ExposurePath(const CameraModel& camera, const SceneSettings& scene)
    : reader_(camera, scene), is_matching_(scene.exposure.mode == "match") {}

void ExposurePath::add(const Frame& frame, const TrackRow& row) {
  witnesses_.push_back(reader_.read(frame, row));
}

void ExposurePath::fill_in(std::vector<TrackRow>& rows) const {
  std::optional<std::size_t> before;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].has_exposure = true;
    rows[i].exposure = before ? rows[*before].exposure : TagExposure{}.white;
    rows[i].black = before ? rows[*before].black : TagExposure{}.black;
    bool is_known = true;
    for (int c = 0; c < 3; ++c) is_known &= match(witnesses_, i, c, rows[i].exposure[c], rows[i].black[c]);
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
  ExposureDoubts doubts;
  for (std::size_t i = 0; i < rows.size(); ++i) doubts.add(witnesses_[i], rows[i].found);
  return is_matching_ ? exposure_warning(doubts.drawn, doubts.held, doubts.guessed) : std::nullopt;
}

}  // namespace catchlight::app
