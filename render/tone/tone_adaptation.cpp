#include "render/tone/tone_adaptation.hpp"

#include <cmath>

namespace catchlight::render {
namespace {

/// The approach of a value to another in stops; at once where either has none (no white at all).
double approached(double from, double to, double elapsed_s, double tau_s) {
  const double stops = std::log2(from / to);
  if (!std::isfinite(stops)) return to;
  return to * std::exp2(stops * (tau_s > 0 ? std::exp(-elapsed_s / tau_s) : elapsed_s > 0 ? 0.0 : 1.0));
}

}  // namespace

std::optional<ToneCurve> ToneAdaptation::at(double time_s) const {
  if (!seen_from_) return std::nullopt;
  const double elapsed_s = time_s > time_s_ ? time_s - time_s_ : 0;
  const ToneCurve& from = *seen_from_;
  return ToneCurve{approached(from.gain, target_.gain, elapsed_s, target_.gain < from.gain ? bright_s_ : dark_s_),
                   approached(from.white, target_.white, elapsed_s, target_.white > from.white ? bright_s_ : dark_s_)};
}

void ToneAdaptation::see(double time_s, const ToneCurve& target) {
  const bool is_first = !seen_from_;
  seen_from_ = at(time_s).value_or(target);
  target_ = target;
  if (is_first || time_s > time_s_) time_s_ = time_s;
}

}  // namespace catchlight::render
